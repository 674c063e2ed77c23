// Level 1 around the faces of a submesh: points, V-faces, E-faces.

#include "libvox/subdivide/local_images.h"

#include "libvox/mesh/chaikin.h"
#include "libvox/subdivide/stop.h"
#include "libvox/subdivide/strip.h"

#include <algorithm>

namespace vox {

LocalImages::LocalImages(const SubdivisionLevel& base)
    : base_(base),
      firstSlot_(base.mesh.faceCount(), kNone),
      vFaceAt_(base.mesh.pointCount(), kNone) {}

void LocalImages::set(std::span<const Index> faces) {
  for (const Index f : known_) firstSlot_[f] = kNone;
  for (const Index f : faces_)
    for (const Index v : base_.mesh.face(f)) vFaceAt_[v] = kNone;
  known_.clear();
  images_.clear();
  vFaces_.clear();
  vFacePoints_.clear();
  faces_.assign(faces.begin(), faces.end());

  for (const Index f : faces) addFace(f);
  ownSlots_ = static_cast<Index>(images_.size());
  edges_.resize(ownSlots_);
  vFaceOf_.resize(ownSlots_);
  placeInVFace_.resize(ownSlots_);
  for (const Index f : faces)
    for (Index c = base_.mesh.faceOffsets[f]; c < base_.mesh.faceOffsets[f + 1]; ++c)
      if (vFaceAt_[base_.mesh.faceVertices[c]] == kNone) addVFace(c);
  Index slot = 0;
  for (const Index f : faces) {
    const Index first = slot;
    const Index begin = base_.mesh.faceOffsets[f];
    const Index size = base_.mesh.faceSize(f);
    for (Index i = 0; i < size; ++i, ++slot)
      addEdge(slot, i + 1 == size ? first : slot + 1, begin + i);
  }
}

void LocalImages::addFace(Index f) {
  const auto face = base_.mesh.face(f);
  corners_.resize(face.size());
  for (std::size_t i = 0; i < face.size(); ++i) corners_[i] = base_.mesh.points[face[i]];
  firstSlot_[f] = static_cast<Index>(images_.size());
  known_.push_back(f);
  images_.resize(images_.size() + face.size());
  faceImages_.of(corners_, std::span(images_).last(face.size()));
}

Index LocalImages::slotOfFace(Index f) {
  if (firstSlot_[f] == kNone) addFace(f);
  return firstSlot_[f];
}

Vec3d LocalImages::imageAt(Index corner) {
  const Index f = base_.adjacency.cornerFace[corner];
  return images_[slotOfFace(f) + corner - base_.mesh.faceOffsets[f]];
}

/// Lists the corners around a vertex in fan_: from the lowest one on, or from the first one of an
/// open fan. So the list does not depend on the corner at which the search begins.
/// @return whether the fan is closed
bool LocalImages::findFan(Index corner) {
  const auto walk = [&](Index start) {
    fan_.clear();
    Index c = start;
    do {
      fan_.push_back(c);
      c = nextAroundVertex(base_.mesh, base_.adjacency, c);
    } while (c != kNone && c != start);
    return c == start;
  };
  if (walk(corner)) {
    std::rotate(fan_.begin(), std::min_element(fan_.begin(), fan_.end()), fan_.end());
    return true;
  }
  for (Index c = corner; c != kNone; c = previousAroundVertex(base_.mesh, base_.adjacency, c))
    corner = c;
  walk(corner);
  return false;
}

void LocalImages::addVFace(Index corner) {
  VFace vFace;
  vFace.closed = findFan(corner);
  vFace.begin = static_cast<Index>(vFacePoints_.size());
  vFace.fan = vFace.size = static_cast<Index>(fan_.size());
  const auto number = static_cast<Index>(vFaces_.size());
  for (Index place = 0; place < vFace.fan; ++place) {
    const Index c = fan_[place];
    vFacePoints_.push_back(imageAt(c));
    const Index f = base_.adjacency.cornerFace[c];
    const Index slot = firstSlot_[f] + c - base_.mesh.faceOffsets[f];
    if (slot >= ownSlots_) continue;
    vFaceOf_[slot] = number;
    placeInVFace_[slot] = place;
  }
  if (vFace.closed)
    vFace.diameter = diameter(std::span(vFacePoints_).last(vFace.size));
  else if (extends())
    closeFan(vFace);
  vFaceAt_[base_.mesh.faceVertices[corner]] = number;
  vFaces_.push_back(vFace);
}

/// Adds the mirrored half of the V-face of an open fan.
void LocalImages::closeFan(VFace& vFace) {
  const PolygonMesh& mesh = base_.mesh;
  const auto pointOf = [&](Index c) -> const Vec3d& { return mesh.points[mesh.faceVertices[c]]; };
  const Vec3d& v = pointOf(fan_.front());
  vFace.mStart = chaikin(v, pointOf(nextCorner(mesh, base_.adjacency, fan_.front())));
  vFace.mEnd = chaikin(v, pointOf(previousCorner(mesh, base_.adjacency, fan_.back())));
  vFacePoints_.push_back(vFace.mStart);
  vFacePoints_.push_back(vFace.mEnd);
  vFace.diameter = diameter(std::span(vFacePoints_).last(vFace.fan + 2));
  vFacePoints_.resize(vFacePoints_.size() - 2);
  if (vFace.fan == 1) return;

  vFace.size = 2 * vFace.fan;
  const Vec3d c = middle(vFace.mStart, vFace.mEnd);
  const Vec3d d = (vFace.mStart - vFace.mEnd) / 2.0;
  const std::vector<StripWeight> weights = stripWeights(vFace.fan);
  // The first and last centre have the same bits as in mirrorEdge.
  const auto centre = [&](Index i) -> Vec3d {
    if (i == 0) return vFace.mStart;
    return i + 1 == vFace.fan ? vFace.mEnd : Vec3d(c + weights[i].ratio * d);
  };
  for (Index i = vFace.fan; i-- > 0;)
    vFacePoints_.push_back(mirrored(vFacePoints_[vFace.begin + i], centre(i)));
}

/// Sets the E-face across the edge of a corner. The faces around the vertices of the submesh are
/// known at this point.
void LocalImages::addEdge(Index slot, Index next, Index corner) {
  const Index t = base_.adjacency.twin[corner];
  EdgeFace& edge = edges_[slot];
  edge = {};
  if (t == kNone) {
    edge.exists = extends();
    if (edge.exists) mirrorEdge(slot, next, corner);
    return;
  }
  edge.interior = true;
  const Index f = base_.adjacency.cornerFace[t];
  const Index shift = firstSlot_[f] - base_.mesh.faceOffsets[f];  // modulo 2^32
  const Index across = t + shift;
  edge.near = images_[nextCorner(base_.mesh, base_.adjacency, t) + shift];
  edge.far = images_[across];
  edge.diameter = across < slot ? edges_[across].diameter
                                : diameter(images_[slot], images_[next], edge.near, edge.far);
}

Patch LocalImages::patchAt(const SlotCorner& at) const {
  const EdgeFace& right = edges_[at.slot()];
  const EdgeFace& left = edges_[at.previous()];
  const Vec3d& centre = images_[at.slot()];
  const bool vFaceExists = hasVFace(at.slot());
  const Vec3d& beyond =
      vFaceExists ? vFacePoints_[vFace(at.slot()).begin + (placeInVFace_[at.slot()] ^ 2U)] : centre;
  const unsigned quadrants =
      (vFaceExists ? 1U : 0U) | (left.exists ? 2U : 0U) | (right.exists ? 4U : 0U) | 8U;
  return {{{{beyond, left.far, left.near},
            {right.near, centre, images_[at.previous()]},
            {right.far, images_[at.next()], images_[at.opposite()]}}},
          static_cast<std::uint8_t>(quadrants)};
}

VertexSplit LocalImages::splitAt(const SlotCorner& at, std::span<const Vec3d> inFace) const {
  const EdgeFace& right = edges_[at.slot()];
  const EdgeFace& left = edges_[at.previous()];
  const Vec3d& centre = images_[at.slot()];
  VertexSplit split;
  split.f0 = inFace[at.place];
  split.fNext = inFace[at.next() - at.first];
  split.fPrevious = inFace[at.previous() - at.first];
  if (at.size == 4) split.fOpposite = inFace[at.opposite() - at.first];
  split.r = quadImages(centre, images_[at.next()], right.far, right.near);
  split.l = quadImages(centre, images_[at.previous()], left.near, left.far);
  split.hasR = right.exists;
  split.hasL = left.exists;
  return split;
}

/// Sets the mirrored half E-face across a boundary edge of an extended surface.
void LocalImages::mirrorEdge(Index slot, Index next, Index corner) {
  const PolygonMesh& mesh = base_.mesh;
  const Vec3d& v = mesh.points[mesh.faceVertices[corner]];
  const Vec3d& w = mesh.points[mesh.faceVertices[nextCorner(mesh, base_.adjacency, corner)]];
  const Vec3d near = chaikin(v, w);
  const Vec3d far = chaikin(w, v);
  EdgeFace& edge = edges_[slot];
  edge.near = mirrored(images_[slot], near);
  edge.far = mirrored(images_[next], far);
  edge.diameter = diameter(images_[slot], images_[next], near, far);
}

}  // namespace vox
