// Regular patches and single vertices of the faces of a submesh.

#include "libvox/subdivide/local_surface.h"

#include "libvox/mesh/chaikin.h"
#include "libvox/subdivide/stop.h"
#include "libvox/subdivide/thin_patch.h"

#include <algorithm>
#include <array>
#include <utility>

namespace vox {
namespace {

/// Largest diameter of the faces around a corner; of mirrored faces, that of the real half.
double largestDiameter(const FaceCorner& corner, int level) {
  const auto& p = corner.around.points;
  const Vec3d& at = p[1][1];
  FaceLevels& face = corner.face;
  double size = face.diameter(level);
  const auto takeSide = [&](bool mirrored, const Vec3d& beside, const Vec3d& far,
                            const Vec3d& near) {
    size = std::max(size, mirrored ? diameter(at, middle(at, beside), middle(near, far), near)
                                   : diameter(at, beside, far, near));
  };
  const unsigned quadrants = corner.around.quadrants;
  if ((quadrants & 4U) != 0)
    takeSide(face.mirrored() && corner.place + 1 == face.real(), p[2][1], p[2][0], p[1][0]);
  if ((quadrants & 2U) != 0)
    takeSide(face.mirrored() && corner.place == 0, p[1][2], p[0][2], p[0][1]);
  if ((quadrants & 1U) != 0) size = std::max(size, diameter(at, p[1][0], p[0][0], p[0][1]));
  return size;
}

double largestDiameter(const BoundaryCorner& at) {
  const std::array<Vec3d, 3> triangle = {at.u, at.mStart, at.mEnd};
  return std::max({diameter(triangle), diameter(at.u, at.right, at.mRight, at.mStart),
                   diameter(at.u, at.left, at.mLeft, at.mEnd),
                   diameter(at.u, at.right, at.opposite, at.left)});
}

}  // namespace

/// Collects the vertices that are fine enough and gives other regular ones to a sink.
class LocalSurface::FineVertices {
 public:
  FineVertices(std::vector<std::vector<Vec3d>>& finished, SurfaceSink& sink)
      : finished_(finished), sink_(sink) {}

  void regular(const Patch& patch, int level, const CornerSquare& /*square*/) {
    const int depth = patchDepth(patch);
    if (depth == 0) return finish(patch.points[1][1], level);
    emitRegular(PatchPart(patch, depth), level, sink_);
  }

  bool ends(const FaceCorner& corner, int level, const CornerSquare& /*square*/) {
    const double largest = largestDiameter(corner, level);
    const auto& p = corner.around.points;
    if (largest <= kVertexConversionSpan) {
      finish(p[1][1], level);
      return true;
    }
    const double contractionHere = std::max(contraction(corner.face.size()), contraction(4));
    if (corner.face.mirrored() || corner.around.quadrants != kAllQuadrants ||
        !childrenFineEnough(largest, contractionHere))
      return false;
    finishChildren(corner.around, corner.face.corners(level + 1)[corner.place],
                   quadImage(p[1][1], p[1][0], p[0][1], p[0][0]), level);
    return true;
  }

  bool ends(const BoundaryCorner& corner, int level, const CornerSquare& /*square*/) {
    if (largestDiameter(corner) > kVertexConversionSpan) return false;
    finish(corner.u, level);
    return true;
  }

  void finish(const Vec3d& vertex, int level) {
    const auto count = static_cast<std::size_t>(level);
    if (finished_.size() < count) finished_.resize(count);
    finished_[count - 1].push_back(vertex);
  }
  /// Finishes the four children of a vertex of `level`.
  void finishChildren(const Patch& around, const Vec3d& inF, const Vec3d& inVFace, int level) {
    const auto& p = around.points;
    finish(inF, level + 1);
    finish(quadImage(p[1][1], p[2][1], p[1][0], p[2][0]), level + 1);
    finish(quadImage(p[1][1], p[1][2], p[0][1], p[0][2]), level + 1);
    finish(inVFace, level + 1);
  }
  void give(std::span<const Vec3d> vertices, int level) {
    if (!vertices.empty()) sink_.points(vertices, level);
  }
  /// Gives the sink what is finished.
  void flush() {
    for (std::size_t i = 0; i < finished_.size(); ++i) {
      give(finished_[i], static_cast<int>(i) + 1);
      finished_[i].clear();
    }
  }

