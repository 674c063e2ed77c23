// Normals of the limit surface at the limit points of vertices.

#include "libvox/subdivide/limit_normals.h"

#include "libvox/core/parallel.h"
#include "libvox/core/unit_root.h"
#include "libvox/mesh/area_vector.h"
#include "libvox/mesh/patch.h"
#include "libvox/subdivide/image_vertices.h"
#include "libvox/subdivide/strip.h"

#include <algorithm>

namespace vox {
namespace {

class NormalFinder {
 public:
  explicit NormalFinder(const SubdivisionLevel& level)
      : level_(level), images_(imageVertices(level)) {
    if (level.boundary == BoundaryStage::kExtend) boundary_ = boundaryCorners(level.adjacency);
  }

  /// @param c  a corner at the vertex
  Vec3d at(Index c) const {
    const OneRing ring = oneRing(level_.mesh, level_.adjacency, c);
    Vec3d normal = Vec3d::Zero();
    if (ring.closed)
      normal = normalOfFace(ring);
    else if (level_.boundary == BoundaryStage::kExtend)
      normal = normalOfHalfFace(ring);
    else if (level_.boundary == BoundaryStage::kStrips)
      normal = normalOfStrip(ring);
    if (!normal.isZero(0)) return normal;
    for (const Index q : ring.corners) normal += areaOfFace(level_.adjacency.cornerFace[q]);
    return normal.squaredNorm() > 0 ? Vec3d(normal.stableNormalized()) : Vec3d(Vec3d::UnitZ());
  }

 private:
  /// Of the V-face: its first harmonic. The mean does not matter, but is taken off: far from the
  /// origin it would cost digits.
  Vec3d normalOfFace(const OneRing& ring) const {
    const auto n = static_cast<Index>(ring.corners.size());
    const auto image = [&](Index i) -> const Vec3d& { return images_[ring.corners[i]]; };
    if (n == 4) return normalOfTangents(image(0) - image(2), image(1) - image(3));
    Vec3d cosines = Vec3d::Zero();
    Vec3d sines = Vec3d::Zero();
    for (Index i = 0; i < n; ++i) {
      const UnitRoot root = unitRoot(i, n);
      cosines += root.cosine * (image(i) - image(0));
      sines += root.sine * (image(i) - image(0));
    }
    return normalOfTangents(cosines, sines);
  }

  /// Of the half V-face [u1 .. um, Mm, M1] at a boundary vertex of level 0.
  Vec3d normalOfHalfFace(const OneRing& ring) const {
    const Vec3d& start = chaikin(ring.corners.front(), 0);
    const Vec3d& end =
        chaikin(previousCorner(level_.mesh, level_.adjacency, ring.corners.back()), 1);
    const Vec3d middle = (start + end) / 2;
    const auto m = static_cast<Index>(ring.corners.size());
    Vec3d inward = Vec3d::Zero();
    for (Index i = 0; i < m; ++i)
      inward += unitRoot(2 * i + 1, 4 * m).sine * (images_[ring.corners[i]] - middle);
    return normalOfTangents(start - end, inward);
  }

  /// Of the E-face, a half quad, at a boundary vertex between two strip faces.
  Vec3d normalOfStrip(const OneRing& ring) const {
    const Index leaving = ring.corners.front();
    const Index entering = ring.corners.back();
    const Index before = previousCorner(level_.mesh, level_.adjacency, leaving);
    const Index after = nextCorner(level_.mesh, level_.adjacency, entering);
    const Vec3d& start = images_[leaving];
    const Vec3d& end = images_[entering];
    return normalOfTangents(start - end, (images_[before] - start) + (images_[after] - end));
  }

  /// The first or second Chaikin point of the boundary edge of a corner.
  const Vec3d& chaikin(Index corner, std::size_t which) const {
    const auto place = std::lower_bound(boundary_.begin(), boundary_.end(), corner);
    const auto edge = static_cast<std::size_t>(place - boundary_.begin());
    return images_[level_.mesh.cornerCount() + 2 * edge + which];
  }

  Vec3d areaOfFace(Index f) const {
    const auto face = level_.mesh.face(f);
    return twiceAreaVector(face.size(), [&](std::size_t i) { return level_.mesh.points[face[i]]; });
  }

  const SubdivisionLevel& level_;
  std::vector<Vec3d> images_;
  std::vector<Index> boundary_;
};

}  // namespace

std::vector<Vec3d> limitNormals(const SubdivisionLevel& level) {
  const PolygonMesh& mesh = level.mesh;
  std::vector<Index> cornerOf(mesh.pointCount(), kNone);
  for (Index c = mesh.cornerCount(); c-- > 0;) cornerOf[mesh.faceVertices[c]] = c;
  const NormalFinder finder(level);
  std::vector<Vec3d> normals(mesh.pointCount(), Vec3d::UnitZ());
  parallelForEach(mesh.pointCount(), kElementsPerTask, [&](Index v) {
    if (cornerOf[v] != kNone) normals[v] = finder.at(cornerOf[v]);
  });
  return normals;
}

}  // namespace vox
