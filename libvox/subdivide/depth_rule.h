#pragma once

#include "libvox/mesh/stop_rule.h"
#include "libvox/subdivide/face_shape.h"
#include "libvox/subdivide/vertex_array.h"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace vox {

/// What lies around a vertex at its own level.
struct VertexFaces {
  Vec3d at, next, previous, right, left;  ///< the vertex and those next to it, across R and L
  FaceShape f, k;
  std::array<Vec3d, 4> r, l;  ///< as quads
  bool hasR = true, hasL = true, hasK = true;
};

/// Boundary points across R and L of a vertex next to the boundary of an extended surface, each
/// with its neighbours: they go as deep as the vertex does along u and along v.
struct BoundaryCurves {
  std::optional<CurvePoints> acrossR, acrossL;
};

/// A limit that the polygons are to keep. Lengths in voxels.
class Criterion {
 public:
  virtual ~Criterion() = default;
  /// Levels at which all that becomes of a regular vertex keeps it, the same along u and v; at most
  /// `most`.
  virtual int squareDepth(const Patch& patch, int most) const = 0;
  /// The same with as few descendants as different depths along u and v make possible.
  virtual VertexDepth regularDepth(const Patch& patch, int most) const = 0;
  /// Whether an irregular vertex keeps it as it stands.
  virtual bool fine(const VertexFaces& faces) const = 0;
  /// Levels at which a boundary curve does.
  virtual int curveDepth(const CurvePoints&, int /*most*/) const { return 0; }
};

/// How deep level-1 vertices go for a stop rule, each from its own surroundings. For each limit the
/// depth at which all descendants and the faces around them keep it; the least of these.
///
/// diameter: faces k levels below a regular vertex measure at most 2^-k (max |du| + max |dv|).
/// flatness: with second differences Duu, Dvv and twists Duv of the control points, the faces of a
///   regular vertex, cut along a diagonal, and the surface differ by at most (4^-u |Duu| + 4^-v
///   |Dvv|) / 8 + 2^-(u+v) |Duv| / 4 where they have the same parameters. Of that, only what points
///   along the normal is distance, as far as the normal is one: tangential parts count by the sine
///   of the angle between the patch's mean normal and the farthest of its faces.
/// angle: measured between all faces around the descendants; faces that fit into a voxel may turn
///   as they like, so that folds come to an end.
/// Around an extraordinary face: the rings' regular vertices, and where they end its own
/// surroundings.
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
