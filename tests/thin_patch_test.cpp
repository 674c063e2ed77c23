#include "libvox/subdivide/thin_patch.h"

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/active_voxels.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/voxel.h"
#include "libvox/mesh/patch_parts.h"
#include "libvox/pipeline/surface.h"
#include "libvox/prepare/repair.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/patch_steps.h"
#include "libvox/subdivide/patch_strips.h"
#include "libvox/subdivide/stop.h"
#include "tests/repaired_level.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

using namespace vox;

namespace {

Vec3d vertexOf(const Patch& patch, std::int64_t i, std::int64_t j, std::int64_t n) {
  const CurvePoints row = rowOf(patch, {i, n});
  return PatchWeights(j, n)(row[0], row[1], row[2]);
}

/// The vertices of the walk around the strip between rows i and j.
std::vector<Vec3d> walkAround(const Patch& patch, std::int64_t i, std::int64_t j, std::int64_t n) {
  std::vector<Vec3d> walk;
  for (std::int64_t v = 0; v < n; ++v) walk.push_back(vertexOf(patch, i, v, n));
  for (std::int64_t u = i + 1; u < j; ++u) walk.push_back(vertexOf(patch, u, n - 1, n));
  for (std::int64_t v = n - 1; v >= 0; --v) walk.push_back(vertexOf(patch, j, v, n));
  for (std::int64_t u = j - 1; u > i; --u) walk.push_back(vertexOf(patch, u, 0, n));
  return walk;
}

/// Length (L-inf) of the longest side of the triangles that fill a polygon, for the best way to cut
/// it. Tries all ways, by dynamic programming.
double leastLongestSide(const std::vector<Vec3d>& polygon) {
  const std::size_t n = polygon.size();
  std::vector<double> best(n * n, 0.0);  // for the part from i to j, with the side from j to i
  const auto side = [&](std::size_t i, std::size_t j) {
    return (polygon[i] - polygon[j]).cwiseAbs().maxCoeff();
  };
  for (std::size_t i = 0; i + 1 < n; ++i) best[i * n + i + 1] = side(i, i + 1);
  for (std::size_t length = 2; length < n; ++length)
    for (std::size_t i = 0; i + length < n; ++i) {
      const std::size_t j = i + length;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = i + 1; k < j; ++k)
        least = std::min(least, std::max(best[i * n + k], best[k * n + j]));
      best[i * n + j] = std::max(least, side(i, j));
    }
  return best[n - 1];
}

/// Random patches around a line or a slightly bent curve. Lengths and widths in voxels.
struct RandomPatches {
  std::mt19937 random;
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  Vec3d direction() { return Vec3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized(); }

  /// Much longer than wide.
  Patch elongated(double length, double width) {
    const Vec3d along = length * direction();
    const Vec3d across = uniform(0, width) * direction();
    return make([&](double u, double v) { return Vec3d(u * across + v * along); }, 0.01 * length);
  }
  /// Rows and columns run nearly the same way.
  Patch sheared(double length, double width) {
    const Vec3d along = length * direction();
    const Vec3d across = uniform(0.2, 1) * along + uniform(0, width) * direction();
    return make([&](double u, double v) { return Vec3d(u * across + v * along); }, 0.01 * length);
  }
  /// Beside a long thin triangle: out along it, and back.
  Patch folded(double length, double width) {
    const Vec3d along = length * direction();
    const Vec3d bend = uniform(0, 2 * width) * direction();
    return make(
        [&](double u, double v) {
          const double s = std::max(u, v) - 0.8 * std::min(u, v);
          return Vec3d(s * along + s * s * bend);
        },
        0.002 * length);
  }

