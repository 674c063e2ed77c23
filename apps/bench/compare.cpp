#include "apps/bench/compare.h"

namespace vox::bench {
namespace {

/// Runs the program of a side once and, if that succeeds, appends its values.
void runOnce(Side& side, const Limits& limits) {
  side.last = runProcess(side.program.command, limits);
  if (!side.ok()) return;
  side.wallSeconds.push_back(side.last.wallSeconds);
  side.cpuSeconds.push_back(side.last.cpuSeconds);
  side.peakBytes.push_back(static_cast<double>(side.last.peakBytes));
  side.voxels = voxelsIn(side.last.output);
}

/// Runs the programs of the sides in turn. A program that has failed is not run again.
void runInTurn(const std::string& name, const std::vector<Side*>& sides, int runs,
               const Limits& limits, const Progress& progress) {
  for (int run = 1; run <= runs; ++run)
    for (Side* side : sides) {
      if (run > 1 && !side->ok()) continue;
      progress(name + ": " + side->program.name + ", run " + std::to_string(run) + " of " +
               std::to_string(runs));
      runOnce(*side, limits);
    }
}

}  // namespace

std::vector<double> Comparison::cpuPerVoxelRatios() const {
  if (a.voxels.value_or(0) == 0 || b.voxels.value_or(0) == 0) return {};
  const double fewer = static_cast<double>(*a.voxels) / static_cast<double>(*b.voxels);
  std::vector<double> result = cpuRatios();
  for (double& ratio : result) ratio *= fewer;
  return result;
}

Comparison compare(const std::string& name, const Program& a, const Program& b, int pairs,
                   const Limits& limits, const Progress& progress) {
  Comparison comparison{.name = name, .a = {.program = a}, .b = {.program = b}};
  runInTurn(name, {&comparison.a, &comparison.b}, pairs, limits, progress);
  return comparison;
}

std::vector<Side> measureInTurn(const std::string& name, const std::vector<Program>& programs,
                                int runs, const Limits& limits, const Progress& progress) {
  std::vector<Side> sides;
  for (const Program& program : programs) sides.push_back({.program = program});
  std::vector<Side*> all;
  for (Side& side : sides) all.push_back(&side);
  runInTurn(name, all, runs, limits, progress);
  return sides;
}

Side measure(const Program& program, int runs, const Limits& limits, const Progress& progress) {
  Side side{.program = program};
  runInTurn(program.name, {&side}, runs, limits, progress);
  return side;
}

}  // namespace vox::bench
