#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/options/stop_rule.h"
#include "libvox/subdivide/criterion.h"
#include "libvox/subdivide/vertex_array.h"

#include <memory>
#include <optional>
#include <vector>

namespace vox {

/// Boundary points across R and L of a vertex beside the boundary of an extended surface, each with
/// its two neighbours along the boundary. They are refined as deep as the vertex is along u (across
/// R) and v (across L).
struct BoundaryCurves {
  std::optional<CurvePoints> acrossR, acrossL;
};

/// The depth of level-1 vertices by a stop rule; it depends only on the faces around the vertex.
/// For each limit there is a least depth at which all descendants and the faces around them meet
/// it. The least of these depths counts, but at most that of the limit `levels`. Thread-safe.
class DepthRule {
 public:
  /// @param rule  must have a limit besides `levels`, or levels >= 1
  explicit DepthRule(const StopRule& rule);

  /// Depth of a level-1 vertex.
  /// @param faces  the faces around an irregular vertex; null for a regular one
  VertexDepth of(const LevelOneVertex& vertex, const VertexFaces* faces,
                 const BoundaryCurves& curves) const;

  /// Depth of the curve of a crease. It depends on the curve alone, so that both sides have it.
  int ofCrease(const CurvePoints& points) const;

  /// Depth that is enough for a block of an array (VertexArray).
  /// @param own  depth of the block; returned if no limit needs fewer vertices
  VertexDepth within(const Patch& patch, VertexDepth own) const;

 private:
  int most_;  ///< levels below level 1
  std::vector<std::unique_ptr<Criterion>> criteria_;
};

}  // namespace vox
