// Level 1 and 2 around one vertex of a mesh. All expressions are those of LocalImages and
// LocalSurface, so that the results have the same bits.

#include "libvox/subdivide/fan_vertices.h"

#include "libvox/mesh/adjacency.h"
#include "libvox/subdivide/stop.h"
#include "libvox/subdivide/thin_patch.h"

#include <algorithm>
#include <span>

namespace vox {
namespace {

constexpr std::size_t kMostCollected = 4096;

/// Regular vertices of more levels are left to LocalSurface, which makes large patches in tiles.
constexpr int kMostPatchLevels = 3;

/// Around an irregular vertex all faces must be smaller for its children to be fine enough.
bool mayBeFine(double diameter) {
  return childrenFineEnough(diameter, contraction(4));
}

}  // namespace

bool FanVertices::emit(Index lowest, Index valence, SurfaceSink* sink) {
  if (valence < 3 || valence > kMostFaces) return false;
  if (gatherFineTriangles(lowest, valence)) {
    if (sink == nullptr) return true;
    fine_[0].insert(fine_[0].end(), vFace_.begin(), vFace_.begin() + valence);
    if (fine_[0].size() >= kMostCollected) flush(*sink);
    return true;
  }
  if (!gather(lowest, valence)) return false;
  for (Index i = 0; i < valence; ++i) vFace_[i] = faces_[i].at();
  const double vFaceDiameter = diameter(std::span(vFace_).first(valence));
  std::array<Way, kMostFaces> ways;
  bool hasChildren = false;
  for (Index i = 0; i < valence; ++i) {
    const std::optional<Way> way = wayOf(i, vFaceDiameter);
    if (!way) return false;
    ways[i] = *way;
    hasChildren |= *way == Way::kLevel2;
  }
  if (sink == nullptr) return true;
  if (hasChildren) setImages(std::span(vFace_).first(valence), std::span(inVFace_));
  for (Index i = 0; i < valence; ++i) {
    if (ways[i] == Way::kLevel1)
      fine_[0].push_back(faces_[i].at());
    else if (ways[i] == Way::kLevel2)
      makeChildren(i);
    else
      emitRegular(PatchPart(around(i)), 1, *sink);
  }
  if (fine_[0].size() + fine_[1].size() >= kMostCollected) flush(*sink);
  return true;
}

void FanVertices::flush(SurfaceSink& sink) {
  for (std::size_t i = 0; i < fine_.size(); ++i) {
    if (!fine_[i].empty()) sink.points(fine_[i], static_cast<int>(i) + 1);
    fine_[i].clear();
  }
}

/// Sets the vertices of level 1. False unless all faces of the fan are triangles and all faces of
/// level 1 are fine enough, by more than rounding: their sizes follow from the triangles. With the
/// vertices v, a, b of a triangle, its image at v is v + ((a - v) + (b - v)) / 6. So the F-face
/// measures half of the triangle, and the E-face of an edge from v to a is a parallelogram of sides
/// (a - v) / 2 and (b - c) / 6, where b and c lie opposite the edge.
bool FanVertices::gatherFineTriangles(Index lowest, Index valence) {
  constexpr double kLimit = kVertexConversionSpan - 1e-6;
  const PolygonMesh& mesh = base_.mesh;
  const Vec3d& v = mesh.points[mesh.faceVertices[lowest]];
  Index c = lowest;
  for (Index i = 0; i < valence; ++i) {
    const Index f = base_.adjacency.cornerFace[c];
    if (mesh.faceSize(f) != 3) return false;
    const std::span<const Index> face = mesh.face(f);
    const Index next = nextCorner(mesh, base_.adjacency, c);
    ring_[i] = mesh.points[mesh.faceVertices[next]];
    if ((ring_[i] - v).cwiseAbs().maxCoeff() > 2 * kLimit) return false;
    vFace_[i] =
        0.5 * v + halfMean(mesh.points[face[0]], mesh.points[face[1]], mesh.points[face[2]]);
    c = nextAroundVertex(mesh, base_.adjacency, c);
  }
  valence_ = valence;
  for (Index i = 0; i < valence; ++i) {
    const Vec3d toNext = ring_[after(i)] - ring_[i];
    const Vec3d across = ring_[after(i)] - ring_[before(i)];
    const Vec3d edgeFace = (ring_[i] - v).cwiseAbs() / 2 + across.cwiseAbs() / 6;
    if (toNext.cwiseAbs().maxCoeff() > 2 * kLimit || edgeFace.maxCoeff() > kLimit) return false;
  }
  return diameter(std::span(vFace_).first(valence)) <= kLimit;
}

/// Sets the faces of the fan. False if one of them is too large.
bool FanVertices::gather(Index lowest, Index valence) {
  valence_ = valence;
  Index c = lowest;
  for (Index i = 0; i < valence; ++i) {
    const Index f = base_.adjacency.cornerFace[c];
    Face& face = faces_[i];
    face.size = base_.mesh.faceSize(f);
    face.place = c - base_.mesh.faceOffsets[f];
    if (face.size > kMostSides) return false;
    setFace(f, face);
    const bool mayBeRegular = face.size == 4 && valence == 4;
    if (!mayBeRegular && !mayBeFine(face.diameter)) return false;
    c = nextAroundVertex(base_.mesh, base_.adjacency, c);
  }
  return true;
}

void FanVertices::setFace(Index f, Face& face) {
  const std::span<const Index> corners = base_.mesh.face(f);
  std::array<Vec3d, kMostSides> points;
  for (std::size_t k = 0; k < corners.size(); ++k) points[k] = base_.mesh.points[corners[k]];
  const auto images = std::span(face.images).first(corners.size());
  setImages(std::span(points).first(corners.size()), images);
  face.diameter = diameter(images);
}

/// How the vertex of corner i is made; none if it needs more levels.
std::optional<FanVertices::Way> FanVertices::wayOf(Index i, double vFaceDiameter) const {
  const Face& face = faces_[i];
  if (face.size == 4 && valence_ == 4) {
    const int depth = patchDepth(around(i));
    if (depth > kMostPatchLevels) return std::nullopt;
    return depth == 0 ? Way::kLevel1 : Way::kPatch;
  }
  const double largest = std::max(std::max(face.diameter, vFaceDiameter),
                                  std::max(edgeFaceDiameter(i), edgeFaceDiameter(after(i))));
  if (largest <= kVertexConversionSpan) return Way::kLevel1;
  const double contractionAround =
      std::max(std::max(contraction(face.size), contraction(4)), contraction(valence_));
  if (childrenFineEnough(largest, contractionAround)) return Way::kLevel2;
  return std::nullopt;
}

/// Diameter of the E-face between corner i and the one before.
double FanVertices::edgeFaceDiameter(Index i) const {
  const Face& face = faces_[i];
  const Face& other = faces_[before(i)];
  return diameter(face.at(), face.next(), other.at(), other.previous());
}

/// The patch around the vertex of corner i, as LocalImages::around.
Patch FanVertices::around(Index i) const {
  const Face& face = faces_[i];
  const Face& right = faces_[before(i)];
  const Face& left = faces_[after(i)];
  const Vec3d& beyond = valence_ == 4 ? faces_[i ^ 2U].at() : face.at();
  const Vec3d& opposite = face.size == 4 ? face.images[face.place ^ 2U] : face.at();
  return {{{{beyond, left.at(), left.next()},
            {right.at(), face.at(), face.previous()},
            {right.previous(), face.next(), opposite}}}};
}

/// Collects the four children of the vertex of corner i.
void FanVertices::makeChildren(Index i) {
  const Face& face = faces_[i];
  const Face& right = faces_[before(i)];
  const Face& left = faces_[after(i)];
  std::vector<Vec3d>& children = fine_[1];
  if (face.size == 3) {
    const auto& images = face.images;
    children.push_back(0.5 * face.at() + halfMean(images[0], images[1], images[2]));
  } else {
    std::array<Vec3d, kMostSides> inFace;
    setImages(std::span(face.images).first(face.size), std::span(inFace));
    children.push_back(inFace[face.place]);
  }
  children.push_back(quadImage(face.at(), face.next(), right.at(), right.previous()));
  children.push_back(quadImage(face.at(), face.previous(), left.at(), left.next()));
  children.push_back(inVFace_[i]);
}

}  // namespace vox
