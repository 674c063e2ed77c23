#pragma once

#include "apps/bench/compare.h"
#include "apps/bench/suite.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vox::bench {

/// The file that a program has written.
struct Output {
  double fileBytes = 0;                      ///< 0: no file
  std::optional<std::uint64_t> voxels = {};  ///< active, of all grids
};

/// A way from a mesh to voxels, at several resolutions.
struct Contender {
  std::string name;
  std::string against;               ///< name of the vox contender for the same grid; empty: itself
  std::vector<Output> outputs = {};  ///< one per side
  /// One per dim of the contest. Nothing if the contender was not run, because it had failed or
  /// exceeded a limit at a lower dim.
  std::vector<std::optional<Side>> sides = {};
};

/// vox and other programs for the same task, on one mesh.
struct Contest {
  std::string input;
  std::vector<int> dims;
  std::vector<Contender> contenders;
};

/// Runs a contest. At every resolution all contenders take turns, so that other load of the machine
/// affects all alike. A contender that fails or exceeds a limit is not run at higher resolutions.
///
///   - vox: vertices; polygons, 6- and 26-separating; level set;
///   - CGAL: Doo-Sabin down to the voxel, then rounding, or OpenVDB's meshToVolume;
///   - vdb_tool: a level set of a mesh that `vox subdivide` has refined to faces of a few voxels;
///   - Blender: Subdivision Surface (Catmull-Clark) to as many faces, then Mesh to Volume;
///   - OpenSubdiv: Catmull-Clark refinement to as many faces, without voxels.
///
/// @throws std::runtime_error  the input is neither a mesh file nor one that can be generated
Contest holdContest(const Tools& tools, const std::string& input, const std::vector<int>& dims,
                    int runs, const Limits& limits, const std::filesystem::path& folder,
                    const Progress& progress);

}  // namespace vox::bench
