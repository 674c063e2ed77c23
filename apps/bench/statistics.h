#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace vox::bench {

inline constexpr double kMiB = 1024.0 * 1024;

/// Median of at least one value: the middle one, or the mean of the two in the middle.
double median(std::vector<double> values);

struct Range {
  double min = 0;
  double median = 0;
  double max = 0;
};
/// Range of at least one value.
Range rangeOf(const std::vector<double>& values);

/// Ratios b[i] / a[i], up to the length of the shorter list. Pairs with a[i] = 0 are left out.
std::vector<double> ratios(std::span<const double> a, std::span<const double> b);

/// The exponent e of y = c x^e that fits best: least squares of the logarithms. Points whose x or y
/// is not positive are left out.
/// @return nothing if fewer than two different x are left
std::optional<double> fitExponent(std::span<const double> x, std::span<const double> y);

/// The exponent of y - floor. Points less than a quarter above the floor are left out, because
/// their difference is mostly noise.
std::optional<double> fitExponentAbove(double floor, std::span<const double> x,
                                       std::span<const double> y);

/// The number N in the last "N active voxels" of the output of a program; nothing if there is none.
std::optional<std::uint64_t> voxelsIn(std::string_view output);

}  // namespace vox::bench
