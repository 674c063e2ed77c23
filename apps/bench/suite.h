#pragma once

#include "apps/bench/compare.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vox::bench {

/// Paths of the programs that comparisons run.
struct Tools {
  std::filesystem::path vox;
  std::filesystem::path inputsWriter;  ///< vox_bench_inputs_write
  std::filesystem::path peers;         ///< folder of vox_peer_*
};

/// The tools in the same build as the program `self`.
Tools toolsBeside(const std::filesystem::path& self);

/// `vox convert --grids mask` of a mesh at a resolution, to a file.
/// @param more  further arguments
Program voxConvert(const Tools& tools, const std::filesystem::path& mesh, int dim,
                   const std::filesystem::path& output, const std::vector<std::string>& more = {});

/// A program that loads OpenVDB and ends.
Program openvdbFloor(const Tools& tools);

/// Mesh file for a name given by the user: an existing file, or a generated mesh, which is written
/// to the folder.
/// @param extension  of a generated mesh
/// @throws std::runtime_error  the name is neither
std::filesystem::path meshNamed(const Tools& tools, const std::string& name,
                                const std::filesystem::path& folder,
                                const char* extension = ".obj");

/// A built-in comparison, ready to run.
struct Case {
  std::string name;
  Program a;
  Program b;
};

/// A mesh of the user for comparisons, in addition to the generated ones.
struct UserInput {
  std::string file = {};  ///< empty: none
  int dim = 1024;
};

/// Names of the suites:
///   issue  vox against loading OpenVDB, CGAL and the naive program, on the user's mesh, torus at
///          2048, cube at 1024 and the even and graded triangle meshes at 256
///   hard   vox on the torus at 2048 against vox on each mesh that invites a blow-up
///   scan   masks and level sets of scans of 1, 4 and 10 million triangles at 1024 against
///   vdb_tool;
///          a scan against the same in random order
const std::vector<std::string>& suiteNames();

/// The comparisons of a suite. Writes their meshes to the folder; their outputs go there, too.
std::vector<Case> suiteCases(const std::string& name, const Tools& tools, const UserInput& user,
                             const std::filesystem::path& folder);

}  // namespace vox::bench
