#include "libvox/voxelize/scan.h"

#include "libvox/core/error.h"
#include "tests/scan_reference.h"

#define HWY_IS_TEST  // compiles all targets, also the one without vectors
#include <catch2/catch.hpp>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace vox;
using test::Corners;
using test::Voxel;

namespace {

constexpr std::array kBoth = {Separation::k6, Separation::k26};

std::vector<Voxel> scanned(const Corners& corners, Separation separation) {
  std::vector<Voxel> voxels;
  scanTriangle(std::span<const Vec3d, 3>(corners), separation, [&](const VoxelBlock& block) {
    forEachVoxel(block, [&](int x, int y, int z) { voxels.push_back({x, y, z}); });
  });
  std::sort(voxels.begin(), voxels.end());
  return voxels;
}

/// The voxels of each triangle, scanned in one call.
std::vector<std::vector<Voxel>> scannedTogether(const std::vector<Corners>& soup,
                                                Separation separation) {
  std::vector<Vec3d> points;
  std::vector<std::array<Index, 3>> triangles;
  for (const Corners& corners : soup) {
    const auto first = static_cast<Index>(points.size());
    points.insert(points.end(), corners.begin(), corners.end());
    triangles.push_back({first, first + 1, first + 2});
  }
  std::vector<std::vector<Voxel>> voxels(soup.size());
  scanTriangles(points, triangles, separation, [&](const VoxelBlock& block) {
    forEachVoxel(block, [&](int x, int y, int z) { voxels[block.triangle].push_back({x, y, z}); });
  });
  for (auto& list : voxels) std::sort(list.begin(), list.end());
  return voxels;
}

/// Triangles of all kinds within `reach` voxels of a point: on coarse and fine lattices (centres,
/// faces and corners of voxels among them), in coordinate planes, slivers, segments and points.
class RandomTriangles {
 public:
  explicit RandomTriangles(std::uint32_t seed) : random_(seed) {}

  Corners operator()(double reach) {
    const Vec3d centre(uniform(1), uniform(1), uniform(1));
    Corners corners;
    for (Vec3d& corner : corners)
      corner = centre + Vec3d(uniform(reach), uniform(reach), uniform(reach));
    if (pick(2) == 0) {
      const double lattice = std::array{1.0, 0.5, 0.25, 1.0 / 16, kScanLattice}[pick(5)];
      for (Vec3d& corner : corners) corner = (corner / lattice).array().round() * lattice;
    }
    if (pick(4) == 0) {
      const auto axis = static_cast<int>(pick(3));
      corners[1][axis] = corners[2][axis] = corners[0][axis];
    }
    switch (pick(10)) {
      case 0:
        corners[2] = corners[0] + (corners[1] - corners[0]) * static_cast<double>(pick(5)) / 4;
        break;
      case 1:
        corners[2] = corners[0] + (corners[1] - corners[0]) * uniform(1) +
                     0.01 * Vec3d(uniform(1), uniform(1), uniform(1));
        break;
      case 2:
        corners[2] = corners[pick(2)];
        break;
      case 3:
        if (pick(4) == 0) corners[1] = corners[2] = corners[0];
        break;
      default:
        break;
    }
    std::shuffle(corners.begin(), corners.end(), random_);
    return corners;
  }

  double uniform(double reach) {
    return std::uniform_real_distribution<double>(-reach, reach)(random_);
  }
  std::size_t pick(std::size_t count) { return random_() % count; }

 private:
  std::mt19937_64 random_;
};

std::string described(const Corners& corners) {
  std::string text;
  for (const Vec3d& corner : corners)
    for (int axis = 0; axis < 3; ++axis) {
      std::array<char, 32> number{};
      std::snprintf(number.data(), number.size(), "%.17g ", corner[axis]);
      text += number.data();
    }
  return text;
}

}  // namespace

TEST_CASE("the brute-force reference agrees with clipping in rational numbers",
          "[voxelize][reference]") {
  RandomTriangles next(1);
  std::size_t active = 0;
  for (int i = 0; i < 1500; ++i) {
    const Corners corners = next(1.5);
    const auto voxels = test::naiveScan(corners);
    for (const Separation separation : kBoth) {
      const auto& list = voxels[static_cast<std::size_t>(separation)];
      for (int k = 0; k < 6; ++k) {
        Voxel voxel;
        for (int axis = 0; axis < 3; ++axis)
          voxel[axis] = static_cast<int>(std::lround(corners[k % 3][axis] + next.uniform(0.8)));
        const auto targets = test::targetWidths(separation);
        const bool met =
            std::any_of(targets.begin(), targets.end(), [&](const std::array<int, 3>& widths) {
              return test::clipMeets(corners, voxel, widths);
            });
        active += met;
        if (met != std::binary_search(list.begin(), list.end(), voxel))
          FAIL(described(corners) << "at " << voxel[0] << ' ' << voxel[1] << ' ' << voxel[2]);
      }
    }
  }
  CHECK(active > 4000);
}

