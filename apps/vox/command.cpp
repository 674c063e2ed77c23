// Options of commands, in the terms of CLI11.

#include "apps/vox/command.h"

#include "libvox/core/error.h"

#include <CLI/CLI.hpp>

#include <cstdint>

namespace vox::app {
namespace {

/// Refuses what is no whole number of a range. Help texts show the range as CLI11 describes it.
template <class Number>
CLI::Validator wholeNumber(Number least, Number most) {
  CLI::Validator check = CLI::Range(least, most);
  return check.operation([least, most](std::string& text) {
    Number value = 0;
    const bool isNumber = CLI::detail::lexical_cast(text, value);
    if (isNumber && value >= least && value <= most) return std::string();
    return "must be a whole number from " + std::to_string(least) + " to " + std::to_string(most) +
           ", not " + text;
  });
}

CLI::Validator anyNumber() {
  return CLI::Validator(
      [](std::string& text) {
        double value = 0;
        return CLI::detail::lexical_cast(text, value) ? "" : "must be a number, not " + text;
      },
      "");
}

/// Refuses the empty text that a variable of a shell without a value becomes.
CLI::Validator anyText() {
  return CLI::Validator(
      [](std::string& text) { return text.empty() ? "must not be empty" : std::string(); }, "");
}

}  // namespace

Option Option::type(const std::string& name) const {
  option_->type_name(name);
  return *this;
}

Option Option::group(const std::string& name) const {
  option_->group(name);
  return *this;
}

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::range(int least, int most) const {
  option_->check(wholeNumber(least, most));
  return *this;
}

Option Option::range(Index least, Index most) const {
  option_->check(wholeNumber(least, most));
  return *this;
}

Option Option::excludes(const Option& other) const {
  option_->excludes(other.option_);
  return *this;
}

Option Option::showDefault() const {
  option_->capture_default_str();
  return *this;
}

bool Option::isGiven() const {
  return option_->count() > 0;
}

std::string Option::name() const {
  return option_->get_name();
}

Command::Command(CLI::App& app, const char* name, const char* description)
    : command_(app.add_subcommand(name, description)) {}

Option Command::add(const char* names, std::string& value, const std::string& help) const {
  return Option(command_->add_option(names, value, help)->check(anyText()));
}

Option Command::add(const char* names, std::vector<std::string>& values,
                    const std::string& help) const {
  return Option(command_->add_option(names, values, help));
}

Option Command::add(const char* names, int& value, const std::string& help) const {
  return Option(command_->add_option(names, value, help));
}

Option Command::add(const char* names, Index& value, const std::string& help) const {
  return Option(command_->add_option(names, value, help));
}

Option Command::add(const char* names, double& value, const std::string& help) const {
  return Option(command_->add_option(names, value, help)->check(anyNumber()));
}

Option Command::add(const char* names, std::optional<int>& value, const std::string& help) const {
  return Option(command_->add_option_function<int>(
      names, [&value](int number) { value = number; }, help));
}

Option Command::add(const char* names, std::optional<double>& value,
                    const std::string& help) const {
  CLI::Option* const option = command_->add_option_function<double>(
      names, [&value](double number) { value = number; }, help);
  return Option(option->check(anyNumber()));
}

Option Command::add(const char* names, const SetText& set, const std::string& help) const {
  const auto setOrRefuse = [set](const std::string& text) {
    try {
      set(text);
    } catch (const UsageError& wrong) {
      throw CLI::ValidationError(wrong.what());
    }
  };
  return Option(command_->add_option_function<std::string>(names, setOrRefuse, help));
}

Option Command::addRepeatable(const char* names, std::vector<std::string>& values,
                              const std::string& help) const {
  CLI::Option* const option = command_->add_option(names, values, help);
  option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->allow_extra_args(false);
  return Option(option);
}

Option Command::addFlag(const char* names, bool& value, const std::string& help) const {
  return Option(command_->add_flag(names, value, help));
}

Option Command::addFlag(const char* names, std::optional<bool>& value,
                        const std::string& help) const {
  return Option(command_->add_flag_function(
      names, [&value](std::int64_t count) { value = count > 0; }, help));
}

void Command::footer(const std::string& text) const {
  command_->footer(text);
}

std::vector<Option> Command::options() const {
  std::vector<Option> all;
  for (CLI::Option* const option : command_->get_options()) all.emplace_back(option);
  return all;
}

}  // namespace vox::app
