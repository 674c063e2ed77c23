#include "libvox/core/progress.h"

#include "libvox/core/parallel.h"
#include "libvox/io/watched_stream.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

using namespace vox;

namespace {

constexpr std::chrono::nanoseconds kAtOnce(0);

struct Report {
  double fraction;
  std::string stage;
};

Progress::Callback into(std::vector<Report>& reports) {
  return [&reports](double fraction, const char* stage) { reports.push_back({fraction, stage}); };
}

}  // namespace

TEST_CASE("the fraction is the share of the stages before and the part of this one", "[core]") {
  std::vector<Report> reports;
  Progress progress(into(reports), kAtOnce);
  progress.plan(30);
  progress.plan(10);
  progress.begin("first", 10);
  progress.done(0.5);
  progress.done(0.25);
  progress.begin("second", 20);  // takes what is left of the first as done
  progress.done(0.5);
  progress.beginLast("third");
  progress.done(0.5);
  progress.finish();
  std::vector<double> fractions;
  std::string stages;
  for (const Report& report : reports) {
    fractions.push_back(report.fraction);
    stages += report.stage.substr(0, 1);
  }
  CHECK(fractions == std::vector{0.0, 0.125, 0.1875, 0.25, 0.5, 0.75, 0.875, 1.0});
  CHECK(stages == "fffssttt");
}

TEST_CASE("progress never goes back and never beyond 1, whatever is credited", "[core][parallel]") {
  std::vector<Report> reports;
  Progress progress(into(reports), kAtOnce);
  progress.plan(1);
  onThreads(8, [&] {
    for (int stage = 0; stage < 3; ++stage) {
      progress.begin("work", 0.4);  // more than planned in the end
      parallelForEach(3000, 1, [&](int) { progress.done(1.0 / 2000); });
    }
    progress.plan(5);
    progress.begin("more", 1);
    return 0;
  });
  progress.finish();
  REQUIRE(reports.size() > 100);
  CHECK(std::is_sorted(reports.begin(), reports.end(),
                       [](const Report& a, const Report& b) { return a.fraction < b.fraction; }));
  CHECK(reports.front().fraction == 0);
  CHECK(reports.back().fraction == 1);
}

TEST_CASE("progress calls at the first of each stage, in the end, and else once an interval",
          "[core]") {
  std::vector<Report> reports;
  Progress progress(into(reports), std::chrono::hours(1));
  progress.plan(100);
  for (int object = 0; object < 50; ++object)
    for (const char* stage : {"prepare", "surface"}) {
      progress.begin(stage, 1);
      for (int i = 0; i < 100; ++i) progress.done(0.01);
    }
  progress.finish();
  CHECK(reports.size() == 3);
}

TEST_CASE("a cancelled run stops at the next check, with the exit code of an interrupt", "[core]") {
  Progress progress;
  progress.plan(1);
  CHECK_NOTHROW(progress.check());
  CHECK_NOTHROW(progress.begin("work", 1));
  progress.cancel();
  progress.done(0.5);
  CHECK_THROWS_AS(progress.check(), Cancelled);
  CHECK_THROWS_AS(progress.begin("more", 1), Cancelled);
  CHECK_THROWS_AS(progress.finish(), Cancelled);
  CHECK(Cancelled().exitCode() == 130);
}

TEST_CASE("a watched stream passes on reads, writes and seeks", "[io]") {
  std::stringstream inner(std::ios::in | std::ios::out | std::ios::binary);
  Progress progress;
  WatchedStream stream(*inner.rdbuf(), progress, 100);
  stream << "one, two, three" << '!' << std::flush;
  stream.seekp(5);
  stream.put('T');
  stream.seekg(0);
  std::string all;
  std::getline(stream, all);
  CHECK(all == "one, Two, three!");
  CHECK(inner.str() == all);
}

TEST_CASE("a watched stream credits what is written, and stops when cancelled", "[io]") {
  std::vector<Report> reports;
  Progress progress(into(reports), kAtOnce);
  progress.plan(1);
  progress.beginLast("write");
  constexpr std::size_t kMebibyte = 1 << 20;
  std::stringstream inner(std::ios::in | std::ios::out | std::ios::binary);
  WatchedStream stream(*inner.rdbuf(), progress, 2 * kMebibyte);
  const std::string block(kMebibyte / 16, 'x');
  for (int i = 0; i < 16; ++i) stream << block;
  CHECK(reports.size() > 3);
  CHECK(reports.back().fraction == 0.5);
  progress.cancel();
  CHECK_THROWS_AS(
      [&] {
        for (int i = 0; i < 16; ++i) stream << block;
      }(),
      Cancelled);
}

TEST_CASE("a watched stream that cannot be written says so", "[io][error]") {
  if (!std::ifstream("/dev/full")) return;
  std::fstream full("/dev/full", std::ios::in | std::ios::out | std::ios::binary);
  Progress progress;
  WatchedStream stream(*full.rdbuf(), progress, 1);
  CHECK_THROWS_AS(stream << std::string(1 << 20, 'x') << std::flush, IoError);
}
