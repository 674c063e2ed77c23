// Regular patches and single vertices of the faces of a submesh.

#include "libvox/subdivide/local_surface.h"

#include "libvox/subdivide/sizes.h"
#include "libvox/subdivide/stop.h"

#include <algorithm>

namespace vox {
void LocalSurface::emit(std::span<const Index> faces, SurfaceSink& sink) {
  images_.set(faces);
  vFaces_.reset(images_);
  finished_.clear();
  finishedChildren_.clear();

  Index slot = 0;
  for (const Index f : faces) {
    const Index size = images_.base().mesh.faceSize(f);
    emitFace(slot, size, sink);
    if (images_.extends()) emitBoundary(f, slot, sink);
    slot += size;
  }
  if (!finished_.empty()) sink.points(finished_, 1);
  if (!finishedChildren_.empty()) sink.points(finishedChildren_, 2);
  emitVFaces(sink);
}

void LocalSurface::emitFace(Index firstSlot, Index size, SurfaceSink& sink) {
  const auto points = images_.imagesOfFace(firstSlot, size);
  const double faceDiameter = diameter(points);
  const double contractionHere = std::max(contraction(size), contraction(4));
  irregular_.clear();
  for (Index i = 0; i < size; ++i) {
    const Corner at{firstSlot, i, size};
    if (isRegular(at)) {
      emitSmall(images_.patchAt(at), 1, finished_, sink);
      continue;
    }
    const double largest = diameterAround(at, faceDiameter);
    if (largest <= kVertexConversionSpan) {
      finished_.push_back(images_.image(at.slot()));
      continue;
    }
    const double contractionAround =
        std::max(contractionHere, contraction(images_.vFace(at.slot()).size));
    irregular_.push_back({at, isInside(at) && childrenFineEnough(largest, contractionAround)});
  }
  if (irregular_.empty()) return;

  facePoints_.resize(size);
  faceImages_.of(points, facePoints_);
  faceDiameter_ = diameter(facePoints_);
  joined_ = false;
  for (const auto& [at, last] : irregular_)
    if (last)
      finishChildren(at);
    else
      split(at, sink);
  if (joined_) extraordinary_.run(around_, 2, sink);
}

bool LocalSurface::isRegular(const Corner& at) const {
  if (at.size != 4) return false;
  const LocalImages::VFace& vFace = images_.vFace(at.slot());
  return vFace.size == 4 || !images_.hasVFace(at.slot());
}

/// Largest diameter of the faces around a level-1 vertex.
double LocalSurface::diameterAround(const Corner& at, double faceDiameter) const {
  return std::max({faceDiameter, images_.edgeFace(at.slot()).diameter,
                   images_.edgeFace(at.previous()).diameter, images_.vFace(at.slot()).diameter});
}

/// Whether no face around a level-1 vertex is at the boundary.
bool LocalSurface::isInside(const Corner& at) const {
  return images_.vFace(at.slot()).closed && images_.edgeFace(at.slot()).interior &&
         images_.edgeFace(at.previous()).interior;
}

/// Emits a regular vertex of `level`; if it is fine enough, appends it to `finished` instead.
void LocalSurface::emitSmall(const Patch& patch, int level, std::vector<Vec3d>& finished,
                             SurfaceSink& sink) {
  if (patchDepth(patch) == 0)
    finished.push_back(patch.points[1][1]);
  else
    emitRegular(patch, level, sink);
}

/// Collects the four children of a level-1 vertex inside the surface; they are fine enough.
void LocalSurface::finishChildren(const Corner& at) {
  const LocalImages::EdgeFace& right = images_.edgeFace(at.slot());
  const LocalImages::EdgeFace& left = images_.edgeFace(at.previous());
  const Vec3d& center = images_.image(at.slot());
  const auto inVFace = vFaces_.points(images_, images_.vFaceNumber(at.slot()));
  finishedChildren_.push_back(facePoints_[at.place]);
  finishedChildren_.push_back(quadImage(center, images_.image(at.next()), right.near, right.far));
  finishedChildren_.push_back(quadImage(center, images_.image(at.previous()), left.far, left.near));
  finishedChildren_.push_back(inVFace[images_.placeInVFace(at.slot())]);
}

/// One step at a level-1 vertex. Emits the children that are regular or fine enough; the others
/// become active corners of the face or the V-face in which they lie.
void LocalSurface::split(const Corner& at, SurfaceSink& sink) {
  VertexSplit split = images_.splitAt(at, facePoints_);
  vFaces_.setImages(images_, at, split);
  const ChildSizes sizes = isInside(at) ? childSizes(split) : kUnknownSizes;

  const LocalImages::VFace& vFace = images_.vFace(at.slot());
  const auto fits = [](double size) { return size <= kVertexConversionSpan; };
  if (fits(sizes.r))
    finishedChildren_.push_back(split.r[0]);
  else if (split.hasR)
    emitRegular(split.childInR(), 2, sink);
  if (fits(sizes.l))
    finishedChildren_.push_back(split.l[0]);
  else if (split.hasL)
    emitRegular(split.childInL(), 2, sink);
  if (at.size == 4)
    emitSmall(split.childInF(), 2, finishedChildren_, sink);
  else if (fits(std::max(faceDiameter_, sizes.f)))
    finishedChildren_.push_back(split.f0);
  else
    joinFace(at, split);
  if (split.hasVFace && vFace.size == 4)
    emitSmall(split.childInVFace(), 2, finishedChildren_, sink);
  else if (fits(std::max(vFaces_.diameter(images_.vFaceNumber(at.slot())), sizes.vFace)))
    finishedChildren_.push_back(split.vFace0);
  else if (split.hasVFace && vFace.size > 1)
    vFaces_.join(images_, at, split);
  else if (split.hasVFace)
    subdivideBoundaryCorner(
        TriangleImages(images_.image(at.slot()), vFace.mStart, vFace.mEnd).below(split), 2, sink);
}

/// Makes the corner an active corner of its face at level 2.
void LocalSurface::joinFace(const Corner& at, const VertexSplit& split) {
  if (!joined_) {
    around_.reset(at.size);
    around_.inner = facePoints_;
    joined_ = true;
  }
  const std::size_t i = at.place;
  const std::size_t j = at.previous() - at.first;
  around_.join(i, split);
  around_.hasEdge[i] = split.hasR;
  around_.hasEdge[j] = split.hasL;
  around_.hasCorner[i] = split.hasR && split.hasL && split.hasVFace;
}

void LocalSurface::emitVFaces(SurfaceSink& sink) {
  for (const LocalImages::VFace& vFace : images_.vFaces())
    if (vFaces_.get(vFace, vFace_)) extraordinary_.run(vFace_, 2, sink);
}

/// Emits the boundary points of the boundary edges of a face.
void LocalSurface::emitBoundary(Index f, Index firstSlot, SurfaceSink& sink) {
  const PolygonMesh& mesh = images_.base().mesh;
  const Index size = mesh.faceSize(f);
  for (Index i = 0; i < size; ++i) {
    const Index c = mesh.faceOffsets[f] + i;
    if (images_.base().adjacency.twin[c] != kNone) continue;
    const Corner at{firstSlot, i, size};
    const LocalImages::VFace& start = images_.vFace(at.slot());
    const LocalImages::VFace& end = images_.vFace(at.next());
    const double edge = images_.edgeFace(at.slot()).diameter;
    const auto emit = [&](const CurvePoints& points, double vFaceDiameter) {
      const int k = curveDepth(std::max(edge, vFaceDiameter));
      sink.curve(points, k, 1 + k);
    };
    emit({start.mEnd, start.mStart, end.mEnd}, start.diameter);
    emit({start.mStart, end.mEnd, end.mStart}, end.diameter);
  }
}

}  // namespace vox
