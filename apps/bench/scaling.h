#pragma once

#include "apps/bench/compare.h"
#include "apps/bench/suite.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vox::bench {

/// vox at one resolution: A on one thread, B on several.
struct ScalingPoint {
  int dim = 0;
  Comparison threads;

  /// Speed-up of the whole process over the number of threads: 1 is perfect.
  std::optional<double> efficiency(int threadCount) const;
};

/// Exponents e of cost = c voxels^e; nothing if there are too few points.
struct Exponents {
  std::optional<double> wall;
  std::optional<double> cpu;
  std::optional<double> peak;
};

/// Growth of the cost of vox with its output.
struct Scaling {
  std::string input;
  int threads = 0;
  Side floor;  ///< loading OpenVDB alone
  std::vector<ScalingPoint> points = {};
  Exponents whole = {};       ///< of medians of whole processes on `threads` threads
  Exponents aboveFloor = {};  ///< of the differences from the floor
};

/// Measures `vox convert` at rising resolutions; stops after the first that fails.
/// @param mesh  a mesh file or the name of a generated one
/// @param dims  in rising order
Scaling measureScaling(const Tools& tools, const std::string& mesh, const std::vector<int>& dims,
                       int threads, int pairs, const Limits& limits,
                       const std::filesystem::path& folder, const Progress& progress);

}  // namespace vox::bench
