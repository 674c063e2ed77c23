#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/extraordinary.h"
#include "libvox/subdivide/local_images.h"
#include "libvox/subdivide/v_face_level.h"
#include "libvox/subdivide/vertex_split.h"

#include <span>
#include <vector>

namespace vox {

/// Subdivides submeshes of a base mesh, each vertex only until it is fine enough (stop.h). A
/// refined mesh is never built: a regular vertex goes to the sink as a patch, and the irregular
/// vertices around an extraordinary face or vertex are subdivided level by level
/// (ExtraordinaryFace).
///
/// A face owns its corners. A corner owns the level-1 vertex that it makes and all descendants of
/// this vertex; at an extended boundary also the boundary points of its edge. So if submeshes cover
/// the mesh once, every vertex is emitted exactly once, and its bits do not depend on the
/// partition.
///
/// One object per thread. Source: paper section 4; DESIGN section 7.
class LocalSurface {
 public:
  /// @param base  level 0, in index space: an oriented manifold with one fan of faces at each
  /// vertex
  explicit LocalSurface(const SubdivisionLevel& base) : images_(base) {}

  /// Gives the sink all vertices that the corners of some faces own, each at its own level.
  /// @param faces  of the base; the span must stay valid until the next call
  /// @throws LimitError  coordinates are out of range
  void emit(std::span<const Index> faces, SurfaceSink& sink);

 private:
  using Corner = SlotCorner;

  void emitFace(Index firstSlot, Index size, SurfaceSink& sink);
  bool isRegular(const Corner& corner) const;
  double diameterAround(const Corner& corner, double faceDiameter) const;
  bool isInside(const Corner& corner) const;
  static void emitSmall(const Patch& patch, int level, std::vector<Vec3d>& finished,
                        SurfaceSink& sink);
  void finishChildren(const Corner& corner);
  void split(const Corner& corner, SurfaceSink& sink);
  void joinFace(const Corner& corner, const VertexSplit& split);
  void emitVFaces(SurfaceSink& sink);
  void emitBoundary(Index f, Index firstSlot, SurfaceSink& sink);

  LocalImages images_;
  FaceImages faceImages_;
  std::vector<Vec3d> finished_;          // level-1 vertices that are fine enough
  std::vector<Vec3d> finishedChildren_;  // level-2 vertices that are fine enough
  std::vector<Vec3d> facePoints_;        // level 2 in one face
  double faceDiameter_ = 0;              // of facePoints_
  struct Irregular {
    Corner at;
    bool last;  // its children are fine enough
  };
  std::vector<Irregular> irregular_;  // corners of one face
  ExtraordinaryFace around_;          // the face at level 2, if it is not a quad
  bool joined_ = false;               // whether around_ has active corners
  VFaceLevel vFaces_;
  ExtraordinaryFace vFace_;  // a V-face at level 2
  ExtraordinarySubdivision extraordinary_;
};

}  // namespace vox
