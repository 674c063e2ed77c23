#include "libvox/prepare/debris.h"

#include "libvox/core/error.h"
#include "libvox/io/scene_file.h"
#include "libvox/options/option_text.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/refine.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

using namespace vox;
using Catch::Contains;

namespace {

/// A torus, a cube of 1/10 far off, and a lone small triangle farther off.
PolygonMesh withCrumbs() {
  PolygonMesh mesh = test::together(test::torusGrid(12, 7), test::cube(), Vec3d(50, 0, 0), 0.1);
  return test::together(mesh, test::meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}),
                        Vec3d(-90, 0, 0), 0.001);
}

PolygonMesh kept(const PolygonMesh& mesh, const ComponentLimit& limit, DebrisReport& report) {
  return withoutDebris(mesh, limit, {}, report);
}

}  // namespace

TEST_CASE("components of fewer faces, or with a shorter diagonal, are debris", "[debris]") {
  const PolygonMesh mesh = withCrumbs();
  DebrisReport report;
  CHECK(kept(mesh, {.below = 2}, report).faceCount() == 84 + 6);
  CHECK(summary(report) == "dropped 1 component of 1 face");
  CHECK(report.components == 3);
  CHECK(kept(mesh, {.below = 7}, report).faceCount() == 84);
  CHECK(summary(report) == "dropped 2 components of 7 faces");
  CHECK(kept(mesh, {.size = 0.1}, report).faceCount() == 84 + 6);
  CHECK(kept(mesh, {.size = 0.346}, report).faceCount() == 84 + 6);  // 0.2 * sqrt(3)
  CHECK(kept(mesh, {.size = 0.347}, report).faceCount() == 84);
  CHECK(kept(mesh, {.below = 2, .size = 0.347}, report).faceCount() == 84);
  CHECK(kept(mesh, {.below = 1}, report).faceCount() == 91);
  CHECK(summary(report).empty());
  CHECK(kept(mesh, {.below = 85}, report).faceCount() == 0);
}

TEST_CASE("faces that repair joins are one component", "[debris]") {
  DebrisReport report;
  // All faces have vertices of their own; welding joins them.
  CHECK(kept(test::unwelded(test::cube()), {.below = 6}, report).faceCount() == 6);
  CHECK(kept(test::finOnSheet(), {.below = 3}, report).faceCount() ==
        test::finOnSheet().faceCount());
}

TEST_CASE("the box for the resolution is that of what remains", "[debris][pipeline]") {
  ConvertOptions options;
  options.dim = 64;
  options.grids = {GridKind::kMask};
  const Conversion clean = convert(test::oneObject(test::torusGrid(12, 7)), options);
  options.dropComponents = ComponentLimit{.below = 10};
  options.strict = true;  // dropping is no repair
  const Conversion dropped = convert(test::oneObject(withCrumbs()), options);
  CHECK(dropped.report.voxelSize == clean.report.voxelSize);
  CHECK(dropped.report.activeVoxels == clean.report.activeVoxels);
  REQUIRE(dropped.report.warnings.size() == 1);
  CHECK(dropped.report.warnings[0] == "object: dropped 2 components of 7 faces");
  CHECK(refine(test::oneObject(withCrumbs()), 0, options, {}).mesh.faceCount() == 84);
}

TEST_CASE("an object that is debris as a whole is refused", "[debris][pipeline][error]") {
  ConvertOptions options;
  options.dropComponents = ComponentLimit{.below = 1000};
  CHECK_THROWS_WITH(convert(test::oneObject(withCrumbs()), options),
                    Contains("all 3 components would be dropped; the largest has 84 faces"));
}

TEST_CASE("objects of a scene have limits of their own", "[debris][scene]") {
  const char* const text = R"(
[convert]
drop_components = { below = 7 }
[[object]]
points = [[0,0,0],[1,0,0],[0,1,0]]
faces = [[0,1,2]]
drop_components = { below = 0 }
[[object]]
points = [[0,0,0],[1,0,0],[0,1,0]]
faces = [[0,1,2]]
)";
  const Scene scene = parseScene("s.toml", text);
  const auto preparations = preparationsOf(scene, {});
  CHECK(preparations[0].dropComponents.dropsNothing());
  CHECK(preparations[1].dropComponents == ComponentLimit{.below = 7});
  CHECK_THROWS_WITH(parseScene("s.toml", "[convert]\ndrop_components = {}\n"),
                    Contains("needs below or size"));
}

TEST_CASE("limits of components are read from the text that is written", "[debris]") {
  for (const ComponentLimit& limit : {ComponentLimit{.below = 12}, ComponentLimit{.size = 0.1},
                                      ComponentLimit{.below = 0, .size = 1e-7}}) {
    CHECK(componentLimitIn(componentLimitText(limit)) == limit);
    ConvertOptions options;
    options.dropComponents = limit;
    CHECK(parseOptionText(optionText(options)).options.dropComponents == limit);
  }
  for (const char* wrong : {"", "below", "below=", "below=-1", "below=1.5", "size=nan", "size=-1",
                            "below=1,", "large=3", "size=1e999"})
    CHECK_FALSE(componentLimitIn(wrong));
}
