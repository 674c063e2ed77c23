#include "libvox/core/color.h"
#include "libvox/core/error.h"
#include "libvox/io/read_mesh.h"
#include "libvox/mesh/validate.h"
#include "libvox/prepare/sound.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <string>
#include <vector>

using namespace vox;
using Catch::Contains;

namespace {

const std::string kObjFace = "f 1 2 3\n";

Vec3f light(double r, double g, double b) {
  return Vec3d(linearFromScreen(r), linearFromScreen(g), linearFromScreen(b)).cast<float>();
}

bool near(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  bool all = a.size() == b.size();
  for (std::size_t k = 0; all && k < a.size(); ++k) all = (a[k] - b[k]).norm() < 1e-5F;
  return all;
}

std::string ply(const std::string& vertexColors, const std::string& faceColors,
                const std::string& body) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\n" +
         vertexColors + "element face 1\nproperty list uchar int vertex_indices\n" + faceColors +
         "end_header\n" + body;
}

}  // namespace

TEST_CASE("OBJ keeps the colours of its vertices as light", "[io][color]") {
  const PolygonMesh mesh =
      parseMesh("a.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 0 0 1 0.5\nv 0 1 0\n" + kObjFace);
  CHECK(near(mesh.pointColors, {light(1, 0.5, 0), light(0, 0, 1), light(1, 1, 1)}));
  CHECK(mesh.faceColors.empty());
  const PolygonMesh bytes =
      parseMesh("a.obj", "v 0 0 0 255 51 0\nv 1 0 0 0 0 1\nv 0 1 0 0 0 0\n" + kObjFace);
  CHECK(near(bytes.pointColors, {light(1, 0.2, 0), light(0, 0, 1 / 255.0), light(0, 0, 0)}));
  const PolygonMesh plain = parseMesh("a.obj", "v 0 0 0 1\nv 1 0 0\nv 0 1 0\n" + kObjFace);
  CHECK(plain.pointColors.empty());
}

TEST_CASE("OFF keeps colours of vertices and faces", "[io][color]") {
  const PolygonMesh mesh = parseMesh(
      "a.off", "COFF\n3 1 0\n0 0 0 255 0 51 255\n1 0 0 0 0 0 255\n0 1 0 51 255 0 255\n3 0 1 2\n");
  CHECK(near(mesh.pointColors, {light(1, 0, 0.2), light(0, 0, 0), light(0.2, 1, 0)}));
  CHECK(mesh.faceColors.empty());
  // A normal comes before the colour, for any order in the keyword.
  const PolygonMesh both =
      parseMesh("a.off",
                "CNOFF\n3 2 0\n0 0 0 0 0 1 1 0 0\n1 0 0 0 0 1 1 0 0\n0 1 0 0 0 1 0 1 0\n"
                "3 0 1 2 0.5 0.25 1\n3 0 2 1 0 1 0 0.5\n");
  CHECK(near(both.pointColors, {light(1, 0, 0), light(1, 0, 0), light(0, 1, 0)}));
  CHECK(near(both.faceColors, {light(0.5, 0.25, 1), light(0, 1, 0)}));
  // A single number is an index into a table and ignored; a face without colour is white.
  const PolygonMesh some =
      parseMesh("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 7\n3 0 2 1 255 0 0\n");
  CHECK(some.pointColors.empty());
  CHECK(near(some.faceColors, {light(1, 1, 1), light(1, 0, 0)}));
  CHECK_THROWS_AS(parseMesh("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1 red 0\n"),
                  InputError);
}

TEST_CASE("PLY keeps colours of vertices and faces, scaled by their type", "[io][color]") {
  const std::string bytes = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::string floats = "property float blue\nproperty double green\nproperty float red\n";
  const PolygonMesh mesh = parseMesh(
      "a.ply", ply(bytes + "property uchar alpha\n", floats,
                   "0 0 0 255 0 51 9\n1 0 0 1 1 1 9\n0 1 0 0 255 0 9\n3 0 1 2 1 0.5 0\n"));
  CHECK(near(mesh.pointColors,
             {light(1, 0, 0.2), light(1 / 255.0, 1 / 255.0, 1 / 255.0), light(0, 1, 0)}));
  CHECK(near(mesh.faceColors, {light(0, 0.5, 1)}));
  const PolygonMesh part =
      parseMesh("a.ply", ply("property uchar red\n", "", "0 0 0 255\n1 0 0 1\n0 1 0 0\n3 0 1 2\n"));
  CHECK(part.pointColors.empty());
  // A header of colours alone is no mesh.
  CHECK_THROWS_WITH(parseMesh("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + bytes +
                                           "element face 0\nproperty list uchar int "
                                           "vertex_indices\nend_header\n1 2 3\n"),
                    Contains("x, y and z"));
}

TEST_CASE("colours follow points and faces through repair and turning", "[prepare][color]") {
  // Each face has vertices of its own and a colour by its number; one face is flipped.
  PolygonMesh mesh = test::unwelded(test::cube());
  test::flipFace(mesh, 3);
  for (Index v = 0; v < mesh.pointCount(); ++v)
    mesh.pointColors.push_back(Vec3d(v / 23.0, 0, 0).cast<float>());
  for (Index f = 0; f < mesh.faceCount(); ++f)
    mesh.faceColors.push_back(Vec3d(0, f / 5.0, 0).cast<float>());
  SoundReport report;
  const PolygonMesh sound = soundMesh(mesh, {}, report);
  REQUIRE(sound.pointColors.size() == 8);
  REQUIRE(sound.faceColors.size() == 6);
  for (Index v = 0; v < 8; ++v) {
    double sum = 0;
    for (Index u = 0; u < mesh.pointCount(); ++u)
      if (mesh.points[u] == sound.points[v]) sum += mesh.pointColors[u].x();
    CHECK(sound.pointColors[v].x() == Approx(sum / 3));
  }
  for (Index f = 0; f < 6; ++f) {
    CAPTURE(f);
    Index from = 0;
    while ((test::faceCentroid(mesh, from) - test::faceCentroid(sound, f)).norm() > 1e-9) ++from;
    CHECK(sound.faceColors[f] == mesh.faceColors[from]);
  }
}

TEST_CASE("copies of a point that is split have its colour", "[prepare][color]") {
  PolygonMesh mesh = test::bowTie();
  for (Index v = 0; v < mesh.pointCount(); ++v)
    mesh.pointColors.push_back(Vec3d(v * 0.1, 0, 0).cast<float>());
  SoundReport report;
  const PolygonMesh sound = soundMesh(mesh, {}, report);
  REQUIRE(sound.pointCount() == mesh.pointCount() + 1);
  REQUIRE(sound.pointColors.size() == sound.points.size());
  for (Index v = 0; v < sound.pointCount(); ++v)
    for (Index u = 0; u < mesh.pointCount(); ++u)
      if (mesh.points[u] == sound.points[v]) CHECK(sound.pointColors[v] == mesh.pointColors[u]);
}

TEST_CASE("colours that do not fit the mesh are refused", "[mesh][color][error]") {
  PolygonMesh mesh = test::cube();
  mesh.pointColors.resize(7, Vec3f::Zero());
  CHECK_THROWS_WITH(requireValidArrays(mesh), Contains("one colour per point and face"));
}
