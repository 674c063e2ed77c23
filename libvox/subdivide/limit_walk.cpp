// The limit surface as pieces: regular vertices, rings around extraordinary faces, and what closes
// the rings.

#include "libvox/subdivide/limit_walk.h"

#include "libvox/mesh/chaikin.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vox {
namespace {

/// Mean of the points of a face.
Vec3d centroidOf(std::span<const Vec3d> points) {
  Vec3d sum = Vec3d::Zero();
  for (const Vec3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// The fourth corner of a quad with a given centroid.
Vec3d fourthCorner(const Vec3d& centroid, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return 4.0 * centroid - a - b - c;
}

/// Bound of the distance, along the normal, between the surface and a piece that treats a face as a
/// quad. It follows from how much the next vertex in the face differs from the one in the quad.
/// @param inF    whether the face is the one at u = v = 1, else the one at u = v = 0
/// @param image  the next vertex in the face
/// @param faceSize  of the face
double errorAsQuad(const Patch& patch, bool inF, const Vec3d& image, std::size_t faceSize) {
  // Differences fall by 4 from level to level around small faces, by 2 around large ones.
  constexpr std::size_t kLarge = 7;
  const double perDifference = faceSize < kLarge ? 0.6 : 2;
  const auto& p = patch.points;
  const Vec3d& far = inF ? p[2][2] : p[0][0];
  const Vec3d& a = inF ? p[2][1] : p[0][1];
  const Vec3d& b = inF ? p[1][2] : p[1][0];
  const Vec3d difference = image - quadImage(p[1][1], a, b, far);
  const auto along = [&](const Vec3d& n) {
    const double size = n.norm();
    return size > 0 ? std::abs(n.dot(difference)) / size : difference.norm();
  };
  // A shift along the surface is an error as far as the normal turns: so all normals count, at the
  // vertex and in the four quads around it.
  double largest = along((p[2][1] - p[0][1]).cross(p[1][2] - p[1][0]));
  for (const std::size_t u : {0U, 1U})
    for (const std::size_t v : {0U, 1U})
      largest =
          std::max(largest, along((p[u + 1][v + 1] - p[u][v]).cross(p[u][v + 1] - p[u + 1][v])));
  return perDifference * largest;
}

/// Emits the piece of a regular vertex. If faces around the vertex are missing: the curves between
/// those that exist, to which its descendants converge, as pieces of hardly any width; so they have
/// normals.
void emitPiece(const Patch& patch, std::uint8_t sides, const CornerSquare& square,
               LimitSink& sink) {
  if (patch.quadrants == kAllQuadrants) return sink.piece({patch.points, sides, square});
  constexpr double kWidth = 1e-4;  // of the faces
  const auto& p = patch.points;
  const auto has = [&](unsigned quadrants) { return (patch.quadrants & quadrants) == quadrants; };
  /// @param narrowU, narrowV  whether the piece has no width along u, v
  /// @param u, v              its middle, 0 or 1 where it has no width
  const auto emitNarrow = [&](bool narrowU, std::size_t u, bool narrowV, std::size_t v) {
    const auto along = [&](bool narrow, std::size_t at, std::size_t i, const auto& point) -> Vec3d {
      if (!narrow) return point(i);
      const Vec3d across = point(at + 1) - point(at);
      return middle(point(at), point(at + 1)) + (static_cast<double>(i) - 1) * kWidth * across;
    };
    LimitPiece piece{{}, kAllSides, square};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        piece.points[i][j] = along(narrowU, u, i, [&](std::size_t k) -> Vec3d {
          return along(narrowV, v, j, [&](std::size_t l) -> Vec3d { return p[k][l]; });
        });
    sink.piece(piece);
  };
  if (has(1U | 2U)) emitNarrow(true, 0, false, 0);
  if (has(4U | 8U)) emitNarrow(true, 1, false, 0);
  if (has(1U | 4U)) emitNarrow(false, 0, true, 0);
  if (has(2U | 8U)) emitNarrow(false, 0, true, 1);
  if (patch.quadrants == 8U) emitNarrow(true, 1, true, 1);
}

/// The sides of a piece that its quarters in R, L, F and the V-face have.
constexpr unsigned kSidesInR = kSideU1 | kSideV0;
constexpr unsigned kSidesInL = kSideU0 | kSideV1;
constexpr unsigned kSidesInF = kSideU1 | kSideV1;
constexpr unsigned kSidesInVFace = kSideU0 | kSideV0;

std::uint8_t only(std::uint8_t sides, unsigned mask) {
  return static_cast<std::uint8_t>(sides & mask);
}

/// The sides of a piece turned by 180 degrees.
std::uint8_t turned(std::uint8_t sides) {
  const auto move = [&](unsigned from, unsigned to) { return (sides & from) != 0 ? to : 0U; };
  return static_cast<std::uint8_t>(move(kSideU0, kSideU1) | move(kSideU1, kSideU0) |
                                   move(kSideV0, kSideV1) | move(kSideV1, kSideV0));
}

}  // namespace

void LimitWalk::emit(std::span<const Index> faces, LimitSink& sink) {
  images_.set(faces);
  vFaces_.reset(images_);
  vFacePlaces_.resize(images_.vFacePoints().size());
  Index slot = 0;
  for (const Index f : faces) {
    emitFace(f, slot, sink);
    slot += images_.base().mesh.faceSize(f);
  }
  emitVFaces(sink);
}

void LimitWalk::emitFace(Index face, Index firstSlot, LimitSink& sink) {
  const Index size = images_.base().mesh.faceSize(face);
  const Index firstNumber = images_.base().mesh.faceOffsets[face];
  const auto points = images_.imagesOfFace(firstSlot, size);
  facePoints_.resize(size);
  bool known = false;
  const auto subdivideFace = [&] {
    if (!known) faceImages_.of(points, facePoints_);
    known = true;
  };
  if (size != 4) subdivideFace();
  joined_ = false;
  for (Index i = 0; i < size; ++i) {
    const Corner at{{firstSlot, i, size}, firstNumber + i};
    const Patch patch = patchAt(at);
    const Index vFaceSize = images_.vFace(at.slot()).size;
    bool fine = size == 4 || errorAsQuad(patch, true, facePoints_[i], size) <= tolerance_;
    if (fine && images_.hasVFace(at.slot()) && vFaceSize != 4) {
      fine =
          vFaceSize > 1 &&
          errorAsQuad(patch, false,
                      vFaces_.points(
                          images_, images_.vFaceNumber(at.slot()))[images_.placeInVFace(at.slot())],
                      vFaceSize) <= tolerance_;
    }
    if (fine) {
      emitPiece(patch, boundarySidesAt(at), at.square(), sink);
      continue;
    }
    subdivideFace();
    split(at, sink);
  }
  if (joined_) emitAround(around_, sink);
}

/// The patch of a level-1 vertex. Faces around it that are not quads are treated as quads.
Patch LimitWalk::patchAt(const Corner& at) const {
  const LocalImages::VFace& vFace = images_.vFace(at.slot());
  const LocalImages::EdgeFace& right = images_.edgeFace(at.slot());
  const LocalImages::EdgeFace& left = images_.edgeFace(at.previous());
  const Vec3d& centre = images_.image(at.slot());
  const Vec3d& next = images_.image(at.next());
  const Vec3d& previous = images_.image(at.previous());
  const Vec3d opposite = at.size == 4
                             ? images_.image(at.opposite())
                             : fourthCorner(centroidOf(images_.imagesOfFace(at.first, at.size)),
                                            centre, next, previous);
  const auto vFacePoints = std::span(images_.vFacePoints()).subspan(vFace.begin, vFace.size);
  Vec3d beyond = centre;
  if (images_.hasVFace(at.slot()) && vFace.size == 4)
    beyond = vFacePoints[images_.placeInVFace(at.slot()) ^ 2U];
  else if (images_.hasVFace(at.slot()) && vFace.size > 1)
    beyond = fourthCorner(centroidOf(vFacePoints), centre, left.near, right.near);
  const unsigned quadrants = 8U | (right.exists ? 4U : 0U) | (left.exists ? 2U : 0U) |
                             (images_.hasVFace(at.slot()) ? 1U : 0U);
  return {{{{beyond, left.far, left.near},
            {right.near, centre, previous},
            {right.far, next, opposite}}},
          static_cast<std::uint8_t>(quadrants)};
}

/// An extended surface ends in the middle of the faces beyond its boundary edges. Another one ends
/// where the neighbours of a vertex lack faces.
std::uint8_t LimitWalk::boundarySidesAt(const Corner& at) const {
  unsigned sides = 0;
  if (images_.extends()) {
    if (!images_.edgeFace(at.slot()).interior) sides |= kSideV0;
    if (!images_.edgeFace(at.previous()).interior) sides |= kSideU0;
  } else {
    if (!images_.vFace(at.next()).closed) sides |= kSideU1;
    if (!images_.vFace(at.previous()).closed) sides |= kSideV1;
  }
  return static_cast<std::uint8_t>(sides);
}

/// One step at a level-1 vertex. Emits the children that are regular; the others become active
/// corners of the face or the V-face in which they lie.
void LimitWalk::split(const Corner& at, LimitSink& sink) {
  const LocalImages::VFace& vFace = images_.vFace(at.slot());
  VertexSplit split = images_.splitAt(at, facePoints_);
  vFaces_.setImages(images_, at, split);

  const std::uint8_t sides = boundarySidesAt(at);
  if (split.hasR)
    emitPiece(split.childInR(), only(sides, kSidesInR), at.square().quarter(true, false), sink);
  if (split.hasL)
    emitPiece(split.childInL(), only(sides, kSidesInL), at.square().quarter(false, true), sink);
  if (at.size == 4)
    emitPiece(split.childInF(), only(sides, kSidesInF), at.square().quarter(true, true), sink);
  else
    joinFace(at, split);
  if (!split.hasVFace) return;
  const CornerSquare inVFace = at.square().quarter(false, false);
  if (vFace.size == 4) {
    emitPiece(split.childInVFace(), only(sides, kSidesInVFace), inVFace, sink);
  } else if (vFace.size > 1) {
    joinVFace(at, split);
  } else {
    const TriangleImages t(images_.image(at.slot()), vFace.mStart, vFace.mEnd);
    emitBoundaryCorner(t.below(split), inVFace, sink);
  }
}

/// Makes the corner an active corner of its face at level 2.
void LimitWalk::joinFace(const Corner& at, const VertexSplit& split) {
  if (!joined_) {
    around_.reset(at.size);
    around_.inner = facePoints_;
    places_.resize(at.size);
    joined_ = true;
  }
  const std::size_t i = at.place;
  const std::size_t j = at.previous() - at.first;
  around_.join(i, split);
  around_.hasEdge[i] = split.hasR;
  around_.hasEdge[j] = split.hasL;
  around_.hasCorner[i] = split.hasR && split.hasL && split.hasVFace;
  places_[i] = {at.square().quarter(true, true), only(boundarySidesAt(at), kSidesInF)};
}

/// Makes the corner an active corner of its V-face at level 2, in which parameters run the other
/// way.
void LimitWalk::joinVFace(const Corner& at, const VertexSplit& split) {
  vFaces_.join(images_, at, split);
  const LocalImages::VFace& vFace = images_.vFace(at.slot());
  vFacePlaces_[vFace.begin + images_.placeInVFace(at.slot())] = {
      at.square().quarter(false, false).turned(), turned(only(boundarySidesAt(at), kSidesInVFace))};
}

void LimitWalk::emitVFaces(LimitSink& sink) {
  for (const LocalImages::VFace& vFace : images_.vFaces()) {
    if (!vFaces_.get(vFace, vFace_)) continue;
    const auto places = std::span(vFacePlaces_).subspan(vFace.begin, vFace.size);
    places_.assign(places.begin(), places.end());
    emitAround(vFace_, sink);
  }
}

/// Emits the surface at the active corners of an extraordinary face of level 2 or more. `places_`
/// tells where these corners are.
void LimitWalk::emitAround(ExtraordinaryFace& face, LimitSink& sink) {
  const std::size_t n = face.inner.size();
  next_ = face;
  innerImages_.resize(n);
  for (int level = 2;; ++level) {
    requireLevelInRange(level);
    faceImages_.of(face.inner, innerImages_);
    const Vec3d centroid = centroidOf(face.inner);
    const auto asQuad = [&](std::size_t i) -> Patch {
      const std::size_t j = face.before(i), k = face.after(i);
      const unsigned quadrants = 8U | (face.hasEdge[i] ? 4U : 0U) | (face.hasEdge[j] ? 2U : 0U) |
                                 (face.hasCorner[i] ? 1U : 0U);
      return {{{{face.corner[i], face.far[j], face.near[j]},
                {face.near[i], face.inner[i], face.inner[j]},
                {face.far[i], face.inner[k],
                 fourthCorner(centroid, face.inner[i], face.inner[k], face.inner[j])}}},
              static_cast<std::uint8_t>(quadrants)};
    };
    bool done = true;
    std::fill(next_.active.begin(), next_.active.end(), false);
    for (std::size_t i = 0; i < n; ++i) {
      if (!face.active[i]) continue;
      auto& [square, sides] = places_[i];
      const Patch patch = asQuad(i);
      if (!(errorAsQuad(patch, true, innerImages_[i], n) > tolerance_)) {
        emitPiece(patch, sides, square, sink);
        continue;
      }
      done = false;
      const VertexSplit split = face.splitAt(innerImages_, i);
      if (split.hasR)
        emitPiece(split.childInR(), only(sides, kSidesInR), square.quarter(true, false), sink);
      if (split.hasL)
        emitPiece(split.childInL(), only(sides, kSidesInL), square.quarter(false, true), sink);
      if (split.hasVFace) emitPiece(split.childInVFace(), 0, square.quarter(false, false), sink);
      square = square.quarter(true, true);
      next_.join(i, split);
    }
    if (done) return;
    next_.inner = innerImages_;
    std::swap(face, next_);
  }
}

/// Emits the surface at a vertex in the triangle that a boundary vertex with one face makes. The
/// rest is closed by a piece that treats the triangle as a quad with the vertex at two corners.
void LimitWalk::emitBoundaryCorner(BoundaryCorner at, CornerSquare square, LimitSink& sink) {
  constexpr double kSmall = 0.005;  // voxels, also along the surface: there it ends
  for (int level = 2;; ++level) {
    requireLevelInRange(level);
    const Vec3d difference = (at.u - middle(at.mStart, at.mEnd)) / 4.0;
    if (difference.norm() < kSmall) break;
    const VertexSplit split = at.split();
    emitPiece(split.childInR(), kSideV0, square.quarter(true, false), sink);
    emitPiece(split.childInL(), kSideU0, square.quarter(false, true), sink);
    emitPiece(split.childInF(), 0, square.quarter(true, true), sink);
    at = at.below(split);
    square = square.quarter(false, false);
  }
  sink.piece({{{{at.u, mirrored(at.u, at.mEnd), mirrored(at.left, at.mLeft)},
                {mirrored(at.u, at.mStart), at.u, at.left},
                {mirrored(at.right, at.mRight), at.right, at.opposite}}},
              kSideU0 | kSideV0,
              square});
}

}  // namespace vox
