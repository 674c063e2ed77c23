#pragma once

#include <string>

namespace CLI {
class Option;
}

namespace vox::app {

/// Name of an option's value, "FILE"; empty if the option takes none.
std::string valueName(const CLI::Option& option);

/// Help text of an option, then its range, its default and whether it must be given.
std::string description(const CLI::Option& option);

}  // namespace vox::app