 private:
  std::vector<std::vector<Vec3d>>& finished_;
  SurfaceSink& sink_;
};

void LocalSurface::emit(std::span<const Index> faces, SurfaceSink& sink) {
  vertices_.set(faces);
  FineVertices fine(finished_, sink);
  vertices_.images().forEachFace([&](const SubmeshCorner& first) {
    emitFace(first, fine);
    if (vertices_.images().extends()) emitBoundary(first, sink);
  });
  splitBatch(fine);
  fine.flush();
}

void LocalSurface::emitFace(const SubmeshCorner& first, FineVertices& fine) {
  const LocalImages& images = vertices_.images();
  const double faceDiameter = diameter(images.imagesOfFace(first.first, first.size));
  const double contractionHere = std::max(contraction(first.size), contraction(4));
  for (Index i = 0; i < first.size; ++i) {
    const SubmeshCorner at = first.at(i);
    if (!leftOut_.empty() && leftOut_[images.base().mesh.faceVertices[at.number]]) continue;
    if (images.isRegular(at)) {
      fine.regular(images.around(at), 1, {});
      continue;
    }
    const double largest = diameterAround(at, faceDiameter);
    if (largest <= kVertexConversionSpan) {
      fine.finish(images.image(at.slot()), 1);
      continue;
    }
    const double contractionAround =
        std::max(contractionHere, contraction(images.vFace(at.slot()).size));
    const LevelOneVertex vertex = vertices_.at(at);
    if (isInside(at) && childrenFineEnough(largest, contractionAround))
      fine.finishChildren(vertex.around, vertex.face->corners(2)[vertex.place],
                          vertex.vFace->corners(2)[vertex.placeInVFace], 1);
    else if (isInside(at) && vertex.face->size() != 4 && vertex.vFace->size() != 4)
      addToBatch(at, vertex, fine);
    else
      Descent(fine).below(vertex, {});
  }
}

/// Collects a vertex, to walk below it together with others.
void LocalSurface::addToBatch(const SubmeshCorner& at, const LevelOneVertex& vertex,
                              FineVertices& fine) {
  using B = SplitBatch;
  const std::size_t lane = inBatch_++;
  corners_[lane] = at;
  const auto& p = vertex.around.points;
  batch_.set(lane, B::kAt, p[1][1]);
  batch_.set(lane, B::kNext, p[2][1]);
  batch_.set(lane, B::kPrevious, p[1][2]);
  batch_.set(lane, B::kRight, p[1][0]);
  batch_.set(lane, B::kRightFar, p[2][0]);
  batch_.set(lane, B::kLeft, p[0][1]);
  batch_.set(lane, B::kLeftFar, p[0][2]);
  const auto setFace = [&](FaceLevels& face, std::size_t place, B::Point here, B::Point next,
                           B::Point previous, B::Point deep) {
    batch_.set(lane, deep, face.corners(3)[place]);
    const std::span<const Vec3d> images = face.corners(2);
    batch_.set(lane, here, images[place]);
    batch_.set(lane, next, images[place + 1 == images.size() ? 0 : place + 1]);
    batch_.set(lane, previous, images[(place == 0 ? images.size() : place) - 1]);
  };
  setFace(*vertex.face, vertex.place, B::kInF, B::kNextInF, B::kPreviousInF, B::kDeepInF);
  setFace(*vertex.vFace, vertex.placeInVFace, B::kInVFace, B::kLeftInVFace, B::kRightInVFace,
          B::kDeepInVFace);
  batch_.sizeOfF[lane] = vertex.face->diameter(2);
  batch_.sizeOfVFace[lane] = vertex.vFace->diameter(2);
  batch_.contractionInF[lane] = std::max(contraction(vertex.face->size()), contraction(4));
  batch_.contractionInVFace[lane] = std::max(contraction(vertex.vFace->size()), contraction(4));
  if (inBatch_ == B::kLanes) splitBatch(fine);
}

/// Makes what the collected vertices become.
void LocalSurface::splitBatch(FineVertices& fine) {
  const std::size_t count = std::exchange(inBatch_, 0);
  if (count == 0) return;
  splitAll(batch_, count, split_);
  fine.give(std::span(split_.level2).first(split_.count2), 2);
  fine.give(std::span(split_.level3).first(split_.count3), 3);
  for (std::size_t lane = 0; lane < count; ++lane)
    if ((split_.deeper >> lane & 1U) != 0) Descent(fine).below(vertices_.at(corners_[lane]), {});
}

/// Largest diameter of the faces around a level-1 vertex.
double LocalSurface::diameterAround(const SubmeshCorner& at, double faceDiameter) const {
  const LocalImages& images = vertices_.images();
  return std::max({faceDiameter, images.edgeFace(at.slot()).diameter,
                   images.edgeFace(at.previousSlot()).diameter, images.vFace(at.slot()).diameter});
}

/// Whether no face around a level-1 vertex is at the boundary.
bool LocalSurface::isInside(const SubmeshCorner& at) const {
  const LocalImages& images = vertices_.images();
  return images.vFace(at.slot()).closed && images.edgeFace(at.slot()).interior &&
         images.edgeFace(at.previousSlot()).interior;
}

/// Emits the boundary points of the boundary edges of a face.
void LocalSurface::emitBoundary(const SubmeshCorner& first, SurfaceSink& sink) {
  const LocalImages& images = vertices_.images();
  for (Index i = 0; i < first.size; ++i) {
    const SubmeshCorner at = first.at(i);
    if (!vertices_.isBoundary(at)) continue;
    const double edge = images.edgeFace(at.slot()).diameter;
    const auto emit = [&](const CurvePoints& points, double vFaceDiameter) {
      const int k = curveDepth(std::max(edge, vFaceDiameter));
      sink.curve(points, k, 1 + k);
    };
    emit(vertices_.curveAcrossR(at), images.vFace(at.slot()).diameter);
    emit(vertices_.curveAcrossL(at.next()), images.vFace(at.nextSlot()).diameter);
  }
}

}  // namespace vox
