#include "libvox/io/write_mesh.h"

#include "libvox/core/error.h"
#include "libvox/io/read_mesh.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <ostream>
#include <sstream>
#include <streambuf>

using namespace vox;

namespace {

std::string written(const PolygonMesh& mesh, MeshFormat format) {
  std::ostringstream out;
  writeMesh(out, mesh, format);
  return out.str();
}

// A triangle and a pentagon with positions that have no short decimal form.
PolygonMesh awkwardMesh() {
  PolygonMesh mesh;
  mesh.points = {{0.1, 1e-308, 123456789.123456789},
                 {-0.0, std::numeric_limits<double>::denorm_min(), -1e15},
                 {1.0 / 3, std::nextafter(1.0, 2.0), std::nextafter(1.0, 0.0)},
                 {M_PI, -M_E * 1e-20, 5e-324},
                 {1e15, 2e14 + 0.125, 0}};
  mesh.addFace(std::vector<Index>{0, 1, 2});
  mesh.addFace(std::vector<Index>{4, 3, 2, 1, 0});
  return mesh;
}

// One polygon with n corners on a circle.
PolygonMesh polygonOf(Index n) {
  PolygonMesh mesh;
  std::vector<Index> corners;
  for (Index v = 0; v < n; ++v) {
    mesh.points.emplace_back(std::cos(2 * M_PI * v / n), std::sin(2 * M_PI * v / n), 0);
    corners.push_back(v);
  }
  mesh.addFace(corners);
  return mesh;
}

PolygonMesh readBack(const std::string& contents, const std::string& name) {
  const test::TemporaryFolder folder;
  return readMesh(folder.write(name, contents));
}

void checkSameBits(const PolygonMesh& a, const PolygonMesh& b) {
  CHECK(a.faceOffsets == b.faceOffsets);
  CHECK(a.faceVertices == b.faceVertices);
  REQUIRE(a.points.size() == b.points.size());
  // As bytes: -0 and +0 differ.
  CHECK(std::memcmp(a.points.data(), b.points.data(), a.points.size() * sizeof(Vec3d)) == 0);
}

// Takes `room` bytes, then fails as a full disk does.
class FullDisk : public std::streambuf {
 public:
  explicit FullDisk(std::streamsize room) : room_(room) {}

 protected:
  std::streamsize xsputn(const char*, std::streamsize count) override {
    room_ -= count;
    return room_ < 0 ? 0 : count;
  }
  int_type overflow(int_type) override { return traits_type::eof(); }

 private:
  std::streamsize room_;
};

}  // namespace

TEST_CASE("the extension of an output mesh names its format", "[io]") {
  CHECK(meshFormatFor("a.obj") == MeshFormat::kObj);
  CHECK(meshFormatFor("dir/a.PLY") == MeshFormat::kPly);
  CHECK(meshFormatFor("a.Off") == MeshFormat::kOff);
  CHECK_THROWS_AS(meshFormatFor("a.stl"), UsageError);
  CHECK_THROWS_WITH(meshFormatFor("a.stl"), Catch::Contains("a.stl") && Catch::Contains(".obj"));
}

TEST_CASE("OBJ and OFF are written with 17 digits", "[io][golden]") {
  PolygonMesh mesh;
  mesh.points = {{0, 1, -2.5}, {0.1, 1e100, 1e-5}, {0.5, 0, 0}};
  mesh.addFace(std::vector<Index>{0, 1, 2});
  CHECK(written(mesh, MeshFormat::kObj) ==
        "# libvox\nv 0 1 -2.5\nv 0.10000000000000001 1e+100 1.0000000000000001e-05\nv 0.5 0 0\n"
        "f 1 2 3\n");
  CHECK(written(mesh, MeshFormat::kOff) ==
        "OFF\n# libvox\n3 1 0\n0 1 -2.5\n0.10000000000000001 1e+100 1.0000000000000001e-05\n"
        "0.5 0 0\n3 0 1 2\n");
}

