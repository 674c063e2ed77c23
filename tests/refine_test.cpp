#include "libvox/pipeline/refine.h"

#include "libvox/core/error.h"
#include "libvox/core/progress.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <vector>

using namespace vox;
using Catch::Contains;

namespace {}  // namespace

TEST_CASE("refining a scene joins its objects into one mesh", "[pipeline]") {
  const Scene scene = test::sceneOf({test::cube(), test::tetrahedron()});
  const PolygonMesh mesh = refine(scene, 1, {}, {}).mesh;
  CHECK(mesh.pointCount() == 24 + 12);
  CHECK(mesh.faceCount() == 26 + 14);
  CHECK(mesh.face(26)[0] == 24);
  CHECK(refine(scene, 0, {}, {}).mesh.points == [] {
    auto points = test::cube().points;
    const auto more = test::tetrahedron().points;
    points.insert(points.end(), more.begin(), more.end());
    return points;
  }());
}

TEST_CASE("level 0 is the prepared mesh: welded, oriented, each face from its lowest vertex",
          "[pipeline]") {
  PolygonMesh flipped = test::cube();
  std::reverse(flipped.faceVertices.begin() + 4, flipped.faceVertices.begin() + 8);
  const PolygonMesh plain = refine(test::sceneOf({test::cube()}), 0, {}, {}).mesh;
  const Refinement repaired = refine(test::sceneOf({flipped}), 0, {}, {});
  CHECK(repaired.mesh.faceVertices == plain.faceVertices);
  CHECK(repaired.warnings.size() == 1);
}

TEST_CASE("colours that are an affine function of the position stay so at every level",
          "[pipeline][color]") {
  const auto colorAt = [](const Vec3d& p) {
    return Vec3d(0.5 + 0.05 * p.x(), 0.4 - 0.06 * p.y() + 0.02 * p.z(), 0.25);
  };
  PolygonMesh mesh = GENERATE(test::cube(), test::sheet(4, 3), test::dodecahedron());
  for (const Vec3d& point : mesh.points) mesh.pointColors.push_back(colorAt(point).cast<float>());
  for (const int levels : {0, 1, 3}) {
    const PolygonMesh refined = refine(test::sceneOf({mesh}), levels, {}, {}).mesh;
    REQUIRE(refined.pointColors.size() == refined.points.size());
    double most = 0;
    for (Index v = 0; v < refined.pointCount(); ++v) {
      const Vec3d off = refined.pointColors[v].cast<double>() - colorAt(refined.points[v]);
      most = std::max(most, off.cwiseAbs().maxCoeff());
    }
    CHECK(most < 1e-6);
  }
}

TEST_CASE("the first step gives every image vertex the colour of its face", "[pipeline][color]") {
  PolygonMesh mesh = GENERATE(test::cube(), test::sheet(2, 2));
  for (Index f = 0; f < mesh.faceCount(); ++f)
    mesh.faceColors.emplace_back(0.1F * static_cast<float>(f), 1, 0);
  const PolygonMesh controls = refine(test::sceneOf({mesh}), 0, {}, {}).mesh;
  CHECK(controls.faceColors == mesh.faceColors);
  CHECK(controls.pointColors.empty());
  const PolygonMesh refined = refine(test::sceneOf({mesh}), 1, {}, {}).mesh;
  REQUIRE(refined.pointColors.size() == refined.points.size());
  for (Index f = 0; f < mesh.faceCount(); ++f)  // the first faces are F-faces
    for (const Index v : refined.face(f)) CHECK(refined.pointColors[v] == mesh.faceColors[f]);
}

TEST_CASE("objects without colours are grey beside others", "[pipeline][color]") {
  PolygonMesh colored = test::cube();
  colored.pointColors.assign(8, Vec3f(1, 0, 0));
  for (const bool first : {false, true}) {
    const Scene scene = first ? test::sceneOf({colored, test::tetrahedron()})
                              : test::sceneOf({test::tetrahedron(), colored});
    const PolygonMesh mesh = refine(scene, 0, {}, {}).mesh;
    REQUIRE(mesh.pointColors.size() == 12);
    CHECK(mesh.pointColors.front() == (first ? Vec3f(1, 0, 0) : Vec3f(0.8F, 0.8F, 0.8F)));
    CHECK(mesh.pointColors.back() == (first ? Vec3f(0.8F, 0.8F, 0.8F) : Vec3f(1, 0, 0)));
  }
  CHECK(refine(test::sceneOf({test::cube(), test::cube()}), 1, {}, {}).mesh.pointColors.empty());
}

