#include "libvox/pipeline/surface.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/active_voxels.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/voxel.h"
#include "libvox/prepare/repair.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/global_surface.h"
#include "tests/repaired_level.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>

using namespace vox;
using Catch::Contains;

namespace {

struct Marked {
  openvdb::MaskTree::Ptr tree;
  SurfaceReport report;
};

Marked mark(const SubdivisionLevel& base, const SurfaceOptions& options, Progress& progress) {
  ActiveVoxels grid;
  Marked marked;
  markSurface(base, options, MemoryBudget(std::uint64_t{1} << 34), progress, grid, marked.report);
  marked.tree = grid.takeTree();
  return marked;
}

Marked mark(const SubdivisionLevel& base, const SurfaceOptions& options) {
  Progress unwatched;
  return mark(base, options, unwatched);
}

/// Collects the voxels near vertices that are almost tied: within a distance of more than one
/// voxel.
class NearTies : public SurfaceSink {
 public:
  openvdb::MaskTree voxels;

  void points(std::span<const Vec3d> points, int) override {
    for (const Vec3d& p : points) add(p);
  }
  void curve(const CurvePoints& points, int k, int) override {
    const std::int64_t n = std::int64_t{1} << k;
    for (std::int64_t j = 0; j < n; ++j) add(PatchWeights(j, n)(points[0], points[1], points[2]));
  }
  void patch(const Patch&, int, int) override { FAIL("the whole mesh gives no patches"); }

 private:
  void add(const Vec3d& p) {
    constexpr double kDistance = 1e-4;
    const openvdb::Coord low = voxelOf(p - Vec3d::Constant(kDistance));
    const openvdb::Coord high = voxelOf(p + Vec3d::Constant(kDistance));
    if (low != high) voxels.fill(openvdb::CoordBBox(low, high), true);
  }
};

/// Number of voxels of `a` that are not in `b`. Checks that each of them is in `excuses`.
std::size_t differences(const openvdb::MaskTree& a, const openvdb::MaskTree& b,
                        const openvdb::MaskTree& excuses) {
  std::size_t count = 0;
  for (auto voxel = a.cbeginValueOn(); voxel; ++voxel) {
    if (b.isValueOn(voxel.getCoord())) continue;
    ++count;
    if (!excuses.isValueOn(voxel.getCoord())) FAIL("differs away from any tie");
  }
  return count;
}

/// A cube whose patches are split into tasks.
SubdivisionLevel largeCube() {
  return test::repairedLevel(test::cube(), 600);
}

}  // namespace

TEST_CASE("the voxels do not depend on how a surface is cut into submeshes",
          "[pipeline][localize][property]") {
  for (const auto* shapes : {&test::shapes(), &test::openShapes()})
    for (const auto& shape : *shapes) {
      CAPTURE(shape.name);
      const SubdivisionLevel base = test::repairedLevel(shape.mesh, 17);
      const Marked plain = mark(base, {});
      for (const auto localize : {Localize::kBefore, Localize::kDuring})
        for (const Index faces : {1U, 7U, 1000U}) {
          const Marked other = mark(base, {localize, faces});
          CHECK(other.tree->hasSameTopology(*plain.tree));
          CHECK(other.report.vertices == plain.report.vertices);
        }
    }
}

TEST_CASE("the voxels of large patches depend neither on tasks nor on submeshes nor on threads",
          "[pipeline][localize][parallel]") {
  const SubdivisionLevel base = largeCube();
  const Marked plain = mark(base, {});
  CHECK(plain.tree->activeVoxelCount() > 5000000);
  for (const auto localize : {Localize::kBefore, Localize::kDuring})
    for (const auto& [faces, threads] : {std::pair(1U, 8), std::pair(7U, 1), std::pair(1000U, 2)}) {
      const Marked other = onThreads(threads, [&] { return mark(base, {localize, faces}); });
      CHECK(other.tree->hasSameTopology(*plain.tree));
      CHECK(other.report.vertices == plain.report.vertices);
    }
}

TEST_CASE("the whole mesh level by level has the voxels of its submeshes, but for rounding ties",
          "[pipeline][localize][property]") {
  std::size_t ties = 0;
  const auto compare = [&](const SubdivisionLevel& base) {
    const Marked local = mark(base, {});
    const Marked whole = mark(base, {Localize::kOff, 1});
    CHECK(whole.report.vertices == local.report.vertices);
    CHECK(whole.report.submeshes == 0);
    NearTies excuses;
    emitGlobally(base, excuses, [](const SubdivisionLevel&) {});
    ties += differences(*local.tree, *whole.tree, excuses.voxels);
    ties += differences(*whole.tree, *local.tree, excuses.voxels);
  };
  for (const auto* shapes : {&test::shapes(), &test::openShapes()})
    for (const auto& shape : *shapes) {
      CAPTURE(shape.name);
      compare(test::repairedLevel(shape.mesh, 17));
    }
  for (const double size : {64.0, 99.9}) {
    CAPTURE(size);
    compare(test::repairedLevel(test::cube(), size));  // full of exact ties
    compare(test::repairedLevel(test::dodecahedron(), size));
  }
  compare(test::repairedLevel(test::prism(80), 70));  // full of thin patches
  compare(test::repairedLevel(test::pyramid(90), 50.5));
  CAPTURE(ties);
  CHECK(ties < 1000);
}

