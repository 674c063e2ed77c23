#include "libvox/pipeline/request.h"

#include "libvox/core/error.h"
#include "libvox/options/option_text.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <utility>

using namespace vox;

namespace {

Scene sceneOf(std::size_t objects) {
  Scene scene;
  for (std::size_t i = 0; i < objects; ++i)
    scene.objects.push_back({"cube " + std::to_string(i), test::cube()});
  return scene;
}

}  // namespace

TEST_CASE("without options every value is the default", "[request]") {
  const Request request = resolve(sceneOf(1), ConvertOptions());
  CHECK_FALSE(request.resolution.isSet());
  CHECK(request.turn == Turn::kNoTurn);
  CHECK(request.grids == std::vector{GridKind::kDensity});
  CHECK(request.volume.band == kDefaultBand);
  CHECK_FALSE(request.volume.tolerance);
  CHECK_FALSE(request.volume.half);
  CHECK(request.optionText == "dim=256");
  REQUIRE(request.objects.size() == 1);
  const ObjectRequest& object = request.objects[0];
  CHECK(object.preparation.boundary == BoundaryRule::kExtend);
  CHECK_FALSE(object.preparation.interpolates());
  CHECK(object.preparation.weldTolerance == 0);
  CHECK_FALSE(object.way.polygons);
  CHECK_FALSE(object.texture.has_value());
}

TEST_CASE("the options win over the object, the object over the scene", "[request]") {
  Scene scene = sceneOf(2);
  scene.until = StopRule{.levels = 1};
  scene.objects[1].until = StopRule{.levels = 2};
  ConvertOptions options;
  const auto levelsOf = [&](std::size_t object) {
    return resolve(scene, options).objects[object].way.until.levels;
  };
  CHECK(levelsOf(0) == 1);
  CHECK(levelsOf(1) == 2);
  options.until = StopRule{.levels = 3};
  CHECK(levelsOf(0) == 3);
  CHECK(levelsOf(1) == 3);
}

TEST_CASE("options of volumes are resolved one by one", "[request]") {
  Scene scene = sceneOf(1);
  ConvertOptions options;
  options.volume.gain = 2;
  options.volume.up = UpAxis::kY;
  scene.volume.gain = 3;
  scene.volume.half = true;
  scene.volume.compression = Compression::kZip;
  scene.volume.up = UpAxis::kZ;
  const Request request = resolve(scene, options);
  CHECK(request.volume.gain == 2);
  CHECK(request.turn == Turn::kYToZ);
  CHECK(request.volume.half);
  CHECK(request.volume.compression == Compression::kZip);
  CHECK(request.volume.fill == Fill::kSurface);
}

TEST_CASE("the vertices to interpolate are one choice", "[request]") {
  Scene scene = sceneOf(1);
  SmoothingOptions& ofObject = scene.objects[0].smoothing;
  ofObject.boundary = BoundaryRule::kFree;
  ofObject.interpolate = Interpolate::kInterior;
  ofObject.interpolatedVertices = std::vector<Index>{2, 0};
  ofObject.faces = FaceRule::kKeep;
  PreparationOptions options;
  CHECK(preparationsOf(scene, options)[0].interpolatedVertices == std::vector<Index>{2, 0});
  // Options that name one part of the choice replace all of it.
  options.smoothing.interpolate = Interpolate::kNothing;
  const ObjectPreparation preparation = preparationsOf(scene, options)[0];
  CHECK(preparation.boundary == BoundaryRule::kFree);
  CHECK_FALSE(preparation.interpolates());
}

TEST_CASE("concave faces are split before smoothing only", "[request]") {
  Scene scene = sceneOf(2);
  scene.objects[0].smoothing.faces = FaceRule::kKeep;
  const auto rules = [&](const ConvertOptions& options) {
    const Request request = resolve(scene, options);
    return std::pair(request.objects[0].preparation.faces, request.objects[1].preparation.faces);
  };
  ConvertOptions options;
  CHECK(rules(options) == std::pair(FaceRule::kKeep, FaceRule::kSplit));
  options.smoothing.faces = FaceRule::kSplit;
  CHECK(rules(options) == std::pair(FaceRule::kSplit, FaceRule::kSplit));
  options.until = StopRule{.levels = 0};
  CHECK(rules(options) == std::pair(FaceRule::kKeep, FaceRule::kKeep));
  options.until = StopRule{.levels = 1};
  CHECK(rules(options) == std::pair(FaceRule::kSplit, FaceRule::kSplit));
}

TEST_CASE("options that name a resolution replace all that the scene says of it", "[request]") {
  Scene scene = sceneOf(1);
  scene.voxelSize = 0.5;
  ConvertOptions options;
  CHECK(resolutionOf(scene, options).voxelSize == 0.5);
  options.dim = 10;
  CHECK_FALSE(resolutionOf(scene, options).voxelSize.has_value());
  CHECK(resolve(scene, options).optionText == "dim=10");
}

TEST_CASE("a texture brings the color grid, unless the options name the grids", "[request]") {
  Scene scene = sceneOf(2);
  scene.grids = {GridKind::kMask};
  scene.objects[1].texture = parseTexture("marble");
  ConvertOptions options;
  CHECK(resolve(scene, options).grids == std::vector{GridKind::kMask});
  options.texture = parseTexture("brick");
  const Request request = resolve(scene, options);
  CHECK(request.grids == std::vector{GridKind::kMask, GridKind::kColor});
  for (const ObjectRequest& object : request.objects) CHECK(object.texture == options.texture);
  options.grids = {GridKind::kMask};
  CHECK_THROWS_AS(resolve(scene, options), UsageError);
}