TEST_CASE("level 0 is the control mesh when vertices are interpolated", "[pipeline]") {
  PreparationOptions options;
  options.smoothing.interpolate = Interpolate::kInterior;
  const Scene scene = test::sceneOf({test::cube()});
  const PolygonMesh controls = refine(scene, 0, options, {}).mesh;
  const PolygonMesh refined = refine(scene, 1, options, {}).mesh;
  for (Index v = 0; v < 8; ++v) {
    CHECK(controls.points[v].norm() > test::cube().points[v].norm());
    CHECK((test::faceCentroid(refined, 6 + 12 + v).cwiseAbs() - Vec3d::Ones()).norm() < 1e-12);
  }
  SceneObject own = scene.objects[0];
  own.smoothing = options.smoothing;
  Scene inScene;
  inScene.objects = {own};
  CHECK(refine(inScene, 0, {}, {}).mesh.points == controls.points);
  PreparationOptions none;
  none.smoothing.interpolate = Interpolate::kNothing;
  CHECK(refine(inScene, 0, none, {}).mesh.points == test::cube().points);
}

TEST_CASE("vertices that cannot be interpolated are refused with a reason", "[pipeline][error]") {
  PreparationOptions options;
  options.smoothing.interpolatedVertices = std::vector<Index>{8};
  CHECK_THROWS_WITH(refine(test::sceneOf({test::valenceTwo()}), 0, options, {}),
                    Contains("vertex 8 is to be interpolated, but repair has removed it"));
  CHECK_THROWS_WITH(refine(test::sceneOf({test::cube()}), 0, options, {}),
                    Contains("vertex 8 is to be interpolated, but there are only 8"));

  options = {};
  options.smoothing.interpolate = Interpolate::kBoth;
  options.smoothing.boundary = BoundaryRule::kFree;
  CHECK_THROWS_AS(refine(test::sceneOf({test::sheet(3, 3)}), 1, options, {}), UsageError);
  options = {};
  options.smoothing.interpolatedVertices = std::vector<Index>{0};
  CHECK_THROWS_AS(refine(test::sceneOf({test::cube(), test::cube()}), 1, options, {}), UsageError);
  CHECK_THROWS_WITH(refine(test::sceneOf({test::sheet(2, 2)}), 1, options, {}),
                    Contains("vertex 0 cannot be interpolated: it is on the boundary"));
}

TEST_CASE("an error names file, object and element", "[pipeline][error]") {
  PolygonMesh degenerate = test::cube();
  for (Index& v : degenerate.faceVertices) v = 3;
  Scene scene = test::sceneOf({test::cube(), degenerate});
  scene.files = {"two.toml"};
  CHECK_THROWS_WITH(refine(scene, 1, {}, {}),
                    Contains("two.toml: object 2: nothing is left after repair"));
  scene.objects[1].mesh = test::cube();
  scene.objects[1].mesh.faceVertices[9] = 8;
  CHECK_THROWS_WITH(refine(scene, 1, {}, {}),
                    Contains("two.toml: object 2: face 2 names vertex 8"));
}

TEST_CASE("refinement keeps to its memory limit", "[pipeline][error]") {
  RunOptions options;
  options.maxMemory = std::uint64_t{1} << 26;
  CHECK_THROWS_AS(refine(test::sceneOf({test::cube()}), 25, {}, options), LimitError);
  const std::vector<PolygonMesh> many(40, test::cube());
  CHECK_NOTHROW(refine(test::sceneOf({test::cube()}), 6, {}, options));
  CHECK_THROWS_AS(refine(test::sceneOf(many), 6, {}, options), LimitError);
}

TEST_CASE("refinement moves on with its levels, and can be cancelled", "[pipeline]") {
  std::vector<double> fractions;
  Progress* run = nullptr;
  bool stop = false;
  const auto note = [&](double fraction, const char*) {
    fractions.push_back(fraction);
    if (stop && fraction > 0.1) run->cancel();
  };
  RunOptions options;
  Progress whole(note, std::chrono::nanoseconds(0));
  run = options.progress = &whole;
  refine(test::sceneOf({test::cube(), test::tetrahedron()}), 5, {}, options);
  CHECK(std::is_sorted(fractions.begin(), fractions.end()));
  CHECK(fractions.size() > 10);
  CHECK(fractions.back() < 1);  // the rest is for writing
  whole.finish();
  CHECK(fractions.back() == 1);
  fractions.clear();
  stop = true;
  Progress part(note, std::chrono::nanoseconds(0));
  run = options.progress = &part;
  CHECK_THROWS_AS(refine(test::sceneOf({test::cube(), test::tetrahedron()}), 5, {}, options),
                  Cancelled);
  CHECK(fractions.back() < 0.3);
}

