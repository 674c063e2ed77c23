#pragma once

#include <string>

namespace CLI {
class App;
}

namespace vox::app {

// The option table in other forms. The program prints them for the options --man, --markdown and
// --bash-completion, which --help does not show.

/// Manual page of section 1, as roff. The build installs it.
std::string manualPage(const CLI::App& app);

/// One section of Markdown for each command: its usage and a table of its options. An option that
/// an earlier command shares is not described again. tests/options_readme.sh puts the sections into
/// apps/vox/README.md.
std::string markdownTables(const CLI::App& app);

/// A script that bash sources: commands, options, and values where there are a few words. The build
/// installs it.
std::string bashCompletion(const CLI::App& app);

}  // namespace vox::app
