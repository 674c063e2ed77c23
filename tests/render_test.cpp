#include "libvox/render/render.h"

#include "libvox/core/error.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/render/visible.h"

#include <catch2/catch.hpp>
#include <openvdb/tools/LevelSetSphere.h>

#include <numbers>
#include <numeric>
#include <set>

using namespace vox;

namespace {

constexpr double kRadius = 20;

VisibleGrids sphereSet() {
  const auto sphere =
      openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(float(kRadius), {3, 4, 5}, 1);
  return visibleGrids(std::vector<openvdb::GridBase::Ptr>{sphere}, {});
}

/// The voxels of a ball, with a normal and a colour each.
VisibleGrids ball() {
  auto mask = openvdb::MaskGrid::create();
  auto normals = openvdb::Vec3SGrid::create();
  auto colors = openvdb::Vec3SGrid::create();
  normals->setName("normal");
  colors->setName("color");
  for (openvdb::CoordBBox::Iterator<true> voxel =
           openvdb::CoordBBox(openvdb::Coord(-22), openvdb::Coord(22)).begin();
       voxel; ++voxel) {
    const openvdb::Vec3d at = (*voxel).asVec3d();
    if (at.length() > kRadius) continue;
    mask->tree().setValueOn(*voxel);
    normals->tree().setValueOn(*voxel, openvdb::Vec3s(at / std::max(at.length(), 1e-9)));
    colors->tree().setValueOn(*voxel, openvdb::Vec3s(at.x() < 0 ? 1 : 0, 0, at.x() < 0 ? 0 : 1));
  }
  return visibleGrids(std::vector<openvdb::GridBase::Ptr>{mask, normals, colors}, {});
}

RenderOptions small() {
  RenderOptions options;
  options.views = {*viewNamed("front")};
  options.width = 100;
  options.height = 80;
  options.background = {0, 0, 0, 0};
  return options;
}

double coverage(const Image& image) {
  return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0,
                         [](double sum, const Pixel& pixel) { return sum + pixel[3] / 255.0; });
}

int brightness(const Pixel& pixel) {
  return pixel[0] + pixel[1] + pixel[2];
}

}  // namespace

namespace {

/// Number of covered pixels in the widest row.
double widestRow(const Image& image) {
  double widest = 0;
  for (int y = 0; y < image.height; ++y) {
    double row = 0;
    for (int x = 0; x < image.width; ++x) row += image.at(x, y)[3] / 255.0;
    widest = std::max(widest, row);
  }
  return widest;
}

}  // namespace

TEST_CASE("a sphere covers the area of its disc, a ball of voxels that of its columns",
          "[inspect][golden]") {
  RenderOptions options = small();
  options.samples = 4;
  const Image sphere = render(sphereSet(), options);
  const double width = widestRow(sphere);
  CHECK(width > 60);
  CHECK(coverage(sphere) == Approx(std::numbers::pi * width * width / 4).epsilon(0.01));

  int columns = 0;
  for (int x = -22; x <= 22; ++x)
    for (int z = -22; z <= 22; ++z) columns += x * x + z * z <= kRadius * kRadius;
  const Image voxels = render(ball(), options);
  const double voxel = widestRow(voxels) / (2 * kRadius + 1);
  CHECK(coverage(voxels) == Approx(columns * voxel * voxel).epsilon(0.01));
}

TEST_CASE("the lamp shines from the upper left", "[inspect]") {
  for (const Shading shading : {Shading::kCongradient, Shading::kNormals}) {
    CAPTURE(nameIn(kShadingNames, shading));
    RenderOptions options = small();
    options.shading.shading = shading;
    VisibleGrids visible = ball();
    visible.colors = nullptr;
    const Image image = render(visible, options);
    CHECK(brightness(image.at(38, 28)) > brightness(image.at(50, 40)));
    CHECK(brightness(image.at(50, 40)) > brightness(image.at(62, 52)));
    CHECK(brightness(image.at(62, 52)) > 0);
  }
}

TEST_CASE("flat shading gives each side of a block one brightness", "[inspect]") {
  auto mask = openvdb::MaskGrid::create();
  mask->fill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(9)), true);
  const auto visible = visibleGrids(std::vector<openvdb::GridBase::Ptr>{mask}, {});
  RenderOptions options = small();
  options.views = {*viewNamed("iso")};
  options.samples = 1;
  options.shading.shading = Shading::kFlat;
  std::set<int> levels;
  for (const Pixel& pixel : render(visible, options).pixels)
    if (pixel[3] != 0) levels.insert(brightness(pixel));
  CHECK(levels.size() == 3);
}

