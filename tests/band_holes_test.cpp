// Holes of bands, made by taking voxels out of whole ones.

#include "libvox/foot/band_holes.h"

#include "libvox/foot/exposed_band.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/convert.h"
#include "libvox/volume/fill.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace vox;
using openvdb::Coord;

namespace {

constexpr double kVoxelSize = 0.05;

openvdb::FloatTree::Ptr bandOf(const PolygonMesh& mesh) {
  ConvertOptions options;
  options.voxelSize = kVoxelSize;
  options.grids = std::vector{GridKind::kSurface};
  const Conversion made = convert(test::oneObject(mesh), options);
  return openvdb::gridPtrCast<openvdb::FloatGrid>(made.grids.at(0))->treePtr();
}

/// A band without the voxels of some columns along z, and the number of voxels taken out.
openvdb::FloatTree::Ptr withoutColumns(const openvdb::FloatTree& band, int side, int apart) {
  auto holed = std::make_shared<openvdb::FloatTree>(band);
  for (auto value = band.cbeginValueOn(); value; ++value) {
    const Coord at = value.getCoord();
    const auto isOut = [&](int i) { return ((i % apart) + apart) % apart < side; };
    if (isOut(at.x()) && isOut(at.y())) holed->setValueOff(at, band.background());
  }
  return holed;
}

bool encloses(const openvdb::FloatTree& band, const Coord& voxel) {
  return filled(*wallsOf(band, kVoxelSize), nullptr)->isValueOn(voxel);
}

}  // namespace

TEST_CASE("a band with holes encloses what it enclosed before, once they are closed",
          "[level-set][band-holes]") {
  openvdb::initialize();
  const BandOptions options{3, 3, kVoxelSize};
  const int side = GENERATE(1, 2, 3);
  for (const PolygonMesh& mesh : {test::cube(), test::dodecahedron()}) {
    const openvdb::FloatTree::Ptr whole = bandOf(mesh);
    const openvdb::FloatTree::Ptr holed = withoutColumns(*whole, side, 17);
    const Coord middle(0, 0, 0);
    REQUIRE(encloses(*whole, middle));
    REQUIRE_FALSE(encloses(*holed, middle));
    CHECK(closeHoles(*holed, options) > 0);
    CHECK(encloses(*holed, middle));

    std::vector<double> off;  // voxels
    for (auto value = whole->cbeginValueOn(); value; ++value)
      if (std::abs(*value) < 1.8 * kVoxelSize) {
        REQUIRE(holed->isValueOn(value.getCoord()));
        off.push_back(std::abs(holed->getValue(value.getCoord()) - *value) / kVoxelSize);
      }
    CHECK(*std::max_element(off.begin(), off.end()) < 0.2 * side);
    for (auto value = holed->cbeginValueOn(); value; ++value)
      REQUIRE(whole->isValueOn(value.getCoord()));
  }
}

TEST_CASE("bands without holes keep their bits", "[level-set][band-holes]") {
  openvdb::initialize();
  for (const PolygonMesh& mesh : {test::cube(), test::dodecahedron(), test::prism(12)})
    CHECK(closeHoles(*bandOf(mesh), {3, 3, kVoxelSize}) == 0);
}
