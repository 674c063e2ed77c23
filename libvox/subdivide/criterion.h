#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/face_shape.h"
#include "libvox/subdivide/vertex_array.h"

#include <array>

namespace vox {

/// What lies around a vertex at its own level.
struct VertexFaces {
  Vec3d at, next, previous, right, left;  ///< the vertex and those next to it, across R and L
  FaceShape f, vFace;
  std::array<Vec3d, 4> r, l;  ///< as quads
  bool hasR = true, hasL = true, hasVFace = true;
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

}  // namespace vox
