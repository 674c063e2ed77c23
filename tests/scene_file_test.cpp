#include "libvox/io/scene_file.h"

#include "libvox/core/error.h"
#include "libvox/io/read_indices.h"
#include "libvox/mesh/validate.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

using namespace vox;
using Catch::Contains;

namespace {

const std::string kTriangleKeys =
    "points = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n";

Scene read(const std::string& text) {
  const test::TemporaryFolder folder;
  return readScene(folder.write("scene.toml", text));
}

void checkRefused(const std::string& text, const std::string& where, const std::string& what) {
  CAPTURE(text);
  try {
    read(text);
    FAIL("accepted");
  } catch (const InputError& error) {
    CHECK_THAT(error.what(), Contains("scene.toml" + where) && Contains(what));
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
  }
}

}  // namespace

TEST_CASE("a scene gives settings and objects", "[scene]") {
  const Scene scene = read(
      "[convert]\ndim = 128\ngrids = ['mask', 'density']\nweld = 0.25\nstrict = true\n"
      "fill = 'solid'\nedge = 'soft'\ngain = 30\nopen_mesh = 'error'\n"
      "[[object]]\nname = 't'\n" +
      kTriangleKeys + "[[object]]\n" + kTriangleKeys);
  CHECK(scene.dim == 128);
  CHECK_FALSE(scene.voxelSize.has_value());
  CHECK(scene.grids == std::vector{GridKind::kMask, GridKind::kDensity});
  CHECK(scene.weldTolerance == 0.25);
  CHECK(scene.strict == true);
  CHECK(scene.volume.fill == Fill::kSolid);
  CHECK(scene.volume.edge == vox::Edge::kSoft);
  CHECK(scene.volume.gain == 30);
  CHECK(scene.volume.openMesh == vox::OpenMesh::kError);
  REQUIRE(scene.objects.size() == 2);
  CHECK(scene.objects[0].name == "t");
  CHECK(scene.objects[1].name == "object 2");
  CHECK(scene.objects[0].mesh.points[1] == Vec3d(1, 0, 0));
  CHECK(scene.objects[0].mesh.faceVertices == std::vector<Index>{0, 1, 2});
}

TEST_CASE("the band of a scene has one width or two", "[scene]") {
  const auto bandOf = [](const std::string& value) {
    return read("[convert]\nband = " + value + "\n[[object]]\n" + kTriangleKeys).volume.band;
  };
  CHECK(bandOf("3") == BandWidths(3));
  CHECK(bandOf("[2, 5.5]") == BandWidths(2, 5.5));
  CHECK(bandOf("[4, 4]") == BandWidths(4));
  for (const std::string value : {"[]", "[1]", "[1, 2, 3]", "'2,5'", "[1, 'x']", "[[1, 2], 3]"}) {
    CAPTURE(value);
    CHECK_THROWS_AS(bandOf(value), InputError);
  }
}

TEST_CASE("a mesh path is relative to its scene", "[scene]") {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "sub");
  folder.write("sub/a.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
  folder.write("sub/s.toml", "[[object]]\nmesh = 'a.obj'\n");
  const Scene scene = readScene(folder / "sub/s.toml");
  CHECK(scene.objects[0].mesh.points[2] == Vec3d(0, 2, 0));
  CHECK(scene.files.size() == 2);
}

TEST_CASE("a mesh file is a scene of one object named after it", "[scene]") {
  const test::TemporaryFolder folder;
  const Scene scene = readScene(folder.write("ear.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n"));
  REQUIRE(scene.objects.size() == 1);
  CHECK(scene.objects[0].name == "ear");
}

