#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace vox::app {

/// A subcommand: its options, declared once for parsing and help, and what it does when chosen.
/// Each returns the exit code of the program; errors are thrown (libvox/core/error.h).
using Action = std::function<int()>;

Action addConvert(CLI::App& app);
Action addSubdivide(CLI::App& app);
Action addInfo(CLI::App& app);
Action addDiff(CLI::App& app);
Action addCheck(CLI::App& app);
Action addRender(CLI::App& app);

}  // namespace vox::app