TEST_CASE("impossible requests for refinement are refused", "[pipeline][error]") {
  CHECK_THROWS_AS(refine(test::sceneOf({test::cube()}), -1, {}, {}), UsageError);
  RunOptions options;
  options.threads = -3;
  CHECK_THROWS_AS(refine(test::sceneOf({test::cube()}), 1, {}, options), UsageError);
  PolygonMesh wrong = test::cube();
  wrong.faceVertices[5] = 50000000;
  CHECK_THROWS_AS(refine(test::sceneOf({wrong}), 1, {}, {}), MeshError);
}

TEST_CASE("a strict run names the first thing that a mesh needs", "[pipeline][error]") {
  PolygonMesh flipped = test::cube();
  test::flipFace(flipped, 4);
  PolygonMesh unused = test::cube();
  unused.points.insert(unused.points.begin(), Vec3d(9, 9, 9));
  for (Index& v : unused.faceVertices) ++v;
  PolygonMesh duplicate = test::cube();
  duplicate.addFace(duplicate.face(2));
  PolygonMesh repeated = test::cube();
  repeated.addFace(std::vector<Index>{3, 3, 5});
  const PolygonMesh book = test::meshOf({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                                        {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  PolygonMesh strip = test::moebius(8);  // inconsistently wound at one edge only
  for (Index f = 4; f < 8; ++f) test::flipFace(strip, f);
  const std::vector<std::pair<PolygonMesh, std::string>> cases = {
      {flipped, "flipped face 4, "},
      {test::insideOut(test::cube()), "flipped face 0, "},
      {unused, "removed vertex 0, which belongs to no face"},
      {duplicate, "dropped face 6, which repeats face 2"},
      {repeated, "dropped face 6, which has fewer than 3 distinct corners"},
      {test::unwelded(test::cube()), "welded vertex 8 to vertex 0"},
      {book, "cut edge (0, 1) of face 0, "},
      {test::bowTie(), "split vertex 0, which joins several fans of faces"},
      {test::valenceTwo(), "chorded vertex 8, "},
      {strip, "doubled the component of face 0, which is one-sided"},
  };
  PreparationOptions strict;
  strict.strict = true;
  for (const auto& [mesh, message] : cases) {
    CAPTURE(message);
    Scene scene = test::sceneOf({test::cube(), mesh});
    scene.files = {"two.toml"};
    CHECK_THROWS_WITH(
        refine(scene, 0, strict, {}),
        Contains("two.toml: object 2: needs repair, which --strict forbids: " + message));
    CHECK_NOTHROW(refine(scene, 0, {}, {}));
    scene.strict = true;
    CHECK_THROWS_AS(refine(scene, 0, {}, {}), MeshError);
    strict.strict = false;
    CHECK_NOTHROW(refine(scene, 0, strict, {}));
    strict.strict = true;
  }
  for (const auto& shape : test::openShapes()) {
    CAPTURE(shape.name);
    CHECK_NOTHROW(refine(test::sceneOf({shape.mesh}), 0, strict, {}));
  }
}

TEST_CASE("elements in messages are those of the input, after repair too", "[pipeline]") {
  PolygonMesh mesh = test::cube();
  mesh.addFace(std::vector<Index>{0, 0, 1});  // is dropped, so faces of the strip are renumbered
  mesh = test::together(mesh, test::moebius(8), {5, 0, 0});
  const auto warnings = refine(test::sceneOf({mesh}), 0, {}, {}).warnings;
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("dropped 1 degenerate face, ") &&
                              Contains(", doubled 1 one-sided component (face 7)"));
}

TEST_CASE("a weld tolerance closes small gaps, the command line before the scene", "[pipeline]") {
  PolygonMesh gaping = test::unwelded(test::cube());
  for (Index v = 0; v < gaping.pointCount(); ++v) gaping.points[v].x() += 0.001 * (v / 4);
  Scene scene = test::sceneOf({gaping});
  CHECK(refine(scene, 0, {}, {}).mesh.pointCount() == 24);
  scene.weldTolerance = 0.01;
  CHECK(refine(scene, 0, {}, {}).mesh.pointCount() == 8);
  PreparationOptions options;
  options.weldTolerance = 0;
  CHECK(refine(scene, 0, options, {}).mesh.pointCount() == 24);
  options.weldTolerance = -0.5;
  CHECK_THROWS_AS(refine(scene, 0, options, {}), UsageError);
}
