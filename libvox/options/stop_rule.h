#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vox {

/// More levels than any mesh has room for.
inline constexpr int kMostLevels = 30;

/// How far a surface is subdivided before it is voxelized: each vertex until it meets one of these,
/// whichever comes first. With none of them, until the vertices stand as close as voxels.
struct StopRule {
  std::optional<int> levels = {};       ///< Doo-Sabin steps, 0..kMostLevels
  std::optional<double> diameter = {};  ///< L-inf diameter of the faces, voxels, > 0
  std::optional<double> angle = {};     ///< between normals of adjacent faces, degrees, in (0, 180]
  std::optional<double> flatness = {};  ///< distance of faces from the surface, voxels, > 0

  bool untilVoxel() const { return !levels && !diameter && !angle && !flatness; }
  bool operator==(const StopRule&) const = default;
};

/// What is wrong with a rule, for messages; empty if nothing.
std::string faultOf(const StopRule& rule);

/// Name on the command line: "voxel", "levels=3", "angle=5,diameter=4".
std::string stopRuleName(const StopRule& rule);

/// Rule of that name, or nothing. Parts are separated by commas; of a kind given twice the first to
/// be met counts. "voxel" beside others stands for diameter=1.
std::optional<StopRule> stopRuleNamed(std::string_view name);

/// For messages.
std::string allStopRuleNames();

}  // namespace vox
