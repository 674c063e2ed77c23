// A command line and its mistakes, each in one line.

#include "apps/vox/parse_arguments.h"

#include "apps/vox/suggest.h"
#include "libvox/core/error.h"

#include <CLI/CLI.hpp>

#include <stdexcept>

namespace vox::app {
namespace {

std::vector<std::string> optionNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> commandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// One line for words that were not understood, with the nearest that would be.
std::string explainExtras(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  const CLI::App& command = chosen.empty() ? app : *chosen.front();
  const std::vector<std::string> extras = app.remaining(/*recurse=*/true);
  const std::string word = extras.empty() ? "" : extras.front();
  const bool isOption = word.starts_with("-");
  const std::string name = word.substr(0, word.find('='));
  const std::string suggestion = nearest(name, isOption         ? optionNames(command)
                                               : chosen.empty() ? commandNames(app)
                                                                : std::vector<std::string>());
  std::string message = isOption         ? "unknown option "
                        : chosen.empty() ? "unknown command "
                                         : "unexpected argument ";
  message += name;
  if (!suggestion.empty()) message += "; did you mean " + suggestion + "?";
  return message + " (see " + (chosen.empty() ? "vox" : "vox " + command.get_name()) + " --help)";
}

/// The first argument that gives a value to a switch: --force=maybe.
std::string switchWithValue(const CLI::App& app, const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos) continue;
    for (const CLI::App* command : app.get_subcommands({})) {
      const CLI::Option* option = command->get_option_no_throw(argument.substr(0, equals));
      if (option != nullptr && option->get_items_expected_max() == 0) return argument;
    }
  }
  return {};
}

std::string explain(const CLI::App& app, const CLI::ParseError& error) {
  // A mistyped option is the likelier cause of one that is missing.
  if (!app.remaining(/*recurse=*/true).empty()) return explainExtras(app);
  if (app.get_subcommands().empty())
    return "a command is required, such as vox convert (see vox --help)";
  const std::string message = error.what();
  if (message.ends_with(" missing"))  // CLI11's "--scale: 1 required S missing"
    return message.substr(0, message.find(':')) + " needs a value";
  return message;
}

}  // namespace

void parseArguments(CLI::App& app, const std::vector<std::string>& arguments) {
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success&) {
    throw;
  } catch (const CLI::ParseError& error) {
    throw UsageError(explain(app, error));
  } catch (const std::logic_error&) {  // what CLI11 lets through for --force=maybe
    throw UsageError("a switch takes no value but true or false: " +
                     switchWithValue(app, arguments));
  }
}

}  // namespace vox::app
