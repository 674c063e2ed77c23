#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/inspect/components.h"
#include "libvox/inspect/lint.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vox {

/// What a check of a file found.
struct CheckedFile {
  std::string file;                             ///< as typed
  std::vector<std::string> command;             ///< words that make the same check
  std::shared_ptr<openvdb::GridBase> grid;      ///< whose voxels were checked; null: none
  std::vector<Component> components, enclosed;  ///< of these voxels
  std::vector<std::string> notes;               ///< sentences besides
  std::vector<LintFinding> findings;
  std::vector<VoxelIndex> places;  ///< voxels where something was found
};

/// A page of HTML for people: faults and warnings, the checked grid in pictures with the places
/// marked, and a view that turns. It stands alone and has less than 2 MB. The same findings give
/// the same bytes.
std::string checkReport(const CheckedFile& checked);

}  // namespace vox
