#include "libvox/voxelize/normal_sampler.h"

#include "libvox/grid/voxel.h"
#include "libvox/mesh/patch_parts.h"
#include "libvox/voxelize/normal_tile.h"

#include <catch2/catch.hpp>
#include <hwy/targets.h>

#include <map>
#include <random>
#include <tuple>
#include <vector>

using namespace vox;
using openvdb::Coord;

namespace {

/// A bent patch some voxels wide, whose rows and columns are nearly even.
Patch bentPatch(std::mt19937_64& random, double width) {
  std::uniform_real_distribution<double> some(-1, 1);
  const Vec3d origin(900 * some(random), 900 * some(random), 900 * some(random));
  const Vec3d alongU = Vec3d(some(random), some(random), some(random)).normalized() * width;
  const Vec3d side(some(random), some(random), some(random));
  const Vec3d alongV = alongU.cross(side).normalized() * width;
  Patch patch;
  for (std::size_t u = 0; u < 3; ++u)
    for (std::size_t v = 0; v < 3; ++v)
      patch.points[u][v] = origin + static_cast<double>(u) * alongU +
                           static_cast<double>(v) * alongV +
                           0.2 * width * Vec3d(some(random), some(random), some(random));
  return patch;
}

/// The uniform biquadratic B-spline of a patch.
Vec3d splineAt(const Patch& patch, double u, double v) {
  const auto along = [](double t, const Vec3d& a, const Vec3d& b, const Vec3d& c) -> Vec3d {
    return ((1 - t) * (1 - t) * a + (1 + 2 * t - 2 * t * t) * b + t * t * c) / 2;
  };
  const auto& p = patch.points;
  return along(u, along(v, p[0][0], p[0][1], p[0][2]), along(v, p[1][0], p[1][1], p[1][2]),
               along(v, p[2][0], p[2][1], p[2][2]));
}

Vec3d normalByDifferences(const Patch& patch, double u, double v) {
  constexpr double kStep = 1e-5;
  const Vec3d alongU = splineAt(patch, u + kStep, v) - splineAt(patch, u - kStep, v);
  const Vec3d alongV = splineAt(patch, u, v + kStep) - splineAt(patch, u, v - kStep);
  return alongU.cross(alongV).normalized();
}

/// Distance of a position from the next voxel.
double distanceFromTie(const Vec3d& position) {
  const Vec3d shifted = position + Vec3d::Constant(0.5);
  return (shifted.array() - shifted.array().round()).abs().minCoeff();
}

struct Expected {
  Vec3d sum = Vec3d::Zero();
  std::int64_t count = 0;
  bool nearTie = false;
};
using ExpectedSums = std::map<std::tuple<int, int, int>, Expected>;

ExpectedSums expectedSums(const Patch& patch, int rows, int columns) {
  ExpectedSums sums;
  const std::int64_t m = std::int64_t{1} << rows;
  const std::int64_t n = std::int64_t{1} << columns;
  for (std::int64_t i = 0; i < m; ++i)
    for (std::int64_t j = 0; j < n; ++j) {
      const CurvePoints row = rowOf(patch, {i, m});
      const Vec3d position = PatchWeights(j, n)(row[0], row[1], row[2]);
      const Coord voxel = voxelOf(position);
      Expected& expected = sums[{voxel.x(), voxel.y(), voxel.z()}];
      expected.sum +=
          normalByDifferences(patch, (static_cast<double>(i) + 0.5) / static_cast<double>(m),
                              (static_cast<double>(j) + 0.5) / static_cast<double>(n));
      ++expected.count;
      if (distanceFromTie(position) < 1e-4)
        for (int k = 0; k < 27; ++k) {
          const Coord near = voxel.offsetBy(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1);
          sums[{near.x(), near.y(), near.z()}].nearTie = true;
        }
    }
  return sums;
}

openvdb::MaskTree::Ptr voxelsOf(const ExpectedSums& sums) {
  auto voxels = std::make_shared<openvdb::MaskTree>();
  for (const auto& [at, expected] : sums)
    voxels->setValueOn(Coord(std::get<0>(at), std::get<1>(at), std::get<2>(at)));
  return voxels;
}

VoxelMeans::Sum sumAt(const VoxelMeans& means, const openvdb::MaskTree& voxels, const Coord& at) {
  const auto* leaf = voxels.probeConstLeaf(at);
  const VoxelMeans::Sum* sum = means.sumsOf(leaf->origin());
  for (auto voxel = leaf->cbeginValueOn(); voxel.getCoord() != at; ++voxel) ++sum;
  return *sum;
}

void checkAgainstDifferences(const Patch& patch, int rows, int columns) {
  const ExpectedSums expected = expectedSums(patch, rows, columns);
  const auto voxels = voxelsOf(expected);
  VoxelMeans means(*voxels);
  NormalSampler(means).patch(patch, rows, columns);
  std::int64_t count = 0;
  const double one = std::ldexp(1.0, VoxelMeans::kFractionBits);
  for (const auto& [at, e] : expected) {
    const auto [x, y, z] = at;
    const VoxelMeans::Sum sum = sumAt(means, *voxels, Coord(x, y, z));
    count += sum.count;
    if (e.nearTie) continue;
    CAPTURE(x, y, z);
    REQUIRE(sum.count == e.count);
    const Vec3d got =
        Vec3d(static_cast<double>(sum.x), static_cast<double>(sum.y), static_cast<double>(sum.z)) /
        one;
    // Single precision (1e-5 with what cancels) and the 18 bits of a sample, with room.
    REQUIRE((got - e.sum).norm() < 2e-5 * static_cast<double>(e.count));
  }
  CHECK(count == std::int64_t{1} << (rows + columns));
}

}  // namespace

