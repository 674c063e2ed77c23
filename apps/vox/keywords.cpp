// Keyword arguments as a command line.

#include "apps/vox/keywords.h"

#include "apps/vox/option_help.h"
#include "apps/vox/parse_arguments.h"
#include "libvox/core/error.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace vox::app {
namespace {

/// Options of the program that make no sense for a function: its caller has the result.
constexpr std::array<std::string_view, 7> kOfProgram = {
    "--output", "--force", "--quiet", "--verbose", "--progress", "--json", "--dry-run"};

bool isOfProgram(std::string_view option, const CLI::App& command) {
  // The report of vox convert is data for programs; those of other commands are pages for people.
  if (option == "--report") return command.get_name() == "convert";
  return std::find(kOfProgram.begin(), kOfProgram.end(), option) != kOfProgram.end();
}

/// @throws UsageError  the text is no name of an option
std::string optionOf(std::string keyword) {
  const auto isOfName = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  if (keyword.empty() || !std::all_of(keyword.begin(), keyword.end(), isOfName))
    throw UsageError("unknown option --" + keyword);
  std::replace(keyword.begin(), keyword.end(), '_', '-');
  return "--" + keyword;
}

std::string keywordOf(std::string option) {
  std::replace(option.begin(), option.end(), '-', '_');
  return option;
}

bool isSwitch(const CLI::Option& option) {
  return option.get_items_expected_max() == 0;
}

bool isRepeatable(const CLI::Option& option) {
  return option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
}

std::string assigned(const std::string& option, const std::string& value) {
  if (value.empty()) throw UsageError(option + ": must not be empty");
  return option + "=" + value;
}

/// Appends a keyword argument as the words of a command line.
class KeywordWords {
 public:
  KeywordWords(std::string name, const CLI::Option* option, std::vector<std::string>& words)
      : name_(std::move(name)), option_(option), words_(words) {}

  void operator()(bool isOn) const {
    if (option_ != nullptr && !isSwitch(*option_))
      throw UsageError(name_ + " needs a value, not true or false");
    words_.push_back(name_ + (isOn ? "=true" : "=false"));
  }
  void operator()(const std::string& value) const { words_.push_back(assigned(name_, value)); }
  void operator()(const std::vector<std::string>& values) const {
    if (option_ != nullptr && isRepeatable(*option_) && !values.empty()) {
      for (const std::string& value : values) (*this)(value);
      return;
    }
    std::string all;
    for (const std::string& value : values) all += (all.empty() ? "" : ",") + value;
    (*this)(all);
  }

 private:
  std::string name_;
  const CLI::Option* option_;  // null: unknown, which the parser says
  std::vector<std::string>& words_;
};

}  // namespace

KeywordCommand::KeywordCommand(const std::function<void(CLI::App&)>& declare)
    : app_(std::make_unique<CLI::App>("", "vox")) {
  app_->require_subcommand(1);
  declare(*app_);
  command_ = app_->get_subcommands({}).front();
  app_->set_help_flag();
  command_->set_help_flag();
}

KeywordCommand::~KeywordCommand() = default;

void KeywordCommand::parse(const std::vector<std::string>& arguments,
                           const std::vector<Keyword>& keywords) {
  std::vector<std::string> words = {command_->get_name()};
  for (const Keyword& keyword : keywords) {
    const std::string name = optionOf(keyword.name);
    if (isOfProgram(name, *command_))
      throw UsageError(name + " is for the program only: here the result is returned");
    std::visit(KeywordWords(name, command_->get_option_no_throw(name), words), keyword.value);
  }
  words.insert(words.end(), arguments.begin(), arguments.end());
  parseArguments(*app_, words);
}

std::vector<KeywordHelp> KeywordCommand::help() const {
  std::vector<KeywordHelp> all;
  for (const CLI::Option* option : command_->get_options()) {
    const std::vector<std::string>& names = option->get_lnames();
    if (names.empty() || isOfProgram("--" + names[0], *command_)) continue;
    all.push_back({keywordOf(names[0]), valueName(*option), description(*option)});
  }
  return all;
}

}  // namespace vox::app
