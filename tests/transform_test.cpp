#include "libvox/grid/transform.h"

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <limits>

using namespace vox;
using Catch::Contains;

TEST_CASE("dim voxels lie along the longest side of the box", "[grid][golden]") {
  Box box;
  box.add({0, 0, 0});
  box.add({1, 4, 2});
  CHECK(transformForDim(box, 256).voxelSize == 4.0 / 256);
}

TEST_CASE("only points that faces use count for the box", "[grid]") {
  PolygonMesh mesh = test::cube();
  mesh.points.emplace_back(1e6, 0, 0);
  CHECK(usedBox(mesh).longestSide() == 2);
}

TEST_CASE("index space is world space in voxels about the origin", "[grid]") {
  const GridTransform transform{0.25};
  CHECK(transform.toIndex({1, -2, 0.5}) == Vec3d(4, -8, 2));
}

TEST_CASE("impossible resolutions are refused", "[grid][error]") {
  Box box;
  box.add({0, 0, 0});
  CHECK_THROWS_WITH(transformForDim(box, 0), Contains("--dim"));
  CHECK_THROWS_WITH(transformForDim(box, 16), Contains("coincide") && Contains("--voxel-size"));
  for (const double size : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    CHECK_THROWS_AS(transformForVoxelSize(size), UsageError);
  for (const double size : {1e-300, 1e-5, 1e19, 1e300})
    CHECK_THROWS_AS(transformForVoxelSize(size), LimitError);
}

TEST_CASE("coordinates beyond 2^30 voxels are refused with a voxel size that works",
          "[grid][error]") {
  Box box;
  box.add({1e6, 0, 0});
  CHECK_NOTHROW(requireInRange(box, {1e-3}));
  CHECK_THROWS_AS(requireInRange(box, {1e-4}), LimitError);
  CHECK_THROWS_WITH(requireInRange(box, {1e-4}), Contains("at least 0.0009"));
  CHECK_NOTHROW(requireInRange(box, {0.000933}));
}

TEST_CASE("OpenVDB accepts every voxel size in range", "[grid]") {
  for (const double size : {kMinVoxelSize, 1.0, kMaxVoxelSize}) {
    CAPTURE(size);
    CHECK_NOTHROW(transformForVoxelSize(size));
    CHECK_NOTHROW(openvdb::math::Transform::createLinearTransform(size));
  }
}
