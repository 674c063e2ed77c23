#include "libvox/subdivide/vertex_array.h"

#include "libvox/prepare/repair.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/local_vertices.h"
#include "tests/repaired_level.h"
#include "tests/shapes.h"
#include "tests/spline_torus.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

using namespace vox;

namespace {

/// The limit normal at vertex (i, j) of n x m descendants.
Vec3d limitNormal(const Patch& patch, std::int64_t i, std::int64_t n, std::int64_t j,
                  std::int64_t m) {
  return LimitNormals(patch, SplinePlace::ofVertex(i, n)).at(SplinePlace::ofVertex(j, m));
}

double degrees(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

/// Calls visit(vertex, corner, vertices) for the level-1 vertex of every corner.
template <class Visit>
void forVertices(const SubdivisionLevel& base, Visit&& visit) {
  std::vector<Index> all(base.mesh.faceCount());
  std::iota(all.begin(), all.end(), Index{0});
  LocalVertices vertices(base);
  vertices.set(all);
  Index slot = 0;
  for (const Index f : all) {
    const Index size = base.mesh.faceSize(f);
    LocalVertices::Corner c{slot, 0, size, base.mesh.faceOffsets[f]};
    for (Index i = 0; i < size; ++i, c = c.next()) visit(vertices.at(c), c, vertices);
    slot += size;
  }
}

VertexArray arrayOf(const LevelOneVertex& vertex, int k) {
  const auto depth = static_cast<std::uint8_t>(k);
  VertexArray array;
  array.set(vertex, {depth, depth}, true);
  return array;
}

/// Cross product of the diagonals of the V-face of vertex (i, j), from the array a level deeper.
Vec3d normalOfVFace(const VertexArray& deeper, std::int64_t i, std::int64_t j) {
  const Vec3d a = deeper.at(2 * i + 1, 2 * j + 1) - deeper.at(2 * i, 2 * j);
  const Vec3d b = deeper.at(2 * i, 2 * j + 1) - deeper.at(2 * i + 1, 2 * j);
  return a.cross(b);
}

std::vector<PolygonMesh> closedShapes() {
  return {test::cube(),   test::tetrahedron(),  test::pyramid(7),
          test::prism(5), test::dodecahedron(), test::torusGrid(6, 5)};
}

/// Centroids and normals of the faces of a mesh, with a search for the nearest ones.
class FaceNormals {
 public:
  explicit FaceNormals(const PolygonMesh& mesh) {
    for (Index f = 0; f < mesh.faceCount(); ++f) {
      const auto face = mesh.face(f);
      if (face.size() != 4) continue;
      const auto p = [&](std::size_t i) { return mesh.points[face[i]]; };
      faces_.push_back({(p(0) + p(1) + p(2) + p(3)) / 4, (p(2) - p(0)).cross(p(3) - p(1))});
    }
  }
  struct Face {
    Vec3d centroid, normal;
  };
  const Face& nearest(const Vec3d& p) const {
    return *std::min_element(faces_.begin(), faces_.end(), [&](const Face& a, const Face& b) {
      return (a.centroid - p).squaredNorm() < (b.centroid - p).squaredNorm();
    });
  }
  /// The nearest faces, sorted by distance.
  std::vector<Face> nearest(const Vec3d& p, std::size_t count) const {
    std::vector<Face> near(count);
    std::partial_sort_copy(faces_.begin(), faces_.end(), near.begin(), near.end(),
                           [&](const Face& a, const Face& b) {
                             return (a.centroid - p).squaredNorm() < (b.centroid - p).squaredNorm();
                           });
    return near;
  }

 private:
  std::vector<Face> faces_;
};

}  // namespace

TEST_CASE("normals of patches are those of the B-spline", "[subdivide][normals][golden]") {
  const int major = 9;
  const int minor = 6;
  const test::SplineTorus torus(major, minor);
  const auto controls = test::torusGrid(major, minor).points;
  for (int i = 0; i < major; ++i)
    for (int j = 0; j < minor; ++j) {
      Patch patch;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          patch.points[std::size_t(a)][std::size_t(b)] =
              controls[std::size_t((i + a) % major * minor + (j + b) % minor)];
      for (const std::int64_t n : {1, 4})
        for (std::int64_t x = 0; x < n; ++x) {
          const Vec3d normal = limitNormal(patch, x, n, 1, 2);
          const Vec3d expected = torus.normalAt(i + (double(x) + 0.5) / double(n), j + 0.75);
          CHECK((normal - expected).norm() < 1e-13);
        }
    }
}

TEST_CASE("the normal of any vertex is that of its V-face", "[subdivide][normals][property]") {
  for (const PolygonMesh& mesh : closedShapes())
    forVertices(test::repairedLevel(mesh), [&](const LevelOneVertex& vertex, const auto&, auto&) {
      for (const int k : {0, 1, 3}) {
        const VertexArray array = arrayOf(vertex, k);
        const VertexArray deeper = arrayOf(vertex, k + 1);
        for (std::int64_t i = 0; i < array.sizeU(); ++i)
          for (std::int64_t j = 0; j < array.sizeV(); ++j) {
            const Vec3d normal = array.normalAt(i, j);
            CHECK(normal.norm() == Approx(1));
            CHECK(degrees(normal, normalOfVFace(deeper, i, j)) < 1e-9);
          }
      }
    });
}

TEST_CASE("normals agree with those of faces six levels deeper", "[subdivide][normals][property]") {
  for (const PolygonMesh& mesh : {test::tetrahedron(), test::cube(), test::prism(5)}) {
    const SubdivisionLevel base = test::repairedLevel(mesh);
    const FaceNormals faces(subdivide(base, 7).mesh);
    forVertices(base, [&](const LevelOneVertex& vertex, const auto&, auto&) {
      const VertexArray array = arrayOf(vertex, 0);
      const VertexArray deeper = arrayOf(vertex, 1);
      const Vec3d limit =
          (deeper.cornerF() + deeper.cornerVFace() + deeper.cornerR() + deeper.cornerL()) / 4;
      const auto around = faces.nearest(limit, 9);
      CHECK((around[0].centroid - limit).norm() < 1e-12);
      CHECK(degrees(array.normalAt(0, 0), around[0].normal) < 1e-8);
      // Normals of neighbours differ by about curvature times distance.
      for (const auto& face : around) CHECK(degrees(array.normalAt(0, 0), face.normal) < 3);
    });
  }
}

TEST_CASE("rows of normals have the bits of single ones", "[subdivide][normals]") {
  for (const PolygonMesh& mesh : closedShapes())
    forVertices(test::repairedLevel(mesh), [&](const LevelOneVertex& vertex, const auto&, auto&) {
      const VertexArray array = arrayOf(vertex, 3);
      std::vector<Vec3d> row(6);
      for (std::int64_t i = 0; i < array.sizeU(); ++i) {
        array.normalsAlongV(i, 1, row);
        for (std::size_t j = 0; j < row.size(); ++j)
          CHECK(row[j] == array.normalAt(i, 1 + static_cast<std::int64_t>(j)));
        array.normalsAlongU(i, 2, row);
        for (std::size_t j = 0; j < row.size(); ++j)
          CHECK(row[j] == array.normalAt(2 + static_cast<std::int64_t>(j), i));
      }
    });
}

TEST_CASE("normals never change points", "[subdivide][normals]") {
  for (const auto* shapes : {&test::shapes(), &test::openShapes()})
    for (const auto& shape : *shapes) {
      CAPTURE(shape.name);
      forVertices(test::repairedLevel(shape.mesh),
                  [&](const LevelOneVertex& vertex, const auto&, auto&) {
                    for (const std::uint8_t k : {std::uint8_t{0}, std::uint8_t{2}}) {
                      VertexArray plain;
                      plain.set(vertex, {k, k});
                      const VertexArray array = arrayOf(vertex, k);
                      for (std::int64_t i = 0; i < array.sizeU(); ++i)
                        for (std::int64_t j = 0; j < array.sizeV(); ++j)
                          CHECK(array.at(i, j) == plain.at(i, j));
                    }
                  });
    }
}

TEST_CASE("normals on a boundary are the limit of normals in the rows beside it",
          "[subdivide][normals]") {
  constexpr int kDeeper = 7;
  std::size_t tried = 0;
  for (const PolygonMesh& mesh :
       {test::sheet(3, 2), test::openFan(1, 5), test::openFan(3, 4), test::tube(5, 2)})
    forVertices(test::repairedLevel(mesh), [&](const LevelOneVertex& vertex, const auto& c,
                                               auto& vertices) {
      const VertexArray array = arrayOf(vertex, 1);
      const VertexArray deeper = arrayOf(vertex, 1 + kDeeper);
      std::array<Vec3d, 2> normals;
      for (const bool acrossR : {true, false}) {
        if (!vertices.isBoundary(acrossR ? c : c.previous())) continue;
        if (acrossR)
          array.normalsAcrossR(0, normals);
        else
          array.normalsAcrossL(0, normals);
        for (std::int64_t i = 0; i < 2; ++i) {
          const std::int64_t far = (2 * i + 1) << (kDeeper - 1);  // and one before it
          const Vec3d near = acrossR ? deeper.normalAt(far, 0) + deeper.normalAt(far - 1, 0)
                                     : deeper.normalAt(0, far) + deeper.normalAt(0, far - 1);
          if (i == 0 && !vertex.regular && (!vertex.quadVFace || vertex.corner)) {
            // Beside a block of one point, the normal is that of the point.
            CHECK((normals[0] - array.normalAt(0, 0)).norm() < 1e-9);
            continue;
          }
          CHECK(normals[static_cast<std::size_t>(i)].norm() == Approx(1));
          CHECK(degrees(normals[static_cast<std::size_t>(i)], near) < 2);
          ++tried;
        }
      }
    });
  CHECK(tried > 100);
}

TEST_CASE("a flat sheet has one normal, missing faces or not", "[subdivide][normals][golden]") {
  const Vec3d x(3, 0, 1);
  const Vec3d y(0, 2, -1);
  const Vec3d normal = x.cross(y).normalized();
  for (PolygonMesh mesh : {test::sheet(3, 3), test::openFan(5, 5), test::regularPolygon(5),
                           test::openFan(4, 3), test::openFan(2, 4)}) {
    for (Vec3d& p : mesh.points) p = Vec3d(7, 8, 9) + p.x() * x + p.y() * y;
    for (const BoundaryRule rule : {BoundaryRule::kExtend, BoundaryRule::kFree})
      forVertices(test::repairedLevel(mesh, rule),
                  [&](const LevelOneVertex& vertex, const auto&, auto&) {
                    for (const int k : {0, 1, 2}) {
                      const VertexArray array = arrayOf(vertex, k);
                      // Some faces are missing: only the corner next to F is checked.
                      const Vec3d corner = array.normalAt(array.sizeU() - 1, array.sizeV() - 1);
                      CHECK((corner - normal).norm() < 1e-12);
                      if (!vertex.whole()) continue;
                      for (std::int64_t i = 0; i < array.sizeU(); ++i)
                        for (std::int64_t j = 0; j < array.sizeV(); ++j)
                          CHECK((array.normalAt(i, j) - normal).norm() < 1e-12);
                    }
                  });
  }
}

TEST_CASE("at a free boundary, normals are close to those of the faces", "[subdivide][normals]") {
  PolygonMesh mesh = test::sheet(4, 3);
  const SubdivisionLevel base = test::repairedLevel(mesh, BoundaryRule::kFree);
  const FaceNormals faces(subdivide(base, 7).mesh);
  forVertices(base, [&](const LevelOneVertex& vertex, const auto&, auto&) {
    const VertexArray array = arrayOf(vertex, 4);
    const Vec3d normal = array.normalAt(15, 15);
    CHECK(degrees(normal, faces.nearest(array.cornerF()).normal) < 3);
  });
}

TEST_CASE("a vertex without a tangent plane has no normal", "[subdivide][normals]") {
  Patch patch;
  for (auto& row : patch.points) row.fill(Vec3d(0.1, 0.7, 1e6 / 3));
  CHECK(limitNormal(patch, 0, 1, 0, 1).isZero(0));
  for (std::size_t u = 0; u < 3; ++u)
    for (std::size_t v = 0; v < 3; ++v)
      patch.points[u][v] = double(u + v) * Vec3d(0.1, 0.2, 0.3) + Vec3d(1, 2, 5);
  CHECK(limitNormal(patch, 1, 4, 2, 4).isZero(0));
}