  /// Along a curve, with parameters that are a random quadratic function of u and v.
  Patch along(double length, double width) {
    const Vec3d line = length * direction();
    const Vec3d turn = uniform(0, 0.5) * length * direction();
    const double u1 = uniform(-1, 1), uu = uniform(-1, 1), vv = uniform(-0.5, 0.5);
    const double uv = uniform(-1, 1);
    return make(
        [&](double u, double v) {
          const double s = v + u1 * u + uu * u * u + uv * u * v + vv * v * v;
          return Vec3d(s * line + s * s * turn);
        },
        uniform(0, width));
  }
  /// Bent from row to row, along the rows, or both.
  Patch bent(double length, double width) {
    const Vec3d along = length * direction();
    const Vec3d turnV = uniform(0, 1) * length * direction();
    const Vec3d turnU = uniform(0, 1) * length * direction();
    const Vec3d twist = uniform(0, 1) * length * direction();
    const Vec3d across = uniform(-1, 1) * along + uniform(0, width) * direction();
    return make(
        [&](double u, double v) {
          return Vec3d(u * across + v * along + u * u * turnU + v * v * turnV + u * v * twist);
        },
        uniform(0, width));
  }
  /// Without any order, around a line.
  Patch crumpled(double length, double width) {
    const Vec3d along = length * direction();
    return make([&](double, double) { return Vec3d(uniform(-1, 1) * along); }, width);
  }
  /// One of these kinds, of length 1.
  Patch any(int which, double width) {
    switch (which) {
      case 0:
        return elongated(1, width);
      case 1:
        return sheared(1, width);
      case 2:
        return folded(1, width);
      case 3:
        return along(1, width);
      case 4:
        return bent(1, width);
      default:
        return crumpled(1, width);
    }
  }

  template <class Place>
  Patch make(Place&& place, double jitter) {
    Patch patch;
    for (int u = -1; u <= 1; ++u)
      for (int v = -1; v <= 1; ++v)
        patch.points[static_cast<std::size_t>(u + 1)][static_cast<std::size_t>(v + 1)] =
            place(u, v) + uniform(0, jitter) * direction();
    return patch;
  }
};

struct Tried {
  int thin = 0;
  int folded = 0;
  int strips = 0;
};

Patch scaled(Patch patch, double scale) {
  for (auto& row : patch.points)
    for (Vec3d& point : row) point *= scale;
  return patch;
}

openvdb::MaskGrid marked(const SubdivisionLevel& base, SurfaceReport& report) {
  ActiveVoxels grid;
  Progress unwatched;
  markSurface(base, {}, MemoryBudget(0), unwatched, grid, report);
  openvdb::MaskGrid mask;
  mask.setTree(grid.takeTree());
  return mask;
}

/// Whether a path of inactive voxels, face to face, leads from outside the box to `there`.
bool isReachedFromOutside(const openvdb::MaskGrid& mask, const openvdb::Coord& there) {
  openvdb::CoordBBox box = mask.evalActiveVoxelBoundingBox();
  box.expand(1);
  openvdb::MaskTree known(mask.tree());
  std::vector<openvdb::Coord> open = {box.min()};
  while (!open.empty()) {
    const openvdb::Coord voxel = open.back();
    open.pop_back();
    if (!box.isInside(voxel) || known.isValueOn(voxel)) continue;
    if (voxel == there) return true;
    known.setValueOn(voxel);
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        open.push_back(voxel);
        open.back()[axis] += step;
      }
  }
  return false;
}

}  // namespace

TEST_CASE("the walk around each strip of a thin patch can be filled with faces of a voxel",
          "[subdivide][property]") {
  RandomPatches patches{std::mt19937(7)};
  Tried tried;
  for (int trial = 0; trial < 120; ++trial) {
    const double length = patches.uniform(10, 50);
    const double width = 0.1 * length;
    const Patch patch = trial % 3 == 0   ? patches.elongated(length, width)
                        : trial % 3 == 1 ? patches.sheared(length, width)
                                         : patches.folded(length, width);
    const int levels = patchDepth(patch);
    const auto thin = thinPatch(patch, levels);
    if (!thin) continue;
    CAPTURE(trial, levels, thin->levels, thin->rows.size());
    ++tried.thin;
    tried.folded += trial % 3 == 2;
    const std::int64_t n = std::int64_t{1} << thin->levels;
    REQUIRE(thin->levels >= levels);
    REQUIRE(thin->rows.front() == 0);
    REQUIRE(thin->rows.back() == n - 1);
    CHECK(4 * (static_cast<std::int64_t>(thin->rows.size()) + 2) * n <= std::int64_t{1}
                                                                            << (2 * levels));
    for (std::size_t k = 0; k + 1 < thin->rows.size(); ++k) {
      const std::int64_t i = thin->rows[k];
      const std::int64_t j = thin->rows[k + 1];
      REQUIRE(i < j);
      CHECK(leastLongestSide(walkAround(thin->patch, i, j, n)) <= kVertexConversionSpan);
      ++tried.strips;
    }
  }
  CHECK(tried.thin > 60);
  CHECK(tried.folded > 15);
  CHECK(tried.strips > 2 * tried.thin);
}

