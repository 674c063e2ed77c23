#pragma once

#include <string>

namespace CLI {
class App;
}

namespace vox::app {

// What the option table says, in other forms. The program prints them for --man and
// --bash-completion, which --help does not show; the build installs them.

/// Manual page of section 1, as roff.
std::string manualPage(const CLI::App& app);

/// A script that bash sources: commands, options, and values where there are a few words.
std::string bashCompletion(const CLI::App& app);

}  // namespace vox::app
