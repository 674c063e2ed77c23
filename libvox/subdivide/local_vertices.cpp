// The level-1 vertices of a submesh and their surroundings.

#include "libvox/subdivide/local_vertices.h"

#include "libvox/mesh/chaikin.h"

namespace vox {

void LocalVertices::set(std::span<const Index> faces) {
  images_.set(faces);
  openFace_ = shapedFace_ = kNone;
  second_.resize(images_.ownSlots());
  Index slot = 0;
  for (const Index f : faces) {
    const Index size = images_.base().mesh.faceSize(f);
    faceImages_.of(images_.imagesOfFace(slot, size), std::span(second_).subspan(slot, size));
    slot += size;
  }
  prepareVFaces();
}

/// Computes level 2 in the V-faces; for those that are not quads also the points around them, as
/// far as the submesh has them.
void LocalVertices::prepareVFaces() {
  const auto& vFaces = images_.vFaces();
  vFaceSecond_.resize(images_.vFacePoints().size());
  vFaceShapes_.resize(vFaces.size());
  vFaceShaped_.assign(vFaces.size(), false);
  if (vFaceLevels_.size() < vFaces.size()) vFaceLevels_.resize(vFaces.size());
  std::vector<ExtraordinaryFace> faces(vFaces.size());
  for (std::size_t s = 0; s < vFaces.size(); ++s) {
    const LocalImages::VFace& vFace = vFaces[s];
    const auto points = std::span(vFaceSecond_).subspan(vFace.begin, vFace.size);
    if (sizeOfVFace(vFace) != vFace.size || vFace.size < 3) continue;
    faceImages_.of(std::span(images_.vFacePoints()).subspan(vFace.begin, vFace.size), points);
    if (vFace.size == 4) continue;
    faces[s].reset(vFace.size);
    faces[s].inner.assign(points.begin(), points.end());
    faces[s].real = vFace.fan;
  }
  surroundVFaces(faces);
  for (std::size_t s = 0; s < vFaces.size(); ++s)
    if (!faces[s].inner.empty()) vFaceLevels_[s].start(std::move(faces[s]));
}

/// Sets the points of level 2 around the V-faces that are not quads, from the faces of the submesh.
void LocalVertices::surroundVFaces(std::vector<ExtraordinaryFace>& faces) const {
  Index slot = 0;
  for (const Index f : images_.faces()) {
    const Index size = images_.base().mesh.faceSize(f);
    for (Corner c{slot, 0, size, images_.base().mesh.faceOffsets[f]}; c.slot() < slot + size;
         ++c.place, ++c.number) {
      ExtraordinaryFace& face = faces[images_.vFaceNumber(c.slot())];
      if (face.inner.empty()) continue;
      const Index i = images_.placeInVFace(c.slot());
      const std::size_t j = face.before(i);
      const auto& right = images_.edgeFace(c.slot());
      const auto& left = images_.edgeFace(c.previous().slot());
      const Vec3d& at = images_.image(c.slot());
      const auto r = quadImages(at, images_.image(c.next().slot()), right.far, right.near);
      const auto l = quadImages(at, images_.image(c.previous().slot()), left.near, left.far);
      face.near[i] = l[0];
      face.far[i] = l[3];
      face.near[j] = r[3];
      face.far[j] = r[0];
      face.corner[i] = second_[c.slot()];
    }
    slot += size;
  }
}

/// Sets the part of a vertex that depends on its V-face.
void LocalVertices::splitVFace(const LocalImages::VFace& vFace, Index number, Index place,
                               LevelOneVertex& vertex) {
  VertexSplit& split = vertex.split;
  split.hasVFace = vFace.closed || images_.extends();
  if (!split.hasVFace) return;
  if (vFace.size == 1) {
    const TriangleImages t(vertex.at, vFace.mStart, vFace.mEnd);
    t.setVFace(split);
    vertex.corner = t.below(split);
    return;
  }
  split.vFace0 = vFaceSecond_[vFace.begin + place];
  split.vFaceRight = vFaceSecond_[vFace.before(place)];
  split.vFaceLeft = vFaceSecond_[vFace.after(place)];
  vertex.quadVFace = vFace.size == 4;
  if (vertex.quadVFace) {
    split.vFaceOpposite = vFaceSecond_[vFace.begin + (place ^ 2U)];
  } else {
    vertex.levelsOfVFace = &vFaceLevels_[number];
    vertex.placeInVFace = place;
  }
}

/// Sets faceLevels_ to the levels of the face of a corner. Precondition: the face is not a quad.
void LocalVertices::openFace(const Corner& at) {
  if (openFace_ == at.first) return;
  openFace_ = at.first;
  ExtraordinaryFace face;
  face.reset(at.size);
  Corner c{at.first, 0, at.size, at.number - at.place};
  for (Index i = 0; i < at.size; ++i, c = c.next()) {
    const LocalImages::EdgeFace& right = images_.edgeFace(c.slot());
    const LocalImages::VFace& vFace = images_.vFace(c.slot());
    const auto r =
        quadImages(images_.image(c.slot()), images_.image(c.next().slot()), right.far, right.near);
    face.inner[i] = second_[c.slot()];
    face.near[i] = r[0];
    face.far[i] = r[1];
    face.hasEdge[i] = right.exists;
    face.hasCorner[i] =
        right.exists && images_.edgeFace(c.previous().slot()).exists && images_.hasVFace(c.slot());
    if (face.hasCorner[i])
      face.corner[i] = vFace.size == 1
                           ? TriangleImages(images_.image(c.slot()), vFace.mStart, vFace.mEnd).u
                           : vFaceSecond_[vFace.begin + images_.placeInVFace(c.slot())];
  }
  faceLevels_.start(std::move(face));
}

LevelOneVertex LocalVertices::at(const Corner& c) {
  LevelOneVertex vertex;
  vertex.at = images_.image(c.slot());
  const LocalImages::VFace& vFace = images_.vFace(c.slot());
  vertex.regular = c.size == 4 && sizeOfVFace(vFace) == 4;
  if (vertex.regular) {
    vertex.patch = images_.patchAt({c.first, c.place, c.size});
    return vertex;
  }
  vertex.split =
      images_.splitAt({c.first, c.place, c.size}, std::span(second_).subspan(c.first, c.size));
  splitVFace(vFace, images_.vFaceNumber(c.slot()), images_.placeInVFace(c.slot()), vertex);
  vertex.quadF = c.size == 4;
  if (!vertex.quadF) {
    openFace(c);
    vertex.levelsOfF = &faceLevels_;
    vertex.placeInF = c.place;
  }
  return vertex;
}

LevelOneVertex LocalVertices::acrossR(const Corner& c) {
  const LocalImages::VFace& vFace = images_.vFace(c.slot());
  const LocalImages::EdgeFace& edge = images_.edgeFace(c.slot());
  const SubdivisionLevel& base = images_.base();
  const Index other = base.adjacency.cornerFace[base.adjacency.twin[c.number]];
  const Index place = vFace.before(images_.placeInVFace(c.slot())) - vFace.begin;
  LevelOneVertex vertex =
      inVFace(images_.vFaceNumber(c.slot()), place, base.mesh.faceSize(other) == 4);
  const Vec3d& here = images_.image(c.slot());
  const Vec3d& next = images_.image(c.next().slot());
  if (vertex.regular) {
    vertex.patch.points[0][1] = here;
    vertex.patch.points[0][2] = next;
    vertex.patch.points[1][2] = edge.far;
  } else {
    vertex.split.l = quadImages(edge.near, edge.far, next, here);
  }
  return vertex;
}

LevelOneVertex LocalVertices::acrossRFromNext(const Corner& c) {
  const LocalImages::VFace& vFace = images_.vFace(c.next().slot());
  const LocalImages::EdgeFace& edge = images_.edgeFace(c.slot());
  const SubdivisionLevel& base = images_.base();
  const Index other = base.adjacency.cornerFace[base.adjacency.twin[c.number]];
  const Index place = vFace.after(images_.placeInVFace(c.next().slot())) - vFace.begin;
  LevelOneVertex vertex =
      inVFace(images_.vFaceNumber(c.next().slot()), place, base.mesh.faceSize(other) == 4);
  const Vec3d& here = images_.image(c.slot());
  const Vec3d& next = images_.image(c.next().slot());
  vertex.at = edge.far;
  if (vertex.regular) {
    vertex.patch.points[1][0] = next;
    vertex.patch.points[1][1] = edge.far;
    vertex.patch.points[2][0] = here;
    vertex.patch.points[2][1] = edge.near;
  } else {
    vertex.split.r = quadImages(edge.far, edge.near, here, next);
  }
  return vertex;
}

LevelOneVertex LocalVertices::inVFace(Index number, Index place, bool quadF) {
  const LocalImages::VFace& vFace = images_.vFaces()[number];
  LevelOneVertex vertex;
  const auto& points = images_.vFacePoints();
  vertex.at = points[vFace.begin + place];
  vertex.regular = quadF && sizeOfVFace(vFace) == 4;
  if (!vertex.regular) {
    splitVFace(vFace, number, place, vertex);
    return vertex;
  }
  vertex.patch.points[1][1] = vertex.at;
  if (vFace.size != 4) return vertex;  // at a free boundary
  vertex.patch.points[0][0] = points[vFace.begin + (place ^ 2U)];
  vertex.patch.points[0][1] = points[vFace.after(place)];
  vertex.patch.points[1][0] = points[vFace.before(place)];
  return vertex;
}

void LocalVertices::shapeVFace(Index number) {
  if (vFaceShaped_[number]) return;
  vFaceShaped_[number] = true;
  const LocalImages::VFace& vFace = images_.vFaces()[number];
  if (vFace.size > 1) {
    vFaceShapes_[number] =
        shapeOf(std::span(images_.vFacePoints()).subspan(vFace.begin, vFace.size), vFace.fan);
    return;
  }
  const Vec3d& u = images_.vFacePoints()[vFace.begin];
  vFaceShapes_[number] = shapeOf(std::array<Vec3d, 3>{u, vFace.mEnd, vFace.mStart});
}

VertexFaces LocalVertices::facesAt(const Corner& c) {
  if (shapedFace_ != c.first) faceShape_ = shapeOf(images_.imagesOfFace(c.first, c.size));
  shapedFace_ = c.first;
  const LocalImages::EdgeFace& right = images_.edgeFace(c.slot());
  const LocalImages::EdgeFace& left = images_.edgeFace(c.previous().slot());
  VertexFaces faces{images_.image(c.slot()),
                    images_.image(c.next().slot()),
                    images_.image(c.previous().slot()),
                    right.near,
                    left.far,
                    faceShape_,
                    {},
                    {},
                    {}};
  faces.r = {faces.at, faces.next, right.far, right.near};
  faces.l = {faces.at, faces.previous, left.near, left.far};
  faces.hasR = right.exists;
  faces.hasL = left.exists;
  faces.hasVFace = images_.hasVFace(c.slot());
  if (!faces.hasR) faces.right = faces.at;
  if (!faces.hasL) faces.left = faces.at;
  if (faces.hasVFace) {
    shapeVFace(images_.vFaceNumber(c.slot()));
    faces.vFace = vFaceShapes_[images_.vFaceNumber(c.slot())];
  }
  return faces;
}

CurvePoints LocalVertices::curveAcrossR(const Corner& c) const {
  const LocalImages::VFace& start = images_.vFace(c.slot());
  return {start.mEnd, start.mStart, images_.vFace(c.next().slot()).mEnd};
}

CurvePoints LocalVertices::curveAcrossL(const Corner& c) const {
  const LocalImages::VFace& end = images_.vFace(c.slot());
  return {images_.vFace(c.previous().slot()).mStart, end.mEnd, end.mStart};
}

BoundaryCurves LocalVertices::curvesAt(const Corner& c) const {
  BoundaryCurves curves;
  if (!images_.extends()) return curves;
  if (isBoundary(c)) curves.acrossR = curveAcrossR(c);
  if (isBoundary(c.previous())) curves.acrossL = curveAcrossL(c);
  return curves;
}

}  // namespace vox