TEST_CASE("a strip is called fillable only up to the size where it is", "[subdivide][property]") {
  RandomPatches patches{std::mt19937(8)};
  double nearest = 0;
  for (int trial = 0; trial < 12000; ++trial) {
    const double width = patches.uniform(0, 0.5);
    const Patch shape = patches.any(trial % 6, width);
    const int levels = 2 + trial % 3;
    const std::int64_t n = std::int64_t{1} << levels;
    auto i = static_cast<std::int64_t>(patches.uniform(0, static_cast<double>(n - 1)));
    auto j = static_cast<std::int64_t>(
        patches.uniform(static_cast<double>(i) + 1, static_cast<double>(n)));
    if (trial % 2 == 0) i = 0, j = n - 1;
    double yes = 0;
    double no = 1000;
    Patch largest;
    for (int step = 0; step < 40; ++step) {
      const double scale = (yes + no) / 2;
      const Patch patch = scaled(shape, scale);
      const bool fillable = PatchStrips(patch, levels).fillable(i, j);
      (fillable ? yes : no) = scale;
      if (fillable) largest = patch;
    }
    REQUIRE(yes > 0);
    const double side = leastLongestSide(walkAround(largest, i, j, n));
    CAPTURE(trial, levels, i, j, yes);
    CHECK(side <= kVertexConversionSpan + 1e-9);
    nearest = std::max(nearest, side);
  }
  CHECK(nearest > 0.99 * kVertexConversionSpan);  // the bounds are reached
}

TEST_CASE("strips that are not wide are called fillable, mostly", "[subdivide][property]") {
  RandomPatches patches{std::mt19937(8)};
  int yes = 0;
  int missed = 0;
  constexpr int kLevels = 5;
  constexpr std::int64_t kN = std::int64_t{1} << kLevels;
  for (int trial = 0; trial < 300; ++trial) {
    const double length = patches.uniform(8, 14);
    const double width = length / 2;
    const Patch patch =
        trial % 2 == 0 ? patches.sheared(length, width) : patches.folded(length, width);
    const auto i = static_cast<std::int64_t>(patches.uniform(0, kN - 1));
    const auto j = static_cast<std::int64_t>(patches.uniform(static_cast<double>(i) + 1, kN));
    if (PatchStrips(patch, kLevels).fillable(i, j))
      ++yes;
    else
      missed += leastLongestSide(walkAround(patch, i, j, kN)) <= kVertexConversionSpan;
  }
  CHECK(yes > 150);
  CHECK(missed < yes / 2);
}

TEST_CASE("a patch gives the same thin patch from all of its sides", "[subdivide][property]") {
  RandomPatches patches{std::mt19937(10)};
  int thin = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const double length = patches.uniform(20, 60);
    Patch patch = patches.any(trial % 6, 0.02);
    if (trial % 3 == 0)  // u and v alike
      for (std::size_t u = 0; u < 3; ++u)
        for (std::size_t v = 0; v < u; ++v) patch.points[u][v] = patch.points[v][u];
    patch = scaled(patch, length);
    const auto here = thinPatch(patch, patchDepth(patch));
    for (int turns = 1; turns < 4; ++turns) {
      patch = quarterTurn(patch);
      const auto there = thinPatch(patch, patchDepth(patch));
      REQUIRE(there.has_value() == here.has_value());
      if (!here) continue;
      ++thin;
      CHECK(there->patch.points == here->patch.points);
      CHECK(there->levels == here->levels);
      CHECK(there->rows == here->rows);
    }
  }
  CHECK(thin > 300);
}