TEST_CASE("a million random triangles have exactly the voxels of the brute-force reference",
          "[voxelize][property]") {
  struct Batch {
    int triangles;
    double reach;
  };
  const Batch batch = GENERATE(Batch{800000, 0.6}, Batch{150000, 1.2}, Batch{45000, 2.5},
                               Batch{4700, 8}, Batch{270, 30}, Batch{30, 100});
  CAPTURE(batch.triangles, batch.reach);
  RandomTriangles next(static_cast<std::uint32_t>(batch.triangles));
  std::vector<Corners> soup;
  for (int i = 0; i < batch.triangles; ++i) soup.push_back(next(batch.reach));

  const std::array together = {scannedTogether(soup, Separation::k6),
                               scannedTogether(soup, Separation::k26)};
  for (std::size_t i = 0; i < soup.size(); ++i) {
    const auto expected = test::naiveScan(soup[i]);
    for (const Separation separation : kBoth) {
      const auto s = static_cast<std::size_t>(separation);
      if (together[s][i] != expected[s]) FAIL("together: " << s << ", " << described(soup[i]));
      if (batch.reach < 1 && i % 8 != 0) continue;  // those are mainly for the vector kernel
      if (scanned(soup[i], separation) != expected[s])
        FAIL("alone: " << s << ", " << described(soup[i]));
    }
  }
}

TEST_CASE("every vector unit gives the voxels of plain code", "[voxelize][property]") {
  RandomTriangles next(3);
  std::vector<Corners> soup;
  for (int i = 0; i < 20000; ++i) soup.push_back(next(1 + i % 8));
  for (const Separation separation : kBoth) {
    std::vector<std::vector<Voxel>> alone;
    for (const Corners& corners : soup) alone.push_back(scanned(corners, separation));
    std::size_t units = 0;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      CAPTURE(hwy::TargetName(target));
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      const bool same = scannedTogether(soup, separation) == alone;  // too long to print
      CHECK(same);
      ++units;
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    CHECK(units >= 1);
  }
}

TEST_CASE("triangles hundreds and thousands of voxels long are as exact as small ones",
          "[voxelize][property]") {
  // Slivers: many rows and tiles, few voxels. From 512 voxels on, 128 bits are needed.
  RandomTriangles next(4);
  for (const double length : {300.0, 500.0, 515.0, 1500.0})
    for (int i = 0; i < 6; ++i) {
      Corners corners = next(length);
      corners[2] = corners[0] + 0.3 * (corners[1] - corners[0]) +
                   Vec3d(next.uniform(2), next.uniform(2), next.uniform(2));
      const auto expected = test::naiveScan(corners);
      CAPTURE(described(corners));
      for (const Separation separation : kBoth) {
        const bool same =
            scanned(corners, separation) == expected[static_cast<std::size_t>(separation)];
        CHECK(same);
      }
    }
}

TEST_CASE("a segment of millions of voxels along an axis has one voxel per step",
          "[voxelize][golden]") {
  const double length = 1 << 20;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d a(0.1, 0.2, -0.3);
    Vec3d b = a;
    a[axis] = -length;
    b[axis] = length;
    for (const Separation separation : kBoth) {
      // With k6, only a segment on a line through centres meets the segments of voxels.
      const bool onLine = separation == Separation::k6;
      const Corners corners = onLine
                                  ? Corners{a.array().round(), b.array().round(), a.array().round()}
                                  : Corners{a, b, a};
      std::size_t voxels = 0;
      scanTriangle(std::span<const Vec3d, 3>(corners), separation, [&](const VoxelBlock& block) {
        voxels += static_cast<std::size_t>(std::popcount(block.voxels));
      });
      CHECK(voxels == 2 * static_cast<std::size_t>(length) + 1);
    }
  }
}

TEST_CASE("far from the origin the voxels are the same, shifted", "[voxelize][property]") {
  RandomTriangles next(5);
  const std::array<int, 3> shift = {(1 << 30) - 200, 200 - (1 << 30), 1 << 29};
  for (int i = 0; i < 2000; ++i) {
    Corners here = next(i % 20 == 0 ? 30 : 3);
    for (Vec3d& corner : here) corner = (corner / kScanLattice).array().round() * kScanLattice;
    Corners there = here;
    for (Vec3d& corner : there) corner += Vec3d(shift[0], shift[1], shift[2]);
    for (const Separation separation : kBoth) {
      auto expected = scanned(here, separation);
      for (Voxel& voxel : expected)
        for (std::size_t axis = 0; axis < 3; ++axis) voxel[axis] += shift[axis];
      REQUIRE(scanned(there, separation) == expected);
      REQUIRE(scannedTogether({there}, separation)[0] == expected);
    }
  }
}

