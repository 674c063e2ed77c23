#include "libvox/volume/density.h"

#include "libvox/grid/openvdb.h"

#include <catch2/catch.hpp>

TEST_CASE("density is 1 at the voxels of the mask and 0 elsewhere", "[volume]") {
  openvdb::MaskTree mask;
  mask.setValueOn({1, 2, 3});
  mask.setValueOn({-100, 0, 7});

  const auto density = vox::densityGrid(mask);

  CHECK(density->getName() == "density");
  CHECK(density->getGridClass() == openvdb::GRID_FOG_VOLUME);
  CHECK(density->background() == 0);
  CHECK(density->activeVoxelCount() == 2);
  CHECK(density->tree().getValue({1, 2, 3}) == 1);
  CHECK(density->tree().getValue({-100, 0, 7}) == 1);
  CHECK(density->tree().getValue({1, 2, 4}) == 0);
}