TEST_CASE("PLY is little-endian, of floats if they are enough, else of doubles", "[io][golden]") {
  PolygonMesh mesh;
  mesh.points = {{0, 1, -2}, {0, 0, 0}, {0, 0, 0}};
  mesh.addFace(std::vector<Index>{2, 1, 0});
  const auto header = [](const std::string& type) {
    return "ply\nformat binary_little_endian 1.0\ncomment libvox\nelement vertex 3\nproperty " +
           type + " x\nproperty " + type + " y\nproperty " + type +
           " z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  };
  const std::string face("\x03\x02\0\0\0\x01\0\0\0\0\0\0\0", 13);
  const auto zeros = [](std::size_t count) { return std::string(count, '\0'); };
  CHECK(written(mesh, MeshFormat::kPly) ==
        header("float") + zeros(6) + "\x80\x3f" + zeros(3) + "\xc0" + zeros(24) + face);
  mesh.points[0].x() = 1 + 0x1p-40;  // a double between two floats
  CHECK(written(mesh, MeshFormat::kPly) == header("double") + zeros(1) + "\x10" + zeros(4) +
                                               "\xf0\x3f" + zeros(6) + "\xf0\x3f" + zeros(7) +
                                               "\xc0" + zeros(48) + face);
}

TEST_CASE("writing and reading back gives the same bits", "[io][property]") {
  const auto [format, name] = GENERATE(table<MeshFormat, std::string>(
      {{MeshFormat::kObj, "a.obj"}, {MeshFormat::kPly, "a.ply"}, {MeshFormat::kOff, "a.off"}}));
  CAPTURE(name);
  for (const PolygonMesh& mesh : {awkwardMesh(), polygonOf(255), polygonOf(256), polygonOf(70000)})
    checkSameBits(readBack(written(mesh, format), name), mesh);
}

TEST_CASE("colours that were written are read back", "[io][color]") {
  PolygonMesh mesh = polygonOf(5);
  mesh.addFace(std::vector<Index>{0, 2, 4});
  for (Index v = 0; v < mesh.pointCount(); ++v)
    mesh.pointColors.emplace_back(0.25F * static_cast<float>(v), 1.0F, 0.001F);
  const auto near = [](const std::vector<Vec3f>& a, const std::vector<Vec3f>& b, float most) {
    bool same = a.size() == b.size();
    for (std::size_t i = 0; same && i < a.size(); ++i)
      same = (a[i] - b[i]).cwiseAbs().maxCoeff() <= most;
    return same;
  };
  constexpr float kRounding = 1e-6F;
  constexpr float kByte = 0.6F / 255 * 2.4F;  // half a step where the curve of sRGB is steepest
  const PolygonMesh obj = readBack(written(mesh, MeshFormat::kObj), "a.obj");
  CHECK(near(obj.pointColors, mesh.pointColors, kRounding));
  for (const bool onFaces : {false, true}) {
    if (onFaces) mesh.faceColors = {{0.5F, 0, 1}, {0, 0.25F, 0}};
    const PolygonMesh off = readBack(written(mesh, MeshFormat::kOff), "a.off");
    CHECK(near(off.pointColors, mesh.pointColors, kRounding));
    CHECK(near(off.faceColors, mesh.faceColors, kRounding));
    const PolygonMesh ply = readBack(written(mesh, MeshFormat::kPly), "a.ply");
    CHECK(near(ply.pointColors, mesh.pointColors, kByte));
    CHECK(near(ply.faceColors, mesh.faceColors, kByte));
    checkSameBits(ply, mesh);
  }
}

TEST_CASE("PLY counts corners with uchar where it can", "[io]") {
  CHECK_THAT(written(polygonOf(255), MeshFormat::kPly), Catch::Contains("list uchar int"));
  CHECK_THAT(written(polygonOf(256), MeshFormat::kPly), Catch::Contains("list uint int"));
}

TEST_CASE("a stream that fails, early or late, is an error", "[io][error]") {
  const MeshFormat format = GENERATE(MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kOff);
  const PolygonMesh mesh = polygonOf(70000);
  const auto size = static_cast<std::streamsize>(written(mesh, format).size());
  for (const std::streamsize room : {std::streamsize{0}, size / 2, size - 1}) {
    FullDisk disk(room);
    std::ostream out(&disk);
    CHECK_THROWS_AS(writeMesh(out, mesh, format), IoError);
  }
  FullDisk disk(size);
  std::ostream out(&disk);
  CHECK_NOTHROW(writeMesh(out, mesh, format));
}
