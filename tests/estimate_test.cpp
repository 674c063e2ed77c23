#include "libvox/pipeline/estimate.h"

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/convert.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

using namespace vox;
using Catch::Contains;

namespace {

std::vector<std::filesystem::path> sceneFiles() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(VOX_SCENES))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  return files;
}

double fileBytesOf(const Conversion& conversion) {
  std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
  writeGrids(stream, conversion);
  return static_cast<double>(stream.str().size());
}

void checkNear(double estimate, double truth) {
  CAPTURE(estimate, truth);
  CHECK(estimate <= kEstimateFactor * truth);
  CHECK(truth <= kEstimateFactor * estimate);
}

/// Compares an estimate with the conversion.
void checkEstimate(const Scene& scene, const ConvertOptions& options) {
  std::vector<std::string> warnings;
  const Estimate guess = estimate(scene, options, warnings);
  const Conversion made = convert(scene, options);
  CHECK(warnings == made.report.warnings);
  CHECK(guess.voxelSize == made.report.voxelSize);
  CHECK(guess.refusal.empty());
  double bytes = 0;
  REQUIRE(guess.grids.size() == made.grids.size());
  for (std::size_t i = 0; i < made.grids.size(); ++i) {
    const openvdb::GridBase& grid = *made.grids[i];
    CAPTURE(grid.getName());
    checkNear(guess.grids[i].voxels, static_cast<double>(grid.activeVoxelCount()));
    checkNear(guess.grids[i].leaves, grid.constBaseTree().leafCount());
    checkNear(guess.grids[i].bytes, static_cast<double>(grid.memUsage()));
    bytes += guess.grids[i].bytes;
  }
  CHECK(guess.bytes >= bytes * 0.999);
  checkNear(guess.fileBytes, fileBytesOf(made));
  if (guess.voxels == 0) return;
  checkNear(guess.voxels, static_cast<double>(made.report.activeVoxels));
  int levels = 0;
  for (const ObjectReport& object : made.report.objects) levels = std::max(levels, object.levels);
  checkNear(guess.levels, levels);
}

}  // namespace

TEST_CASE("estimates are within a factor of 1.5 for every scene", "[estimate]") {
  for (const auto& file : sceneFiles())
    for (const int dim : {64, 256}) {
      CAPTURE(file.filename().string(), dim);
      const Scene scene = readScene(file);
      ConvertOptions options;
      options.dim = dim;
      for (const GridKind kind : {GridKind::kMask, GridKind::kNormal}) {
        options.grids = std::vector{kind};
        checkEstimate(scene, options);
      }
      for (const Fill fill : {Fill::kSurface, Fill::kSolid}) {
        options.volume.fill = fill;
        for (const Edge edge : {Edge::kHard, Edge::kSoft}) {
          options.volume.edge = edge;
          options.grids = std::vector{GridKind::kDensity};
          checkEstimate(scene, options);
          options.grids = std::vector{GridKind::kDensity, GridKind::kNormal, GridKind::kColor};
          checkEstimate(scene, options);
        }
        options.volume = {};
      }
      if (dim > 64) continue;
      options.grids = std::vector{GridKind::kSurface};
      checkEstimate(scene, options);
    }
}

TEST_CASE("estimates cover solids, wide bands and polygons", "[estimate]") {
  for (const auto& mesh : {test::cube(), test::torusGrid(40, 20), test::prism(12)}) {
    Scene scene;
    scene.objects.push_back({"object", mesh});
    ConvertOptions options;
    options.dim = 150;
    options.volume.fill = Fill::kSolid;
    checkEstimate(scene, options);
    options.volume.band = 8;
    options.grids = std::vector{GridKind::kSurface};
    checkEstimate(scene, options);
    for (const BandWidths band : {BandWidths(2, 7), BandWidths(9, 1), BandWidths(1000, 3)}) {
      options.volume.band = band;
      checkEstimate(scene, options);
    }
    options.grids = std::vector{GridKind::kMask};
    for (const Separation separation : {Separation::k6, Separation::k26})
      for (const int levels : {0, 3}) {
        options.until = StopRule{levels};
        options.separation = separation;
        checkEstimate(scene, options);
      }
  }
}

TEST_CASE("an estimate of far too much is quick, and says what would fit", "[estimate][error]") {
  Scene scene;
  scene.objects.push_back({"cube", test::cube()});
  ConvertOptions options;
  options.dim = 100000;
  options.run.maxMemory = std::uint64_t{1} << 28;
  for (const GridKind kind : {GridKind::kDensity, GridKind::kSurface}) {
    options.grids = std::vector{kind};
    std::vector<std::string> warnings;
    const Estimate guess = estimate(scene, options, warnings);
    CHECK(guess.bytes > 1e12);
    CHECK_THAT(guess.refusal, Contains("the limit is 256.0 MiB") && Contains("--dim "));
    CHECK_THROWS_WITH(convert(scene, options), guess.refusal);
    const std::string key = "--dim ";
    ConvertOptions advised = options;
    advised.dim = std::stoi(guess.refusal.substr(guess.refusal.find(key) + key.size()));
    CHECK(*advised.dim > 100);
    CHECK_NOTHROW(convert(scene, advised));
  }
}