TEST_CASE("touching counts", "[voxelize][golden]") {
  const auto point = [](double x, double y, double z) {
    return Corners{Vec3d(x, y, z), Vec3d(x, y, z), Vec3d(x, y, z)};
  };
  const auto count = [](const Corners& corners, Separation separation) {
    return scanned(corners, separation).size();
  };
  // Points at the centre, a face, an edge and a corner of a voxel, and within it.
  CHECK(count(point(0, 0, 0), Separation::k26) == 1);
  CHECK(count(point(0.5, 0, 0), Separation::k26) == 2);
  CHECK(count(point(0.5, 0, 0.5), Separation::k26) == 4);
  CHECK(count(point(0.5, 0.5, 0.5), Separation::k26) == 8);
  CHECK(count(point(0.4, 0.1, 0.3), Separation::k26) == 1);
  CHECK(count(point(0, 0, 0), Separation::k6) == 1);
  CHECK(count(point(0.5, 0, 0), Separation::k6) == 2);
  CHECK(count(point(0.5, 0, 0.5), Separation::k6) == 0);
  CHECK(count(point(0.4, 0.1, 0.3), Separation::k6) == 0);
  // A triangle in the plane between two layers of voxels activates both.
  const Corners between = {Vec3d(0, 0, 0.5), Vec3d(4, 0, 0.5), Vec3d(0, 4, 0.5)};
  CHECK(count(between, Separation::k6) == 2 * 15);
  CHECK(count(between, Separation::k26) == 2 * 19);
  // In a plane through centres, it activates one layer.
  const Corners through = {Vec3d(0, 0, 2), Vec3d(4, 0, 2), Vec3d(0, 4, 2)};
  CHECK(count(through, Separation::k6) == 15);
  CHECK(count(through, Separation::k26) == 19);
}

TEST_CASE("corners are scanned at the nearest lattice point, wherever they are listed",
          "[voxelize][property]") {
  RandomTriangles next(6);
  for (int i = 0; i < 3000; ++i) {
    Corners corners = next(2);
    for (Vec3d& corner : corners) corner = (corner / kScanLattice).array().round() * kScanLattice;
    for (const Separation separation : kBoth) {
      const auto expected = scanned(corners, separation);
      Corners moved = corners;
      for (Vec3d& corner : moved)
        corner += 0.49 * kScanLattice * Vec3d(next.uniform(1), next.uniform(1), next.uniform(1));
      std::rotate(moved.begin(), moved.begin() + 1 + i % 2, moved.end());
      if (i % 3 == 0) std::swap(moved[0], moved[2]);
      REQUIRE(scanned(moved, separation) == expected);
      REQUIRE(scannedTogether({moved}, separation)[0] == expected);
    }
  }
}

TEST_CASE("coordinates out of range, nan and triangles too long are refused", "[voxelize][error]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const double most = 1 << 30;
  for (const double bad : {nan, infinity, -infinity, 1e300, -most - 1}) {
    const Corners corners = {Vec3d(0, 0, 0), Vec3d(0, bad, 0), Vec3d(1, 1, 1)};
    CHECK_THROWS_AS(scanned(corners, Separation::k6), LimitError);
    const Corners tiny = {Vec3d(0, 0, 0), Vec3d(0, 1, 0), Vec3d(1, 1, 1)};
    CHECK_THROWS_WITH(scannedTogether({tiny, tiny, corners}, Separation::k26),
                      Catch::Contains("triangle 2"));
  }
  const Corners longest = {Vec3d(-most, 0, 0), Vec3d(most, 0, 0), Vec3d(0, 0, 0)};
  CHECK_THROWS_WITH(scanned(longest, Separation::k26), Catch::Contains("longer"));
}

TEST_CASE("the parts of a large triangle are its voxels, each once", "[voxelize][property]") {
  std::mt19937 random(29);
  std::uniform_real_distribution<double> at(-700, 700);
  int several = 0;
  for (const Separation separation : {Separation::k6, Separation::k26})
    for (int i = 0; i < 6; ++i) {
      std::array<Vec3d, 3> corners;
      for (Vec3d& p : corners)
        p = Vec3d(at(random), at(random), i % 2 == 0 ? 0.01 * at(random) : at(random));
      using Key = std::array<int, 3>;
      std::vector<Key> whole;
      std::vector<Key> parts;
      const auto into = [](std::vector<Key>& voxels) {
        return [&voxels](const VoxelBlock& block) {
          forEachVoxel(block, [&](int x, int y, int z) { voxels.push_back({x, y, z}); });
        };
      };
      scanTriangle(corners, separation, into(whole));
      several += scanPartCount(corners) > 1;
      for (std::int64_t part = 0; part < scanPartCount(corners); ++part)
        scanTrianglePart(corners, part, separation, into(parts));
      std::sort(whole.begin(), whole.end());
      std::sort(parts.begin(), parts.end());
      CHECK(whole == parts);
    }
  CHECK(several > 6);
}
