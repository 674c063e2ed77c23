// Statistics of the benchmarks.

#include "apps/bench/statistics.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace vox::bench;

using Values = std::vector<double>;

TEST_CASE("the median is the middle value or the mean of the two", "[bench]") {
  CHECK(median({7}) == 7);
  CHECK(median({9, 1, 5}) == 5);
  CHECK(median({9, 1, 5, 2}) == 3.5);
  const Range range = rangeOf({4, 1, 2, 3, 5});
  CHECK(range.min == 1);
  CHECK(range.median == 3);
  CHECK(range.max == 5);
}

TEST_CASE("ratios pair values by run and leave out what has no ratio", "[bench]") {
  CHECK(ratios(Values{1, 2, 4}, Values{3, 3, 3}) == Values{3, 1.5, 0.75});
  CHECK(ratios(Values{2, 2}, Values{4}) == Values{2});
  CHECK(ratios(Values{0, 2}, Values{4, 4}) == Values{2});
  CHECK(ratios(Values{}, Values{4}).empty());
}

TEST_CASE("a power law gives back its exponent", "[bench]") {
  const double exponent = GENERATE(0.5, 1.0, 1.7);
  Values x;
  Values y;
  for (int i = 1; i <= 6; ++i) {
    x.push_back(std::pow(3.0, i));
    y.push_back(0.02 * std::pow(x.back(), exponent));
  }
  CHECK(fitExponent(x, y).value() == Approx(exponent));
  // A point at which the law is negligible against the floor must not count.
  Values raised = y;
  for (double& value : raised) value += y[2];
  CHECK(fitExponentAbove(y[2], x, raised).value() == Approx(exponent));
  CHECK(fitExponent(x, raised).value() < exponent);
}

TEST_CASE("too few points give no exponent", "[bench]") {
  CHECK_FALSE(fitExponent(Values{}, Values{}));
  CHECK_FALSE(fitExponent(Values{2}, Values{3}));
  CHECK_FALSE(fitExponent(Values{2, 2}, Values{3, 4}));
  CHECK_FALSE(fitExponent(Values{1, 2}, Values{0, 4}));
  CHECK_FALSE(fitExponentAbove(10, Values{1, 2, 3}, Values{9, 12, 20}));
}

TEST_CASE("the number of voxels is read off a program's output", "[bench]") {
  CHECK(voxelsIn("vox: out.vdb: 153644 active voxels of size 0.01\n") == 153644);
  CHECK(voxelsIn("1 active voxels\n23 active voxels\n") == 23);
  CHECK_FALSE(voxelsIn("no active voxels"));
  CHECK_FALSE(voxelsIn(""));
}
