#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/face_shape.h"
#include "libvox/subdivide/vertex_array.h"

#include <algorithm>
#include <array>

namespace vox {

/// The four faces around a vertex at its own level, in the figure of vertex_split.h.
struct VertexFaces {
  /// The vertex; its neighbours in F, beside R and L; its neighbours in the V-face, beside R and L.
  Vec3d at, next, previous, right, left;
  FaceShape f, vFace;
  std::array<Vec3d, 4> r, l;  ///< corners of R: at, next, ...; corners of L: at, previous, ...
  bool hasR, hasL, hasVFace;

  /// Sets all but the shapes.
  /// @param around  the patch around the vertex; its corners in F and in the V-face are not used
  explicit VertexFaces(const Patch& around) : VertexFaces(around.points, around.quadrants) {}

 private:
  VertexFaces(const std::array<std::array<Vec3d, 3>, 3>& p, unsigned quadrants)
      : at(p[1][1]),
        next(p[2][1]),
        previous(p[1][2]),
        right(p[1][0]),
        left(p[0][1]),
        r{at, next, p[2][0], right},
        l{at, previous, p[0][2], left},
        hasR((quadrants & 4U) != 0),
        hasL((quadrants & 2U) != 0),
        hasVFace((quadrants & 1U) != 0) {}
};

/// L-inf length of the longest of the two edges of a piece of a curve. Edges of level k are at most
/// 2^k times shorter.
inline double longestEdge(const CurvePoints& points) {
  return std::max((points[1] - points[0]).lpNorm<Eigen::Infinity>(),
                  (points[2] - points[1]).lpNorm<Eigen::Infinity>());
}

/// A limit for polygons, one kind of stop rule. Depths are numbers of levels below a vertex.
/// Lengths in voxels. Const and thread-safe.
class Criterion {
 public:
  virtual ~Criterion() = default;
  /// Least depth, the same along u and v, at which all descendants of a regular vertex meet the
  /// limit; at most `most`.
  virtual int squareDepth(const Patch& patch, int most) const = 0;
  /// The same, but the depths along u and v may differ if that gives fewer descendants.
  virtual VertexDepth regularDepth(const Patch& patch, int most) const = 0;
  /// Whether an irregular vertex meets the limit at its own level.
  virtual bool fine(const VertexFaces& faces) const = 0;
  /// Least depth at which a boundary curve meets the limit, if the faces beside it do not tell; at
  /// most `most`.
  virtual int curveDepth(const CurvePoints&, int /*most*/) const { return 0; }
  /// Least depth at which the curve of a crease by itself meets the limit; at most `most`.
  virtual int creaseDepth(const CurvePoints& points, int most) const = 0;
};

}  // namespace vox