TEST_CASE("a transform scales, rotates about x, y, z, then translates", "[scene][golden]") {
  const auto pointAfter = [](const std::string& transform) {
    return read("[[object]]\n" + kTriangleKeys + "transform = " + transform)
        .objects[0]
        .mesh.points[1];
  };
  const auto near = [](const Vec3d& a, const Vec3d& b) { return (a - b).norm() < 1e-15; };
  CHECK(near(pointAfter("{ translate = [1, 2, 3] }"), {2, 2, 3}));
  CHECK(near(pointAfter("{ scale = 2, translate = [1, 0, 0] }"), {3, 0, 0}));
  CHECK(near(pointAfter("{ scale = [3, 1, 1] }"), {3, 0, 0}));
  CHECK(near(pointAfter("{ rotate = [0, 0, 90] }"), {0, 1, 0}));
  CHECK(near(pointAfter("{ rotate = [0, 90, 0] }"), {0, 0, -1}));
  CHECK(near(pointAfter("{ rotate = [90, 0, 90] }"), {0, 1, 0}));   // x leaves (1, 0, 0) alone
  CHECK(near(pointAfter("{ rotate = [0, 90, 90] }"), {0, 0, -1}));  // y first, then z
}

TEST_CASE("a mirrored object keeps its faces outward", "[scene]") {
  const Scene scene = read("[[object]]\n" + kTriangleKeys + "transform = { scale = [1, 1, -1] }");
  CHECK(scene.objects[0].mesh.faceVertices == std::vector<Index>{0, 2, 1});
}

TEST_CASE("an object has smoothing options of its own", "[scene]") {
  const Scene scene = read("[[object]]\n" + kTriangleKeys +
                           "boundary = 'free'\ninterpolate = 'both'\n"
                           "interpolate_vertices = [2, 0]\n[[object]]\n" +
                           kTriangleKeys);
  const SmoothingOptions& first = scene.objects[0].smoothing;
  CHECK(first.boundary == BoundaryRule::kFree);
  CHECK(first.interpolate == Interpolate::kBoth);
  CHECK(first.interpolatedVertices == std::vector<Index>{2, 0});
  CHECK_FALSE(scene.objects[1].smoothing.boundary.has_value());
}

TEST_CASE("the scene and an object may have stop rules", "[scene]") {
  const Scene scene = read(
      "[convert]\nuntil = { levels = 3 }\n"
      "[[object]]\nuntil = { levels = 0 }\n" +
      kTriangleKeys + "[[object]]\nuntil = 'voxel'\n" + kTriangleKeys + "[[object]]\n" +
      kTriangleKeys);
  REQUIRE(scene.until.has_value());
  CHECK(scene.until->levels == 3);
  REQUIRE(scene.objects[0].until.has_value());
  CHECK(scene.objects[0].until->levels == 0);
  REQUIRE(scene.objects[1].until.has_value());
  CHECK_FALSE(scene.objects[1].until->levels.has_value());
  CHECK_FALSE(scene.objects[2].until.has_value());
}

TEST_CASE("a list of indices is read with its comments, and refused by line", "[scene]") {
  const test::TemporaryFolder folder;
  CHECK(readIndices(folder.write("a.txt", "3 1\n# four\n  4\t7 # and seven\n")) ==
        std::vector<Index>{3, 1, 4, 7});
  CHECK_THROWS_WITH(readIndices(folder.write("b.txt", "3\n1.5\n")), Contains("b.txt:2: "));
  CHECK_THROWS_WITH(readIndices(folder.write("c.txt", "3\n\n-1\n")),
                    Contains("c.txt:3: ") && Contains("not -1"));
  CHECK_THROWS_AS(readIndices(folder / "missing.txt"), InputError);
}