TEST_CASE("a patch as wide as long, one of few levels and one at a free boundary are not thin",
          "[subdivide]") {
  const auto plane = [](double width, double length) {
    Patch patch;
    for (std::size_t u = 0; u < 3; ++u)
      for (std::size_t v = 0; v < 3; ++v)
        patch.points[u][v] =
            Vec3d(width * static_cast<double>(u), length * static_cast<double>(v), 0);
    return patch;
  };
  const auto isThin = [](const Patch& patch) {
    return thinPatch(patch, patchDepth(patch)).has_value();
  };
  CHECK_FALSE(isThin(plane(30, 30)));
  CHECK(isThin(plane(0.3, 30)));
  CHECK(isThin(plane(30, 0.3)));
  CHECK_FALSE(isThin(plane(0.03, 3)));
  Patch open = plane(0.3, 30);
  open.quadrants = 0xE;
  CHECK_FALSE(isThin(open));
}

TEST_CASE("a patch that turns back in part has fewer vertices if split, each part at its own depth",
          "[subdivide][property]") {
  RandomPatches patches{std::mt19937(9)};
  int split = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const double length = patches.uniform(100, 300);
    const Patch patch = patches.folded(length, 0.02 * length);
    const auto thin = thinPatch(patch, patchDepth(patch));
    if (!thin) continue;
    std::int64_t vertices = 0;
    int parts = 0;
    const auto requireFine = [](const Patch& part, int levels) {
      const PatchSteps steps(part);
      REQUIRE((steps.u + steps.v).maxCoeff() <= std::ldexp(kVertexConversionSpan, levels));
    };
    forEachPatchPart(
        PatchPart(patch), 1,
        [&](const ThinPatch& part, int) {
          requireFine(part.patch, part.levels);
          vertices += part.vertices();
          ++parts;
        },
        [&](const Patch& part, int levels, int level) {
          requireFine(part, levels);
          CHECK(level > 1);
          vertices += std::int64_t{1} << (2 * levels);
          ++parts;
        });
    CAPTURE(trial, parts, thin->vertices(), vertices);
    if (parts == 1) {
      CHECK(vertices == thin->vertices());
    } else {
      CHECK(parts % 3 == 1);  // each split replaces one part by four
      ++split;
    }
  }
  CHECK(split > 10);
}

TEST_CASE("the outermost vertices are enough for a patch without width", "[subdivide]") {
  Patch patch;
  for (std::size_t u = 0; u < 3; ++u)
    for (std::size_t v = 0; v < 3; ++v)
      patch.points[u][v] = Vec3d(0, 40 * static_cast<double>(v), 0);
  const auto thin = thinPatch(patch, patchDepth(patch));
  REQUIRE(thin);
  CHECK(thin->rows == std::vector<std::int64_t>{0, (1 << thin->levels) - 1});
}

TEST_CASE("no path of inactive voxels leads into a surface around faces of many sides",
          "[pipeline][subdivide][property]") {
  const struct {
    const char* name;
    PolygonMesh mesh;
    Vec3d inside;  ///< deep
  } cases[] = {{"prism", test::prism(150), Vec3d::Zero()},
               {"pyramid", test::pyramid(200), Vec3d(0, 0, 0.4)}};
  for (const auto& [name, mesh, inside] : cases)
    for (const double size : {41.0, 60.5, 77.3}) {
      CAPTURE(name, size);
      SurfaceReport report;
      openvdb::MaskGrid mask = marked(test::repairedLevel(mesh, size), report);
      const openvdb::Coord centre = voxelOf(size * inside);
      CHECK_FALSE(isReachedFromOutside(mask, centre));
      const int end = mask.evalActiveVoxelBoundingBox().max().x();
      for (int x = centre.x(); x <= end; ++x)
        mask.tree().setValueOff(openvdb::Coord(x, centre.y(), centre.z()));
      CHECK(isReachedFromOutside(mask, centre));
    }
}
