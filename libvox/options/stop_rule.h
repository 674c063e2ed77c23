#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vox {

/// Largest number of levels of a stop rule. A face has 4^30 descendants there, more than fit into
/// any memory.
inline constexpr int kMostLevels = 30;

/// How far a surface is subdivided before it is voxelized. Each vertex is subdivided until one of
/// the limits that are set is met. If no limit is set, it is subdivided until the vertices are so
/// close that marking the voxel of each leaves no gap (vertex conversion, DESIGN section 9).
struct StopRule {
  std::optional<int> levels = {};       ///< Doo-Sabin steps, 0..kMostLevels
  std::optional<double> diameter = {};  ///< L-inf diameter of the faces, voxels, > 0
  std::optional<double> angle = {};     ///< between normals of adjacent faces, degrees, in (0, 180]
  std::optional<double> flatness = {};  ///< distance of faces from the surface, voxels, > 0

  bool untilVoxel() const { return !levels && !diameter && !angle && !flatness; }
  bool operator==(const StopRule&) const = default;
};

/// Message that says what is wrong with a rule; empty if it is valid.
std::string faultOf(const StopRule& rule);

/// Name of the rule on the command line: "voxel", "levels=3", "angle=5,diameter=4".
std::string stopRuleName(const StopRule& rule);

/// Rule of the name; nothing if the name is not valid. Parts are separated by commas. If a kind is
/// given twice, the limit that is met first counts. "voxel" beside other parts means diameter=1.
std::optional<StopRule> stopRuleNamed(std::string_view name);

/// All valid names, as a message lists them.
std::string allStopRuleNames();

}  // namespace vox
