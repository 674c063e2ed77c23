// vox: from irregular polygon meshes to smooth voxel models.

#include "apps/vox/command.h"
#include "apps/vox/interrupt.h"
#include "apps/vox/manual.h"
#include "apps/vox/suggest.h"
#include "libvox/core/error.h"
#include "libvox/core/progress.h"
#include "libvox/core/version.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace vox::app {
namespace {

constexpr int kUsage = 2;
constexpr int kLimit = 4;
constexpr int kIo = 5;
constexpr int kInternal = 70;  // a bug of ours: EX_SOFTWARE

int fail(const std::string& message, int code) {
  std::cerr << "vox: error: " << onOneLine(message) << '\n';
  return code;
}

/// TBB says in words alone that a thread could not be started, for want of memory mostly.
bool isLackOfThreads(const std::exception& error) {
  return std::string_view(error.what()).starts_with("pthread_create has failed");
}

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
std::string switchWithValue(const CLI::App& app, std::span<char*> arguments) {
  for (const std::string argument : arguments) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos) continue;
    for (const CLI::App* command : app.get_subcommands({})) {
      const CLI::Option* option = command->get_option_no_throw(argument.substr(0, equals));
      if (option != nullptr && option->get_items_expected_max() == 0) return argument;
    }
  }
  return {};
}

int run(int argc, char** argv) {
  CLI::App app(
      "Smooth voxel models in OpenVDB from irregular polygon meshes.\n"
      "Doo-Sabin subdivision down to the voxel, after Cohen, Kaufman & Wang 1994.",
      "vox");
  app.set_version_flag("--version", std::string("vox ") + version());
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.footer(
      "Exit codes: 0 success, 1 diff finds a difference, or check or convert --verify a fault,\n"
      "2 usage, 3 bad input, 4 cannot be done within limits, 5 output cannot be written,\n"
      "70 internal error, 130 interrupted.");
  const std::vector<std::pair<const char*, Action>> actions = {
      {"convert", addConvert(app)}, {"merge", addMerge(app)}, {"subdivide", addSubdivide(app)},
      {"info", addInfo(app)},       {"diff", addDiff(app)},   {"check", addCheck(app)},
      {"render", addRender(app)}};

  const auto print = [&app](const std::string& flag, std::string (*text)(const CLI::App&)) {
    app.add_flag_callback(flag, [&app, text] { throw CLI::CallForVersion(text(app), 0); })
        ->group("");  // not in --help
  };
  print("--man", manualPage);
  print("--markdown", markdownTables);
  print("--bash-completion", bashCompletion);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return app.exit(asked);  // --help, --version
  } catch (const CLI::ParseError& error) {
    // A mistyped option is the likelier cause of one that is missing.
    const bool extras = !app.remaining(/*recurse=*/true).empty();
    if (extras) return fail(explainExtras(app), kUsage);
    if (app.get_subcommands().empty())
      return fail("a command is required, such as vox convert (see vox --help)", kUsage);
    const std::string message = error.what();
    if (message.ends_with(" missing"))  // CLI11's "--scale: 1 required S missing"
      return fail(message.substr(0, message.find(':')) + " needs a value", kUsage);
    return fail(message, kUsage);
  } catch (const std::logic_error&) {  // what CLI11 lets through for --force=maybe
    const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
    return fail("a switch takes no value but true or false: " + switchWithValue(app, arguments),
                kUsage);
  }
  for (const auto& [name, action] : actions)
    if (app.got_subcommand(name)) return action();
  return kUsage;
}

}  // namespace
}  // namespace vox::app

int main(int argc, char** argv) {
  using namespace vox::app;
  handleSignals();
  try {
    const int code = run(argc, argv);
    if (!std::cout.flush()) return fail("standard output cannot be written", kIo);
    return code;
  } catch (const vox::Cancelled& cancelled) {
    std::cerr << "vox: " << cancelled.what() << '\n';
    return cancelled.exitCode();
  } catch (const vox::Error& error) {
    return fail(error.what(), error.exitCode());
  } catch (const std::bad_alloc&) {
    return fail("out of memory; use a smaller --dim or a larger --voxel-size", kLimit);
  } catch (const std::ios_base::failure& error) {
    return fail(error.what(), kIo);
  } catch (const std::exception& error) {
    if (isLackOfThreads(error))
      return fail("no memory for another thread; use fewer --threads or allow more memory", kLimit);
    return fail(std::string("internal error, please report it: ") + error.what(), kInternal);
  }
}