TEST_CASE("colours are those of the grid, seen from the right side", "[inspect]") {
  const Image front = render(ball(), small());
  const auto isRed = [](const Pixel& pixel) { return pixel[0] > pixel[2]; };
  CHECK(isRed(front.at(35, 40)));
  CHECK_FALSE(isRed(front.at(65, 40)));
  RenderOptions behind = small();
  behind.views = {*viewNamed("back")};
  CHECK_FALSE(isRed(render(ball(), behind).at(35, 40)));
}

TEST_CASE("the background has the chosen colour", "[inspect]") {
  RenderOptions options = small();
  CHECK(render(ball(), options).at(0, 0) == Pixel{0, 0, 0, 0});
  options.background = {10, 20, 30, 255};
  const Image image = render(ball(), options);
  CHECK(image.at(0, 0) == Pixel{10, 20, 30, 255});
  CHECK(image.at(50, 40)[3] == 255);
}

TEST_CASE("any number of threads gives the same picture", "[inspect][parallel]") {
  RenderOptions options = small();
  options.shading.shading = Shading::kCongradient;
  options.shading.occlusionRays = 3;
  options.projection = Projection::kPerspective;
  options.threads = 1;
  const Image one = render(ball(), options);
  options.threads = 8;
  CHECK(render(ball(), options).pixels == one.pixels);
}

TEST_CASE("a contact sheet is the pictures of its views, row by row", "[inspect]") {
  RenderOptions options = small();
  options.projection = Projection::kPerspective;  // each with a scale of its own
  options.views = parseViews("front,right,30,20");
  const Image sheet = render(ball(), options);
  REQUIRE(sheet.width == 200);
  REQUIRE(sheet.height == 160);
  for (std::size_t i = 0; i < options.views.size(); ++i) {
    RenderOptions single = options;
    single.views = {options.views[i]};
    const Image image = render(ball(), single);
    const int left = static_cast<int>(i % 2) * 100;
    const int top = static_cast<int>(i / 2) * 80;
    bool same = true;
    for (int y = 0; y < 80; ++y)
      for (int x = 0; x < 100; ++x) same = same && sheet.at(left + x, top + y) == image.at(x, y);
    CHECK(same);
  }
  CHECK(sheet.at(150, 120) == options.background);
}

TEST_CASE("the sky is dim in a pit", "[inspect]") {
  auto mask = openvdb::MaskGrid::create();
  mask->fill(openvdb::CoordBBox(openvdb::Coord(-40, -40, 0), openvdb::Coord(40, 40, 10)), true);
  mask->fill(openvdb::CoordBBox(openvdb::Coord(-4, -4, 2), openvdb::Coord(4, 4, 10)), false, false);
  const auto visible = visibleGrids(std::vector<openvdb::GridBase::Ptr>{mask}, {});
  RenderOptions options = small();
  options.views = {*viewNamed("top")};
  options.shading.shading = Shading::kFlat;
  const Image bright = render(visible, options);
  CHECK(brightness(bright.at(50, 40)) == brightness(bright.at(30, 40)));
  options.shading.occlusionRays = 8;
  const Image image = render(visible, options);
  CHECK(brightness(image.at(50, 40)) < brightness(image.at(30, 40)));
}

TEST_CASE("invalid options are refused, and a run can be cancelled", "[inspect][error]") {
  const auto with = [](auto change) {
    RenderOptions options = small();
    change(options);
    return options;
  };
  using Options = RenderOptions&;
  CHECK_THROWS_AS(requireRenderable(with([](Options o) { o.width = 0; })), UsageError);
  CHECK_THROWS_AS(requireRenderable(with([](Options o) { o.height = 20000; })), UsageError);
  CHECK_THROWS_AS(requireRenderable(with([](Options o) { o.views.clear(); })), UsageError);
  CHECK_THROWS_AS(requireRenderable(with([](Options o) { o.samples = 0; })), UsageError);
  CHECK_THROWS_AS(requireRenderable(with([](Options o) { o.shading.occlusionRays = -1; })),
                  UsageError);
  CHECK_THROWS_AS(render(ball(), with([](Options o) { o.maxMemory = 1000; })), LimitError);
  Progress progress;
  progress.cancel();
  CHECK_THROWS_AS(render(ball(), with([&](Options o) { o.progress = &progress; })), Cancelled);
}