TEST_CASE("errors in a scene are named with line and column", "[scene][error]") {
  const std::string object = "[[object]]\n" + kTriangleKeys;
  checkRefused("[convert]\nsize = 3\n", ":2:1:", "unknown key 'size' in [convert]");
  checkRefused("colour = 1\n", ":1:1:", "unknown key 'colour'");
  checkRefused(object + "smooth = true\n", ":4:1:", "unknown key 'smooth' in [[object]]");
  checkRefused(object + "transform = { move = [0, 0, 0] }", ":4:15:", "unknown key 'move'");
  checkRefused(object + "boundary = 'round'\n",
               ":4:12:", "one of extend, free, corners, not 'round'");
  checkRefused(object + "interpolate = 'all'\n", ":4:15:", "none, interior, boundary, both");
  checkRefused(object + "interpolate = 1\n", ":4:15:", "must be a string");
  checkRefused(object + "interpolate_vertices = [3]\n", ":4:25:", "between 0 and 2");
  checkRefused("[convert]\ndim = 0\n", ":2:7:", "dim must lie between 1 and");
  checkRefused("[convert]\ndim = 'big'\n", ":2:7:", "dim must be an integer");
  checkRefused("[convert]\nvoxel_size = -1\n", ":2:14:", "voxel_size must be positive");
  checkRefused("[convert]\ndim = 3\nvoxel_size = 1\n", ":3:14:", "cannot both be given");
  checkRefused("[convert]\nweld = -1\n", ":2:8:", "weld must be 0 or more");
  checkRefused("[convert]\nweld = 'all'\n", ":2:8:", "weld must be a number");
  checkRefused("[convert]\nuntil = 'levels=3'\n", ":2:9:", "until must be \"voxel\" or { levels");
  checkRefused("[convert]\nfill = 'half'\n", ":2:8:", "fill must be one of surface, solid");
  checkRefused("[convert]\nfill = 3\n", ":2:8:", "fill must be a string");
  checkRefused("[convert]\nopen_mesh = 'no'\n", ":2:13:", "open_mesh must be one of error");
  checkRefused("[convert]\ngain = 'x'\n", ":2:8:", "gain must be a number");
  checkRefused("[convert]\nuntil = {}\n", ":2:9:", "until must be \"voxel\" or { levels");
  checkRefused("[convert]\nuntil = { depth = 3 }\n", ":2:11:", "unknown key 'depth' in until");
  checkRefused("[convert]\nuntil = { angle = 181 }\n", ":2:19:", "at most 180 degrees");
  checkRefused("[convert]\nuntil = { flatness = 0 }\n", ":2:22:", "positive number of voxels");
  checkRefused("[convert]\nvoxelize = 'all'\n", ":2:12:", "one of auto, vertex, polygon");
  checkRefused("[convert]\nuntil = { levels = 31 }\n", ":2:20:", "between 0 and 30, not 31");
  checkRefused(object + "until = 3\n", ":4:9:", "until must be \"voxel\" or { levels");
  checkRefused("[convert]\nstrict = 1\n", ":2:10:", "strict must be true or false");
  checkRefused("[convert]\ngrids = ['fog']\n", ":2:10:", "unknown grid 'fog'; known are density");
  checkRefused("[[object]]\nname = 'x'\n", ":1:1:", "needs either mesh, or points and faces");
  checkRefused("[[object]]\nmesh = 'no.obj'\n", ":2:8:", "no.obj");
  checkRefused("[[object]]\npoints = [[0, 0]]\nfaces = [[0, 0, 0]]\n", ":2:11:", "3 numbers");
  checkRefused("[[object]]\npoints = [[0, 0, nan]]\nfaces = [[0, 0, 0]]\n", ":2:18:", "finite");
  checkRefused("[[object]]\npoints = [[0, 0, 1e30]]\nfaces = [[0, 0, 0]]\n", ":2:18:", "1e15");
  checkRefused("[[object]]\npoints = [[0, 0, 1]]\nfaces = [[0, 0, 1]]\n",
               ":3:17:", "between 0 and 0");
  checkRefused("[[object]]\npoints = [[0, 0, 1]]\nfaces = [[0, 0]]\n", ":3:10:", "3 corners");
  checkRefused(object + "transform = { scale = 0 }", ":4:23:", "scale must not be 0");
  checkRefused("[convert\n", ":1:9:", "");
  checkRefused("[[object]]\nmesh = \"a.obj\\u0000.obj\"\n", ":2:8:", "NUL");
  std::string deep = "a";
  for (int i = 0; i < 100000; ++i) deep += ".a";
  checkRefused(deep + " = 1\n", ":1:1:", "nested too deeply");
  checkRefused("# deep\n[" + deep + "]\n", ":2:1:", "nested too deeply");
  checkRefused("", ":", "empty");
  checkRefused("[convert]\n", ":", "no [[object]]");
}

TEST_CASE("the shipped scenes are sound", "[scene]") {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(VOX_SCENES)) {
    if (entry.path().extension() != ".toml") continue;
    CAPTURE(entry.path());
    for (const SceneObject& object : readScene(entry.path()).objects)
      CHECK(findDefects(object.mesh, buildAdjacency(object.mesh)).empty());
    ++scenes;
  }
  CHECK(scenes >= 5);
}
