// Regular patches and single vertices of the faces of a submesh.

#include "libvox/subdivide/local_surface.h"

#include "libvox/subdivide/sizes.h"
#include "libvox/subdivide/stop.h"

#include <algorithm>

namespace vox {
void LocalSurface::emit(std::span<const Index> faces, SurfaceSink& sink) {
  images_.set(faces);
  const std::size_t vFacePoints = images_.vFacePoints().size();
  vFaceKnown_.assign(images_.vFaces().size(), false);
  vFaceDiameters_.resize(images_.vFaces().size());
  vFaceActive_.assign(vFacePoints, false);
  for (auto* points : {&vFaceImages_, &vFaceNear_, &vFaceFar_, &vFaceCorner_})
    points->resize(vFacePoints);
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
  const LocalImages::VFace& vFace = subdividedVFace(at);
  finishedChildren_.push_back(facePoints_[at.place]);
  finishedChildren_.push_back(quadImage(center, images_.image(at.next()), right.near, right.far));
  finishedChildren_.push_back(quadImage(center, images_.image(at.previous()), left.far, left.near));
  finishedChildren_.push_back(vFaceImages_[vFace.begin + images_.placeInVFace(at.slot())]);
}

/// One step at a level-1 vertex. Emits the children that are regular or fine enough; the others
/// become active corners of the face or the V-face in which they lie.
void LocalSurface::split(const Corner& at, SurfaceSink& sink) {
  VertexSplit split = images_.splitAt(at, facePoints_);
  splitInVFace(at, split);
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
  else if (fits(std::max(vFaceDiameters_[images_.vFaceNumber(at.slot())], sizes.vFace)))
    finishedChildren_.push_back(split.vFace0);
  else if (split.hasVFace && vFace.size > 1)
    joinVFace(at, split);
  else if (split.hasVFace)
    subdivideBoundaryCorner(
        TriangleImages(images_.image(at.slot()), vFace.mStart, vFace.mEnd).below(split), 2, sink);
}

/// The V-face of a corner. Computes its points of level 2 if they are not known yet.
const LocalImages::VFace& LocalSurface::subdividedVFace(const Corner& at) {
  const LocalImages::VFace& vFace = images_.vFace(at.slot());
  const Index number = images_.vFaceNumber(at.slot());
  if (!vFaceKnown_[number]) {
    const auto images = std::span(vFaceImages_).subspan(vFace.begin, vFace.size);
    faceImages_.of(std::span(images_.vFacePoints()).subspan(vFace.begin, vFace.size), images);
    vFaceDiameters_[number] = diameter(images);
    vFaceKnown_[number] = true;
  }
  return vFace;
}

/// Sets the images in the V-face.
void LocalSurface::splitInVFace(const Corner& at, VertexSplit& split) {
  split.hasVFace = images_.hasVFace(at.slot());
  if (!split.hasVFace) return;
  if (images_.vFace(at.slot()).size == 1) {
    const LocalImages::VFace& vFace = images_.vFace(at.slot());
    return TriangleImages(images_.image(at.slot()), vFace.mStart, vFace.mEnd).setVFace(split);
  }
  const LocalImages::VFace& vFace = subdividedVFace(at);
  const Index place = images_.placeInVFace(at.slot());
  split.vFace0 = vFaceImages_[vFace.begin + place];
  split.vFaceRight = vFaceImages_[vFace.before(place)];
  split.vFaceLeft = vFaceImages_[vFace.after(place)];
  if (vFace.size == 4) split.vFaceOpposite = vFaceImages_[vFace.begin + (place ^ 2U)];
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

/// Makes the corner an active corner of its V-face at level 2. In the V-face the next corner lies
/// across L.
void LocalSurface::joinVFace(const Corner& at, const VertexSplit& split) {
  const LocalImages::VFace& vFace = images_.vFace(at.slot());
  const Index place = images_.placeInVFace(at.slot());
  const Index i = vFace.begin + place;
  const Index j = vFace.before(place);
  vFaceNear_[i] = split.l[0];
  vFaceFar_[i] = split.l[3];
  vFaceNear_[j] = split.r[3];
  vFaceFar_[j] = split.r[0];
  vFaceCorner_[i] = split.f0;
  vFaceActive_[i] = true;
}

void LocalSurface::emitVFaces(SurfaceSink& sink) {
  const auto part = [](const auto& all, const LocalImages::VFace& vFace) {
    return std::span(all).subspan(vFace.begin, vFace.size);
  };
  for (const LocalImages::VFace& vFace : images_.vFaces()) {
    const auto active = part(vFaceActive_, vFace);
    if (std::find(active.begin(), active.end(), true) == active.end()) continue;
    const auto copy = [&](const auto& from, auto& to) {
      const auto points = part(from, vFace);
      to.assign(points.begin(), points.end());
    };
    vFace_.reset(vFace.size);
    copy(vFaceImages_, vFace_.inner);
    copy(vFaceNear_, vFace_.near);
    copy(vFaceFar_, vFace_.far);
    copy(vFaceCorner_, vFace_.corner);
    copy(vFaceActive_, vFace_.active);
    vFace_.real = vFace.fan;
    extraordinary_.run(vFace_, 2, sink);
  }
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