TEST_CASE("what cannot be is refused before any work", "[request]") {
  Scene scene = sceneOf(2);
  ConvertOptions options;
  SECTION("vertices that stop at a level") {
    options.until = StopRule{.levels = 2};
    options.voxelize = Voxelize::kVertex;
  }
  SECTION("a number out of range") {
    scene.volume.band = 0;
  }
  SECTION("a free boundary that is interpolated") {
    options.smoothing.boundary = BoundaryRule::kFree;
    scene.objects[1].smoothing.interpolate = Interpolate::kBoth;
  }
  SECTION("vertices of one object, for several objects") {
    options.smoothing.interpolatedVertices = {0};
  }
  CHECK_THROWS_AS(resolve(scene, options), UsageError);
}

TEST_CASE("options written as text are read again", "[request]") {
  ConvertOptions options;
  SECTION("none") {}
  SECTION("each") {
    options.voxelSize = 1.0 / 3;
    options.smoothing.boundary = BoundaryRule::kFree;
    options.smoothing.interpolate = Interpolate::kInterior;
    options.smoothing.interpolatedVertices = {7, 8, 9};
    options.smoothing.faces = FaceRule::kKeep;
    options.weldTolerance = 1e-5;
    options.texture = parseTexture("marble:scale=0.2,seed=3,colors=#102030/1:0.5:0");
    options.volume.fill = Fill::kSolid;
    options.volume.edge = Edge::kSoft;
    options.volume.gain = 0.1;
    options.volume.openMesh = OpenMesh::kUnsigned;
    options.volume.band = 4;
    options.volume.tolerance = 0.3;
    options.volume.half = true;
    options.volume.target = Target::kBlender34;
    options.volume.up = UpAxis::kY;
    options.until = StopRule{.levels = 3, .flatness = 0.5};
    options.voxelize = Voxelize::kPolygon;
  }
  SECTION("a dim") {
    options.dim = 100;
  }
  SECTION("two widths of the band") {
    options.volume.band = BandWidths(1.0 / 0.3, 5);
  }
  const std::string text = optionText(options);
  CAPTURE(text);
  const RecordedOptions recorded = parseOptionText(text);
  CHECK(recorded.options.voxelSize == options.voxelSize);
  CHECK(recorded.options.dim == options.dim);
  CHECK(recorded.options.smoothing.boundary == options.smoothing.boundary);
  CHECK(recorded.options.weldTolerance == options.weldTolerance);
  CHECK(recorded.options.texture == options.texture);
  CHECK(recorded.options.volume.gain == options.volume.gain);
  CHECK(recorded.options.volume.band == options.volume.band);
  CHECK(recorded.options.until == options.until);
  const auto& vertices = options.smoothing.interpolatedVertices;
  CHECK((recorded.lists == std::vector<std::string>{"interpolated-vertices"}) ==
        vertices.has_value());
  // All other fields: they are written as they were.
  ConvertOptions again = recorded.options;
  again.smoothing.interpolatedVertices = vertices;
  CHECK(optionText(again) == text);
}

TEST_CASE("the text of options has its words in a fixed order", "[request][golden]") {
  ConvertOptions options;
  options.dim = 64;
  options.smoothing.boundary = BoundaryRule::kFree;
  options.weldTolerance = 0.25;
  options.volume.half = true;
  options.until = StopRule{.levels = 3};
  CHECK(optionText(options) == "dim=64 boundary=free weld=0.25 half until=levels=3");
  options = {};
  options.volume.band = 3;
  CHECK(optionText(options) == "band=3");
  options.volume.band = BandWidths(2, 5);
  CHECK(optionText(options) == "band=2,5");
}

TEST_CASE("two widths of the band are recorded even if the scene set them", "[request]") {
  Scene scene = sceneOf(1);
  scene.volume.band = BandWidths(2, 5);
  CHECK(resolve(scene, {}).optionText == "dim=256 band=2,5");
  scene.volume.band = 5;
  CHECK(resolve(scene, {}).optionText == "dim=256");
}

TEST_CASE("text that vox has not written is refused, and quoted", "[request]") {
  for (const std::string word :
       {"weld=abc", "weld=", "weld", "weld=nan", "weld=1x", "weld=-1", "dim=1.5", "dim=-3",
        "boundary=loose", "half=1", "until=later", "texture=fog", "interpolated-vertices=-1",
        "colour=red", "band=", "band=1,2,3", "band=1,b", "=", "x"}) {
    CAPTURE(word);
    CHECK_THROWS_AS(parseOptionText("dim=64 " + word), InputError);
    CHECK_THROWS_WITH(parseOptionText("dim=64 " + word), Catch::Contains("'" + word + "'"));
  }
  CHECK(parseOptionText("").options.dim == std::nullopt);
}

TEST_CASE("guarantees written as text are read again, others refused", "[request]") {
  for (const Separation separation : {Separation::k6, Separation::k26})
    CHECK(parseGuarantee(guaranteeText(separation)) == separation);
  CHECK(guaranteeText(Separation::k26) == "26-separating");
  for (const std::string text : {"", "7-separating", "26", "26-Separating", "-separating"})
    CHECK_THROWS_AS(parseGuarantee(text), InputError);
}
