#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vox {

/// More levels than fit into memory for any mesh.
inline constexpr int kMostLevels = 30;

/// How far a surface is subdivided before it is voxelized: each vertex until it meets the first of
/// these limits. Without limits: until the vertices are as close as voxels.
struct StopRule {
  std::optional<int> levels = {};       ///< Doo-Sabin steps, 0..kMostLevels
  std::optional<double> diameter = {};  ///< L-inf diameter of the faces, voxels, > 0
  std::optional<double> angle = {};     ///< between normals of adjacent faces, degrees, in (0, 180]
  std::optional<double> flatness = {};  ///< distance of faces from the surface, voxels, > 0

  bool untilVoxel() const { return !levels && !diameter && !angle && !flatness; }
  bool operator==(const StopRule&) const = default;
};

/// What is wrong with a rule, for messages; empty if it is valid.
std::string faultOf(const StopRule& rule);

/// Name on the command line: "voxel", "levels=3", "angle=5,diameter=4".
std::string stopRuleName(const StopRule& rule);

/// The rule of that name; empty if there is none. Limits are separated by commas. If the same kind
/// of limit occurs twice, the one that is met first counts. "voxel" among other limits means
/// diameter=1.
std::optional<StopRule> stopRuleNamed(std::string_view name);

/// For messages.
std::string allStopRuleNames();

}  // namespace vox
