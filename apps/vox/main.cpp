// vox: from irregular polygon meshes to smooth voxel models.

#include "apps/vox/command.h"
#include "apps/vox/failure.h"
#include "apps/vox/interrupt.h"
#include "apps/vox/manual.h"
#include "apps/vox/parse_arguments.h"
#include "libvox/core/error.h"
#include "libvox/core/progress.h"
#include "libvox/core/version.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace vox::app {
namespace {

constexpr int kUsage = 2;
constexpr int kIo = 5;

int fail(const Failure& failure) {
  std::cerr << (failure.code == Cancelled::kExitCode ? "vox: " : "vox: error: ") << failure.message
            << '\n';
  return failure.code;
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
    parseArguments(app, {argv + std::min(argc, 1), argv + argc});
  } catch (const CLI::Success& asked) {
    return app.exit(asked);  // --help, --version
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
    if (!std::cout.flush()) return fail({"standard output cannot be written", kIo});
    return code;
  } catch (...) {
    return fail(currentFailure());
  }
}
