#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/options/stop_rule.h"
#include "libvox/subdivide/criterion.h"
#include "libvox/subdivide/vertex_array.h"

#include <memory>
#include <optional>
#include <vector>

namespace vox {

/// Boundary points across R and L of a vertex next to the boundary of an extended surface, each
/// with its neighbours: they go as deep as the vertex does along u and along v.
struct BoundaryCurves {
  std::optional<CurvePoints> acrossR, acrossL;
};

/// How deep level-1 vertices go for a stop rule, each from its own surroundings. For each limit the
/// depth at which all descendants and the faces around them keep it; the least of these.
class DepthRule {
 public:
  /// @param rule  with a limit besides levels, or levels >= 1
  explicit DepthRule(const StopRule& rule);

  /// @param faces  of an irregular vertex, or null
  VertexDepth of(const LevelOneVertex& vertex, const VertexFaces* faces,
                 const BoundaryCurves& curves) const;

  /// Depth that would do for a regular vertex within the array of another, if that is less than its
  /// own.
  VertexDepth within(const Patch& patch, VertexDepth own) const;

 private:
  int most_;  ///< levels below level 1
  std::vector<std::unique_ptr<Criterion>> criteria_;
};

}  // namespace vox
