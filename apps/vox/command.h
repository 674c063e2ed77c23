#pragma once

#include "libvox/core/types.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace vox::app {

/// One option of a command. A thin handle: only command.cpp includes CLI11, which takes seconds to
/// compile.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  /// What help calls the value: "N"; words with | between them are its choices.
  Option type(const std::string& name) const;
  /// Heading in help.
  Option group(const std::string& name) const;
  Option required() const;
  Option range(int least, int most) const;
  Option range(Index least, Index most) const;
  /// Cannot be given together with another option.
  Option excludes(const Option& other) const;
  /// Help shows the value that the variable has now as the default.
  Option showDefault() const;

  /// True if the command line has it.
  bool isGiven() const;
  std::string name() const;

 private:
  CLI::Option* option_;
};

/// A subcommand: its options, declared once for parsing, help, manual page and completion.
class Command {
 public:
  Command(CLI::App& app, const char* name, const char* description);

  /// Adds an option, "-o,--output", or a positional one, "INPUT". The value is set when the command
  /// line is parsed, and must live until then; an optional stays empty without the option.
  Option add(const char* names, std::string& value, const std::string& help) const;
  Option add(const char* names, std::vector<std::string>& values, const std::string& help) const;
  Option add(const char* names, int& value, const std::string& help) const;
  Option add(const char* names, Index& value, const std::string& help) const;
  Option add(const char* names, double& value, const std::string& help) const;
  Option add(const char* names, std::optional<int>& value, const std::string& help) const;
  Option add(const char* names, std::optional<double>& value, const std::string& help) const;
  /// Passes the text on.
  /// @param set  may throw UsageError
  using SetText = std::function<void(const std::string&)>;
  Option add(const char* names, const SetText& set, const std::string& help) const;
  /// An option that may be given several times, with one value each.
  Option addRepeatable(const char* names, std::vector<std::string>& values,
                       const std::string& help) const;
  /// A switch.
  Option addFlag(const char* names, bool& value, const std::string& help) const;
  /// A switch that has a third state, not given; --flag=false makes it false.
  Option addFlag(const char* names, std::optional<bool>& value, const std::string& help) const;

  /// What stands below the options in help.
  void footer(const std::string& text) const;

  /// All options so far.
  std::vector<Option> options() const;

 private:
  CLI::App* command_;
};

/// What a command does when it is chosen. Returns the exit code of the program; errors are thrown
/// (libvox/core/error.h).
using Action = std::function<int()>;

Action addConvert(CLI::App& app);
Action addSubdivide(CLI::App& app);
Action addInfo(CLI::App& app);
Action addDiff(CLI::App& app);
Action addMerge(CLI::App& app);
Action addCheck(CLI::App& app);
Action addRender(CLI::App& app);

}  // namespace vox::app
