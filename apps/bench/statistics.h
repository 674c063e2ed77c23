#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace vox::bench {

/// Of an odd number of values the middle one, of an even number the mean of the two in the middle.
/// At least one value.
double median(std::vector<double> values);

struct Range {
  double min = 0;
  double median = 0;
  double max = 0;
};
/// At least one value.
Range rangeOf(const std::vector<double>& values);

/// b[i] / a[i] for as many as both have; pairs whose a is 0 are left out.
std::vector<double> ratios(std::span<const double> a, std::span<const double> b);

/// The e of y = c x^e that fits best: least squares of the logarithms. Points whose x or y is not
/// positive are left out.
/// @return nothing if fewer than two different x are left
std::optional<double> fitExponent(std::span<const double> x, std::span<const double> y);

/// The same for what y has above a floor. Points less than a quarter above it are left out: their
/// remainder is mostly noise.
std::optional<double> fitExponentAbove(double floor, std::span<const double> x,
                                       std::span<const double> y);

/// The N of the last "N active voxels" in what a program printed.
std::optional<std::uint64_t> voxelsIn(std::string_view output);

}  // namespace vox::bench
