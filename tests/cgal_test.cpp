// Agreement with CGAL's Doo-Sabin, an independent implementation, on closed meshes.

#include "libvox/subdivide/doo_sabin.h"
#include "tests/shapes.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/subdivision_method_3.h>
#include <catch2/catch.hpp>

using namespace vox;

namespace {

using CgalMesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;

CgalMesh toCgal(const PolygonMesh& mesh) {
  CgalMesh out;
  for (const Vec3d& p : mesh.points) out.add_vertex({p.x(), p.y(), p.z()});
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    std::vector<CgalMesh::Vertex_index> face;
    for (const Index v : mesh.face(f)) face.emplace_back(v);
    REQUIRE(out.add_face(face) != CgalMesh::null_face());
  }
  return out;
}

std::vector<Vec3d> pointsOf(const CgalMesh& mesh) {
  std::vector<Vec3d> points;
  for (const auto v : mesh.vertices())
    points.emplace_back(mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z());
  return points;
}

}  // namespace

TEST_CASE("closed meshes subdivide as in CGAL", "[subdivide][oracle]") {
  for (const auto& shape : test::shapes()) {
    // CGAL makes a V-face of two corners at a point of valence 2, and cannot hold a bow tie.
    if (!shape.closed || shape.name == "point of valence 2" || shape.name == "bow tie") continue;
    for (int levels = 1; levels <= 3; ++levels) {
      CAPTURE(shape.name, levels);
      CgalMesh oracle = toCgal(shape.mesh);
      CGAL::Subdivision_method_3::DooSabin_subdivision(
          oracle, CGAL::parameters::number_of_iterations(static_cast<unsigned>(levels)));
      const auto ours = subdivide(baseLevel(shape.mesh), levels);
      CHECK(ours.mesh.faceCount() == oracle.number_of_faces());
      CHECK(test::samePoints(ours.mesh.points, pointsOf(oracle), 1e-13));
    }
  }
}
