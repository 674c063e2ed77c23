// The level-1 vertices of a submesh and their surroundings.

#include "libvox/subdivide/local_vertices.h"

#include <algorithm>
#include <array>

namespace vox {

void LocalVertices::set(std::span<const Index> faces) {
  images_.set(faces);
  firstOfFace_ = kNone;
  for (FaceLevels& vFace : vFaces_) vFace.clear();
  vFaces_.resize(std::max(vFaces_.size(), images_.vFaces().size()));
}

/// The levels of the face of a corner.
FaceLevels& LocalVertices::faceOf(const SubmeshCorner& at) {
  if (firstOfFace_ != at.first) face_.start(images_.imagesOfFace(at.first, at.size), at.size);
  firstOfFace_ = at.first;
  return face_;
}

/// The levels of a V-face of more than one corner.
FaceLevels& LocalVertices::levelsOfVFace(Index number) {
  const LocalImages::VFace& vFace = images_.vFaces()[number];
  if (vFaces_[number].empty())
    vFaces_[number].start(std::span(images_.vFacePoints()).subspan(vFace.begin, vFace.size),
                          vFace.fan);
  return vFaces_[number];
}

/// Sets the part of an irregular vertex that depends on its V-face.
void LocalVertices::setVFace(Index number, Index place, LevelOneVertex& vertex) {
  const LocalImages::VFace& vFace = images_.vFaces()[number];
  if (!vFace.closed && !images_.extends()) return;
  if (vFace.size == 1) {
    vertex.triangle = {vFace.mStart, vFace.mEnd};
  } else {
    vertex.vFace = &levelsOfVFace(number);
    vertex.placeInVFace = place;
  }
}

LevelOneVertex LocalVertices::at(const SubmeshCorner& c) {
  LevelOneVertex vertex;
  vertex.around = images_.around(c);
  vertex.regular = images_.isRegular(c);
  if (vertex.regular) return vertex;
  vertex.face = &faceOf(c);
  vertex.place = c.place;
  setVFace(images_.vFaceNumber(c.slot()), images_.placeInVFace(c.slot()), vertex);
  return vertex;
}

LevelOneVertex LocalVertices::acrossR(const SubmeshCorner& c) {
  const LocalImages::VFace& vFace = images_.vFace(c.slot());
  const SubdivisionLevel& base = images_.base();
  const Index other = base.adjacency.cornerFace[base.adjacency.twin[c.number]];
  const Index place = vFace.before(images_.placeInVFace(c.slot())) - vFace.begin;
  LevelOneVertex vertex =
      inVFace(images_.vFaceNumber(c.slot()), place, base.mesh.faceSize(other) == 4);
  auto& points = vertex.around.points;
  points[0][1] = images_.image(c.slot());
  points[0][2] = images_.image(c.nextSlot());
  points[1][2] = images_.edgeFace(c.slot()).far;
  return vertex;
}

LevelOneVertex LocalVertices::acrossRFromNext(const SubmeshCorner& c) {
  const LocalImages::VFace& vFace = images_.vFace(c.nextSlot());
  const SubdivisionLevel& base = images_.base();
  const Index other = base.adjacency.cornerFace[base.adjacency.twin[c.number]];
  const Index place = vFace.after(images_.placeInVFace(c.nextSlot())) - vFace.begin;
  LevelOneVertex vertex =
      inVFace(images_.vFaceNumber(c.nextSlot()), place, base.mesh.faceSize(other) == 4);
  auto& points = vertex.around.points;
  points[1][0] = images_.image(c.nextSlot());
  points[1][1] = images_.edgeFace(c.slot()).far;
  points[2][0] = images_.image(c.slot());
  points[2][1] = images_.edgeFace(c.slot()).near;
  return vertex;
}

LevelOneVertex LocalVertices::inVFace(Index number, Index place, bool quadF) {
  const LocalImages::VFace& vFace = images_.vFaces()[number];
  const auto& inVFace = images_.vFacePoints();
  const bool exists = vFace.closed || images_.extends();
  LevelOneVertex vertex;
  auto& points = vertex.around.points;
  for (auto& row : points) row.fill(Vec3d::Zero());
  points[1][1] = inVFace[vFace.begin + place];
  vertex.regular = quadF && (!exists || vFace.size == 4);
  if (!exists) vertex.around.quadrants ^= 1U;
  if (!vertex.regular) {
    setVFace(number, place, vertex);
  } else if (vFace.size == 4) {
    points[0][0] = inVFace[vFace.begin + (place ^ 2U)];
    points[0][1] = inVFace[vFace.after(place)];
    points[1][0] = inVFace[vFace.before(place)];
  }
  return vertex;
}

VertexFaces LocalVertices::facesAt(const SubmeshCorner& c) {
  VertexFaces faces(images_.around(c));
  if (!faces.hasR) faces.right = faces.at;
  if (!faces.hasL) faces.left = faces.at;
  faces.f = faceOf(c).shape(1);
  if (!faces.hasVFace) return faces;
  const LocalImages::VFace& vFace = images_.vFace(c.slot());
  faces.vFace = vFace.size == 1 ? shapeOf(std::array<Vec3d, 3>{faces.at, vFace.mEnd, vFace.mStart})
                                : levelsOfVFace(images_.vFaceNumber(c.slot())).shape(1);
  return faces;
}

CurvePoints LocalVertices::curveAcrossR(const SubmeshCorner& c) const {
  const LocalImages::VFace& start = images_.vFace(c.slot());
  return {start.mEnd, start.mStart, images_.vFace(c.nextSlot()).mEnd};
}

CurvePoints LocalVertices::curveAcrossL(const SubmeshCorner& c) const {
  const LocalImages::VFace& end = images_.vFace(c.slot());
  return {images_.vFace(c.previousSlot()).mStart, end.mEnd, end.mStart};
}

BoundaryCurves LocalVertices::curvesAt(const SubmeshCorner& c) const {
  BoundaryCurves curves;
  if (!images_.extends()) return curves;
  if (isBoundary(c)) curves.acrossR = curveAcrossR(c);
  if (isBoundary(c.previous())) curves.acrossL = curveAcrossL(c);
  return curves;
}

}  // namespace vox