TEST_CASE("every vertex gives its voxel the normal of the limit surface", "[normals][property]") {
  std::mt19937_64 random(1);
  for (const auto& [rows, columns] : {std::pair(0, 0),
                                      {1, 2},
                                      {2, 2},
                                      {3, 3},
                                      {0, 3},
                                      {3, 0},
                                      {2, 5},
                                      {6, 6},
                                      {4, 6},
                                      {7, 7},
                                      {1, 8},
                                      {9, 2}})
    for (int trial = 0; trial < 4; ++trial) {
      CAPTURE(rows, columns, trial);
      checkAgainstDifferences(bentPatch(random, 0.7 * (1 << std::min(rows, columns))), rows,
                              columns);
    }
}

TEST_CASE("a patch that is turned or halved has the same vertices and the same outside",
          "[normals][property]") {
  std::mt19937_64 random(2);
  const Patch patch = bentPatch(random, 10);
  const Patch turned = quarterTurn(patch);
  const auto halves = halvesAlongU(patch);
  for (const double u : {0.0, 0.25, 1.0})
    for (const double v : {0.0, 0.5, 0.75}) {
      const Vec3d at = splineAt(patch, u, v);
      CHECK((splineAt(turned, 1 - v, u) - at).norm() < 1e-10);
      CHECK((normalByDifferences(turned, 1 - v, u) - normalByDifferences(patch, u, v)).norm() <
            1e-8);
      CHECK((splineAt(halves[0], u, v) - splineAt(patch, u / 2, v)).norm() < 1e-10);
      CHECK((splineAt(halves[1], u, v) - splineAt(patch, (1 + u) / 2, v)).norm() < 1e-10);
    }
}

TEST_CASE("tiles of normals have the same bits on every instruction set", "[normals][simd]") {
  std::mt19937_64 random(3);
  const Patch patch = bentPatch(random, 20);
  std::vector<std::uint8_t> marks;
  std::vector<VoxelMeans::BrickSum> sums;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    CAPTURE(hwy::TargetName(target));
    hwy::GetChosenTarget().Update(target);
    std::vector<std::uint8_t> theseMarks(MarkBrick::kMarks);
    std::vector<VoxelMeans::BrickSum> these(MarkBrick::kMarks);
    addNormalTile(patch, 5, 5, theseMarks.data(), these.data());
    std::int64_t count = 0;
    for (const auto& sum : these) count += sum.count;
    CHECK(count == 1024);
    if (sums.empty()) {
      marks = theseMarks;
      sums = these;
      continue;
    }
    CHECK(marks == theseMarks);
    const bool same = std::equal(sums.begin(), sums.end(), these.begin(), [](auto& a, auto& b) {
      return std::tie(a.x, a.y, a.z, a.count) == std::tie(b.x, b.y, b.z, b.count);
    });
    CHECK(same);
  }
  hwy::GetChosenTarget().DeInit();
}

TEST_CASE("samples outside active voxels are ignored", "[normals]") {
  openvdb::MaskTree voxels;
  voxels.setValueOn(Coord(7, 9, 3));
  VoxelMeans means(voxels);
  NormalSampler sampler(means);
  Patch patch;  // flat; its vertices lie between 4 and 12
  for (std::size_t u = 0; u < 3; ++u)
    for (std::size_t v = 0; v < 3; ++v)
      patch.points[u][v] = Vec3d(8.0 * static_cast<double>(u), 8.0 * static_cast<double>(v), 3);
  sampler.patch(patch, 4, 4);
  sampler.patch(patch, 4, 4);
  sampler.point({100, 0, 0}, Vec3d::UnitX());
  sampler.point({7, 9, 3}, Vec3d::Zero());
  CHECK(means.sumsOf(Coord(96, 0, 0)) == nullptr);
  CHECK_FALSE(means.meanOf(Coord(100, 0, 0)).has_value());
  const auto mean = means.meanOf(Coord(7, 9, 3));
  REQUIRE(mean.has_value());
  CHECK((*mean - Vec3d::UnitZ()).norm() < 1e-5);
}
