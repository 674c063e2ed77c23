#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vox {

/// More levels than any mesh has room for.
inline constexpr int kMostLevels = 30;

/// How far a surface is subdivided before it is voxelized.
struct StopRule {
  /// Doo-Sabin steps of the whole mesh, 0..kMostLevels, whose polygons are voxelized then. Nothing:
  /// until its vertices stand as close as voxels, which alone are voxelized.
  std::optional<int> levels;
};

/// Name on the command line: "voxel", "levels=3".
std::string stopRuleName(const StopRule& rule);

/// Rule of that name, or nothing.
std::optional<StopRule> stopRuleNamed(std::string_view name);

/// For messages: "voxel, levels=K with K from 0 to 30".
std::string allStopRuleNames();

}  // namespace vox
