#pragma once

#include "apps/bench/compare.h"
#include "apps/bench/suite.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vox::bench {

/// What a program left behind.
struct Output {
  double fileBytes = 0;                      ///< 0: no file
  std::optional<std::uint64_t> voxels = {};  ///< active, of all grids
};

/// A way from a mesh to voxels, at some resolutions.
struct Contender {
  std::string name;
  std::string against;               ///< name of what makes the same of it with vox; empty: itself
  std::vector<Output> outputs = {};  ///< of the sides
  /// At the dims of the contest; nothing where it was not run any more, since it had failed or gone
  /// over a limit before.
  std::vector<std::optional<Side>> sides = {};
};

/// vox and what people would use instead, on one mesh.
struct Contest {
  std::string input;
  std::vector<int> dims;
  std::vector<Contender> contenders;
};

/// At every resolution all contenders take turns, so that whatever slows the machine down meets
/// all. One that fails, or goes over a limit, does not go on to the next resolution.
///   vox        vertices; polygons, 6- and 26-separating; level set
///   CGAL       Doo-Sabin down to the voxel, then rounding, or OpenVDB's meshToVolume
///   vdb_tool   a level set of the mesh that `vox subdivide` refined before, to faces of some
///   voxels Blender    Subdivision Surface (Catmull-Clark) to as many faces, and Mesh to Volume
///   OpenSubdiv Catmull-Clark refinement to as many faces, without voxels
/// @throws std::runtime_error  the input is neither a mesh file nor one that can be generated
Contest holdContest(const Tools& tools, const std::string& input, const std::vector<int>& dims,
                    int runs, const Limits& limits, const std::filesystem::path& folder,
                    const Progress& progress);

}  // namespace vox::bench
