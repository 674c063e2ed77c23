#include "libvox/pipeline/run_submeshes.h"

#include "libvox/core/parallel.h"
#include "tests/repaired_level.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

using namespace vox;

namespace {

constexpr std::int64_t kTilesOfFace = 5;

/// Visits faces, and leaves tiles of each for later.
struct Visits {
  std::vector<std::atomic<int>> walked, tiles;
  std::atomic<int> interruptions = 0, otherThreads = 0;

  explicit Visits(Index faces) : walked(faces), tiles(faces * kTilesOfFace) {}

  void visit(bool& isBusy, SubmeshTask& task) {
    interruptions += isBusy;
    isBusy = true;
    // Waits for other threads, as a sink may.
    parallelForEach(task.faces.size(), 1, [&](std::size_t i) {
      std::this_thread::sleep_for(std::chrono::microseconds(50));
      ++walked[task.faces[i]];
    });
    for (const Index f : task.faces) {
      ++task.walked;
      task.later.push_back(
          {kTilesOfFace, 10, [this, f, here = std::this_thread::get_id()](std::int64_t tile) {
             ++tiles[static_cast<std::size_t>(f * kTilesOfFace + tile)];
             otherThreads += std::this_thread::get_id() != here;
           }});
    }
    isBusy = false;
  }
};

}  // namespace

TEST_CASE("for any submeshes and threads each face and each tile has one turn, in due share",
          "[pipeline][parallel][property]") {
  const SubdivisionLevel base = test::repairedLevel(test::torusGrid(24, 16));
  const auto areAllOne = [](const auto& counts) {
    return std::all_of(counts.begin(), counts.end(), [](int count) { return count == 1; });
  };
  for (const auto localize : {Localize::kBefore, Localize::kDuring})
    for (const Index faces : {1U, 7U, 1000U})
      for (const int threads : {1, 2, 8}) {
        CAPTURE(nameIn(kLocalizeNames, localize), faces, threads);
        double fraction = 0;
        Progress progress([&](double all, const char*) { fraction = all; },
                          std::chrono::nanoseconds(0));
        progress.plan(1);
        progress.beginLast("surface");
        Visits visits(base.mesh.faceCount());
        onThreads(threads, [&] {
          const Submeshes submeshes = cutIntoSubmeshes(base, {localize, faces});
          const auto body = [&](bool& isBusy, SubmeshTask& task) { visits.visit(isBusy, task); };
          runSubmeshes(
              submeshes, progress, 0.75, [] { return false; }, body);
        });
        CHECK(areAllOne(visits.walked));
        CHECK(areAllOne(visits.tiles));
        CHECK(visits.interruptions == 0);
        if (localize == Localize::kBefore) CHECK(visits.otherThreads == 0);
        progress.done(0);  // reports
        CHECK(fraction == Approx(0.75));
      }
}