TEST_CASE("a level of the whole mesh that cannot fit is refused before it is made",
          "[pipeline][localize][error]") {
  ActiveVoxels grid;
  SurfaceReport report;
  Progress unwatched;
  const MemoryBudget budget(std::uint64_t{1} << 26);
  const auto run = [&] {
    markSurface(largeCube(), {Localize::kOff, 1}, budget, unwatched, grid, report);
  };
  CHECK_THROWS_AS(run(), LimitError);
  CHECK_THROWS_WITH(run(),
                    Contains("of the whole mesh needs about") && Contains("use --localize during"));
}

TEST_CASE("progress advances evenly while a surface is made, also with one submesh", "[pipeline]") {
  for (const auto localize : {Localize::kBefore, Localize::kDuring}) {
    double last = 0;
    double largestStep = 0;
    std::size_t calls = 0;
    Progress progress(
        [&](double fraction, const char*) {
          largestStep = std::max(largestStep, fraction - last);
          last = fraction;
          ++calls;
        },
        std::chrono::nanoseconds(0));
    progress.plan(1);
    progress.beginLast("surface");
    // At this size most vertices are in patches that are split.
    onThreads(1, [&] {
      return mark(test::repairedLevel(test::cube(), 1500), {localize, 256}, progress);
    });
    CAPTURE(nameIn(kLocalizeNames, localize), calls, largestStep);
    CHECK(calls > 100);
    CHECK(largestStep < 0.1);
    CHECK(last == Approx(1));
  }
}

TEST_CASE("a surface that is cancelled stops at the next submesh or split patch",
          "[pipeline][parallel]") {
  for (const auto localize : {Localize::kBefore, Localize::kDuring, Localize::kOff})
    for (const int threads : {1, 8}) {
      Progress* run = nullptr;
      std::size_t calls = 0;
      Progress progress(
          [&](double, const char*) {
            if (++calls == 3) run->cancel();
          },
          std::chrono::nanoseconds(0));
      run = &progress;
      progress.plan(1);
      progress.beginLast("surface");
      const SubdivisionLevel base =
          localize == Localize::kOff ? test::repairedLevel(test::cube(), 60) : largeCube();
      CAPTURE(nameIn(kLocalizeNames, localize), threads);
      CHECK_THROWS_AS(onThreads(threads,
                                [&] {
                                  return mark(base, {localize, 1}, progress);
                                }),
                      Cancelled);
      CHECK(calls < 3 + 40);  // of hundreds
    }
}

TEST_CASE("tasks that run out of memory at the same time end in one refusal",
          "[pipeline][parallel][error]") {
  const SubdivisionLevel base = largeCube();
  for (int run = 0; run < 20; ++run) {
    ActiveVoxels grid(std::uint64_t{1} << (20 + run % 4));
    SurfaceReport report;
    Progress unwatched;
    const SurfaceOptions options{run % 2 == 0 ? Localize::kDuring : Localize::kBefore, 1};
    const auto tooLarge = [&] {
      onThreads(8, [&] {
        markSurface(base, options, MemoryBudget(0), unwatched, grid, report);
        return 0;
      });
    };
    CHECK_THROWS_AS(tooLarge(), LimitError);
  }
}

TEST_CASE("a smooth surface takes few vertices for each voxel", "[pipeline]") {
  // The finest faces are squares of half a voxel: 4 vertices per unit of area. A 6-separating
  // surface has about 1.5 voxels per unit of area, so there are less than 4 / 1.5 vertices per
  // voxel. A patch is as fine as its largest face needs, which may be twice as fine as others.
  for (const double size : {40.0, 61.0, 83.0}) {
    const Marked marked = mark(test::repairedLevel(test::torusGrid(32, 16), size), {});
    const double vertices =
        std::accumulate(marked.report.vertices.begin(), marked.report.vertices.end(), 0.0);
    const auto voxels = static_cast<double>(marked.tree->activeVoxelCount());
    CAPTURE(size);
    CHECK(vertices / voxels < 16 / 1.5);
    CHECK(vertices / voxels > 1);
  }
}
