#include "apps/bench/scaling.h"

namespace vox::bench {
namespace {

using Values = std::vector<double> Side::*;

/// Fits an exponent to the medians of one kind of value; if `floor` is given, to their differences
/// from it.
std::optional<double> exponentOf(const Scaling& scaling, Values values, const Side* floor) {
  std::vector<double> voxels;
  std::vector<double> costs;
  for (const ScalingPoint& point : scaling.points) {
    const Side& side = point.threads.b;
    if (!side.ok() || !side.voxels) continue;
    voxels.push_back(static_cast<double>(*side.voxels));
    costs.push_back(median(side.*values));
  }
  if (floor == nullptr) return fitExponent(voxels, costs);
  if (!floor->ok()) return std::nullopt;
  return fitExponentAbove(median(floor->*values), voxels, costs);
}

Exponents exponentsOf(const Scaling& scaling, const Side* floor) {
  return {exponentOf(scaling, &Side::wallSeconds, floor),
          exponentOf(scaling, &Side::cpuSeconds, floor),
          exponentOf(scaling, &Side::peakBytes, floor)};
}

}  // namespace

std::optional<double> ScalingPoint::efficiency(int threadCount) const {
  const std::vector<double> speedUps = ratios(threads.b.wallSeconds, threads.a.wallSeconds);
  if (speedUps.empty()) return std::nullopt;
  return median(speedUps) / threadCount;
}

Scaling measureScaling(const Tools& tools, const std::string& mesh, const std::vector<int>& dims,
                       int threads, int pairs, const Limits& limits,
                       const std::filesystem::path& folder, const Progress& progress) {
  Scaling scaling{.input = mesh,
                  .threads = threads,
                  .floor = measure(openvdbFloor(tools), pairs, limits, progress)};
  const std::filesystem::path file = meshNamed(tools, mesh, folder);
  for (const int dim : dims) {
    const auto onThreads = [&](int count) {
      const std::string number = std::to_string(count);
      Program program = voxConvert(tools, file, dim, folder / "vox.vdb", {"--threads", number});
      program.name += " --threads " + number;
      return program;
    };
    scaling.points.push_back({dim, compare("dim " + std::to_string(dim), onThreads(1),
                                           onThreads(threads), pairs, limits, progress)});
    if (!scaling.points.back().threads.b.ok()) break;
  }
  scaling.whole = exponentsOf(scaling, nullptr);
  scaling.aboveFloor = exponentsOf(scaling, &scaling.floor);
  return scaling;
}

}  // namespace vox::bench
