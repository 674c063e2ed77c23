// What lies around the level-1 vertices of a submesh.

#include "libvox/subdivide/local_vertices.h"

#include "libvox/mesh/chaikin.h"

namespace vox {

void LocalVertices::set(std::span<const Index> faces) {
  keepsRings_ = false;
  load(faces);
}

void LocalVertices::setWithNeighbours(std::span<const Index> faces) {
  const SubdivisionLevel& base = images_.base();
  isLoaded_.resize(base.mesh.faceCount());
  isVisited_.resize(base.mesh.pointCount());
  std::swap(loaded_, loadedBefore_);  // images_ looks at the list before until it has another
  loaded_.clear();
  for (const Index f : faces) addNeighbour(f);
  for (const Index f : faces)
    for (Index c = base.mesh.faceOffsets[f]; c < base.mesh.faceOffsets[f + 1]; ++c)
      if (const Index twin = base.adjacency.twin[c]; twin != kNone)
        addNeighbour(base.adjacency.cornerFace[twin]);
  addFansFrom(faces);
  for (const Index f : loaded_) isLoaded_[f] = false;

  keepsRings_ = true;
  load(loaded_);
  ringsAt_.assign(images_.ownSlots(), kNone);
  opened_ = 0;
}

void LocalVertices::addNeighbour(Index face) {
  if (isLoaded_[face]) return;
  isLoaded_[face] = true;
  loaded_.push_back(face);
}

/// All faces of the fans that begin, as in LocalImages, in one of these.
void LocalVertices::addFansFrom(std::span<const Index> faces) {
  constexpr std::uint8_t kOwn = 2;
  const SubdivisionLevel& base = images_.base();
  for (const Index f : faces) isLoaded_[f] = kOwn;
  const auto forCorners = [&](auto&& visit) {
    for (const Index f : faces)
      for (Index c = base.mesh.faceOffsets[f]; c < base.mesh.faceOffsets[f + 1]; ++c) visit(c);
  };
  forCorners([&](Index c) {
    std::uint8_t& visited = isVisited_[base.mesh.faceVertices[c]];
    if (visited) return;
    visited = true;
    const OneRing ring = oneRing(base.mesh, base.adjacency, c);
    const Index first = ring.closed ? *std::min_element(ring.corners.begin(), ring.corners.end())
                                    : ring.corners.front();
    if (isLoaded_[base.adjacency.cornerFace[first]] != kOwn) return;
    for (const Index corner : ring.corners) addNeighbour(base.adjacency.cornerFace[corner]);
  });
  forCorners([&](Index c) { isVisited_[base.mesh.faceVertices[c]] = false; });
}

void LocalVertices::load(std::span<const Index> faces) {
  images_.set(faces);
  openFace_ = shapedFace_ = kNone;
  second_.resize(images_.ownSlots());
  Index slot = 0;
  for (const Index f : faces) {
    const Index size = images_.base().mesh.faceSize(f);
    faceImages_.of(images_.imagesOfFace(slot, size), std::span(second_).subspan(slot, size));
    slot += size;
  }
  prepareStars();
}

/// Level 2 of the stars, and where they are no quads, of what the submesh knows around them.
void LocalVertices::prepareStars() {
  const auto& stars = images_.stars();
  starSecond_.resize(images_.starPoints().size());
  starShapes_.resize(stars.size());
  starShaped_.assign(stars.size(), false);
  if (starRings_.size() < stars.size()) starRings_.resize(stars.size());
  std::vector<ExtraordinaryFace> faces(stars.size());
  for (std::size_t s = 0; s < stars.size(); ++s) {
    const LocalImages::Star& star = stars[s];
    const auto points = std::span(starSecond_).subspan(star.begin, star.size);
    if (sizeOfK(star) != star.size || star.size < 3) continue;
    faceImages_.of(std::span(images_.starPoints()).subspan(star.begin, star.size), points);
    if (star.size == 4) continue;
    faces[s].reset(star.size);
    faces[s].inner.assign(points.begin(), points.end());
    faces[s].real = star.fan;
  }
  surroundStars(faces);
  for (std::size_t s = 0; s < stars.size(); ++s)
    if (!faces[s].inner.empty()) starRings_[s].start(std::move(faces[s]));
}

/// What the faces of the submesh put around the stars that are no quads.
void LocalVertices::surroundStars(std::vector<ExtraordinaryFace>& faces) const {
  Index slot = 0;
  for (const Index f : images_.faces()) {
    const Index size = images_.base().mesh.faceSize(f);
    for (Corner c{slot, 0, size, images_.base().mesh.faceOffsets[f]}; c.slot() < slot + size;
         ++c.place, ++c.number) {
      ExtraordinaryFace& face = faces[images_.starNumber(c.slot())];
      if (face.inner.empty()) continue;
      const Index i = images_.placeInStar(c.slot());
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

Patch LocalVertices::patchAt(const Corner& c) const {
  const LocalImages::Star& star = images_.star(c.slot());
  const LocalImages::EdgeFace& right = images_.edgeFace(c.slot());
  const LocalImages::EdgeFace& left = images_.edgeFace(c.previous().slot());
  const bool k = hasK(c.slot());
  const Vec3d& center = images_.image(c.slot());
  const Vec3d& beyond =
      k ? images_.starPoints()[star.begin + (images_.placeInStar(c.slot()) ^ 2U)] : center;
  const unsigned quadrants = (k ? 1U : 0U) | (left.exists ? 2U : 0U) | (right.exists ? 4U : 0U);
  return {{{{beyond, left.far, left.near},
            {right.near, center, images_.image(c.previous().slot())},
            {right.far, images_.image(c.next().slot()), images_.image(c.first + (c.place ^ 2U))}}},
          static_cast<std::uint8_t>(quadrants | 8U)};
}

/// What the star says of a vertex.
void LocalVertices::splitK(const LocalImages::Star& star, Index number, Index place,
                           LevelOneVertex& vertex) {
  VertexSplit& split = vertex.split;
  split.hasK = star.closed || images_.extends();
  if (!split.hasK) return;
  if (star.size == 1) {
    const TriangleImages t(vertex.at, star.mStart, star.mEnd);
    t.setK(split);
    vertex.corner = {split.k0,
                     t.mStart,
                     t.mEnd,
                     split.r[0],
                     middle(split.r[0], split.r[3]),
                     split.l[0],
                     middle(split.l[0], split.l[3]),
                     split.f0};
    return;
  }
  split.k0 = starSecond_[star.begin + place];
  split.kRight = starSecond_[star.before(place)];
  split.kLeft = starSecond_[star.after(place)];
  vertex.quadK = star.size == 4;
  if (vertex.quadK) {
    split.kOpposite = starSecond_[star.begin + (place ^ 2U)];
  } else {
    vertex.ringsOfK = &starRings_[number];
    vertex.placeInK = place;
  }
}

/// The rings of a face that is no quad.
ExtraordinaryRings& LocalVertices::ringsOf(const Corner& at) {
  if (!keepsRings_) {
    if (openFace_ != at.first) openFace(at, faceRings_.front());
    openFace_ = at.first;
    return faceRings_.front();
  }
  Index& number = ringsAt_[at.first];
  if (number != kNone) return faceRings_[number];
  number = static_cast<Index>(opened_++);
  if (faceRings_.size() < opened_) faceRings_.emplace_back();
  openFace(at, faceRings_[number]);
  return faceRings_[number];
}

void LocalVertices::openFace(const Corner& at, ExtraordinaryRings& rings) {
  ExtraordinaryFace face;
  face.reset(at.size);
  Corner c{at.first, 0, at.size, at.number - at.place};
  for (Index i = 0; i < at.size; ++i, c = c.next()) {
    const LocalImages::EdgeFace& right = images_.edgeFace(c.slot());
    const LocalImages::Star& star = images_.star(c.slot());
    const auto r =
        quadImages(images_.image(c.slot()), images_.image(c.next().slot()), right.far, right.near);
    face.inner[i] = second_[c.slot()];
    face.near[i] = r[0];
    face.far[i] = r[1];
    face.hasEdge[i] = right.exists;
    face.hasCorner[i] =
        right.exists && images_.edgeFace(c.previous().slot()).exists && hasK(c.slot());
    if (face.hasCorner[i])
      face.corner[i] = star.size == 1
                           ? TriangleImages(images_.image(c.slot()), star.mStart, star.mEnd).u
                           : starSecond_[star.begin + images_.placeInStar(c.slot())];
  }
  rings.start(std::move(face));
}

LevelOneVertex LocalVertices::at(const Corner& c) {
  LevelOneVertex vertex;
  vertex.at = images_.image(c.slot());
  const LocalImages::Star& star = images_.star(c.slot());
  vertex.regular = c.size == 4 && sizeOfK(star) == 4;
  if (vertex.regular) {
    vertex.patch = patchAt(c);
    return vertex;
  }
  const LocalImages::EdgeFace& right = images_.edgeFace(c.slot());
  const LocalImages::EdgeFace& left = images_.edgeFace(c.previous().slot());
  VertexSplit& split = vertex.split;
  split.f0 = second_[c.slot()];
  split.fNext = second_[c.next().slot()];
  split.fPrevious = second_[c.previous().slot()];
  split.r = quadImages(vertex.at, images_.image(c.next().slot()), right.far, right.near);
  split.l = quadImages(vertex.at, images_.image(c.previous().slot()), left.near, left.far);
  split.hasR = right.exists;
  split.hasL = left.exists;
  splitK(star, images_.starNumber(c.slot()), images_.placeInStar(c.slot()), vertex);
  vertex.quadF = c.size == 4;
  if (vertex.quadF) {
    split.fOpposite = second_[c.first + (c.place ^ 2U)];
  } else {
    vertex.ringsOfF = &ringsOf(c);
    vertex.placeInF = c.place;
  }
  return vertex;
}

LevelOneVertex LocalVertices::acrossR(const Corner& c) {
  const LocalImages::Star& star = images_.star(c.slot());
  const LocalImages::EdgeFace& edge = images_.edgeFace(c.slot());
  const SubdivisionLevel& base = images_.base();
  const Index other = base.adjacency.cornerFace[base.adjacency.twin[c.number]];
  const Index place = star.before(images_.placeInStar(c.slot())) - star.begin;
  LevelOneVertex vertex =
      inStar(images_.starNumber(c.slot()), place, base.mesh.faceSize(other) == 4);
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
  const LocalImages::Star& star = images_.star(c.next().slot());
  const LocalImages::EdgeFace& edge = images_.edgeFace(c.slot());
  const SubdivisionLevel& base = images_.base();
  const Index other = base.adjacency.cornerFace[base.adjacency.twin[c.number]];
  const Index place = star.after(images_.placeInStar(c.next().slot())) - star.begin;
  LevelOneVertex vertex =
      inStar(images_.starNumber(c.next().slot()), place, base.mesh.faceSize(other) == 4);
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

LevelOneVertex LocalVertices::inStar(Index number, Index place, bool quadF) {
  const LocalImages::Star& star = images_.stars()[number];
  LevelOneVertex vertex;
  const auto& points = images_.starPoints();
  vertex.at = points[star.begin + place];
  vertex.regular = quadF && sizeOfK(star) == 4;
  if (!vertex.regular) {
    splitK(star, number, place, vertex);
    return vertex;
  }
  vertex.patch.points[1][1] = vertex.at;
  if (star.size != 4) return vertex;  // at a free boundary
  vertex.patch.points[0][0] = points[star.begin + (place ^ 2U)];
  vertex.patch.points[0][1] = points[star.after(place)];
  vertex.patch.points[1][0] = points[star.before(place)];
  return vertex;
}

void LocalVertices::shapeStar(Index number) {
  if (starShaped_[number]) return;
  starShaped_[number] = true;
  const LocalImages::Star& star = images_.stars()[number];
  if (star.size > 1) {
    starShapes_[number] =
        shapeOf(std::span(images_.starPoints()).subspan(star.begin, star.size), star.fan);
    return;
  }
  const Vec3d& u = images_.starPoints()[star.begin];
  starShapes_[number] = shapeOf(std::array<Vec3d, 3>{u, star.mEnd, star.mStart});
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
  faces.hasK = hasK(c.slot());
  if (!faces.hasR) faces.right = faces.at;
  if (!faces.hasL) faces.left = faces.at;
  if (faces.hasK) {
    shapeStar(images_.starNumber(c.slot()));
    faces.k = starShapes_[images_.starNumber(c.slot())];
  }
  return faces;
}

CurvePoints LocalVertices::curveAcrossR(const Corner& c) const {
  const LocalImages::Star& start = images_.star(c.slot());
  return {start.mEnd, start.mStart, images_.star(c.next().slot()).mEnd};
}

CurvePoints LocalVertices::curveAcrossL(const Corner& c) const {
  const LocalImages::Star& end = images_.star(c.slot());
  return {images_.star(c.previous().slot()).mStart, end.mEnd, end.mStart};
}

BoundaryCurves LocalVertices::curvesAt(const Corner& c) const {
  BoundaryCurves curves;
  if (!images_.extends()) return curves;
  if (isBoundary(c)) curves.acrossR = curveAcrossR(c);
  if (isBoundary(c.previous())) curves.acrossL = curveAcrossL(c);
  return curves;
}

}  // namespace vox
