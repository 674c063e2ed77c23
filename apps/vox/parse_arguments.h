#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace vox::app {

/// Parses a command line.
/// @param arguments  without the name of the program
/// @throws UsageError    one line: what is wrong, and the nearest known word if one is unknown
/// @throws CLI::Success  help, or another text of the program, is asked for
void parseArguments(CLI::App& app, const std::vector<std::string>& arguments);

}  // namespace vox::app
