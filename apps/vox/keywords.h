#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace CLI {
class App;
}

namespace vox::app {

/// A keyword argument of a function that does the work of a command.
struct Keyword {
  std::string name;  ///< "voxel_size" is the option --voxel-size
  /// What a switch is, a value, or several values.
  std::variant<bool, std::string, std::vector<std::string>> value;
};

/// What a keyword argument means.
struct KeywordHelp {
  std::string name;  ///< "voxel_size"
  std::string type;  ///< "N"; empty for a switch
  std::string help;
};

/// A command whose options are keyword arguments. Handles of its options (Option) are valid as long
/// as this object lives.
class KeywordCommand {
 public:
  /// @param declare  adds one command
  explicit KeywordCommand(const std::function<void(CLI::App&)>& declare);
  ~KeywordCommand();
  KeywordCommand(const KeywordCommand&) = delete;
  KeywordCommand& operator=(const KeywordCommand&) = delete;

  /// Sets the variables of the options, as the command line does. Of several values, options that
  /// can be repeated get one each; others get them with commas between.
  /// @param arguments  those that are no keywords: inputs, and options that the caller decides
  /// @throws UsageError  as parseArguments; or a keyword is for the program only, such as `output`
  void parse(const std::vector<std::string>& arguments, const std::vector<Keyword>& keywords);

  /// The keywords that parse() takes.
  std::vector<KeywordHelp> help() const;

 private:
  std::unique_ptr<CLI::App> app_;
  CLI::App* command_;
};

}  // namespace vox::app
