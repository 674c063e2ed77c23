#include "apps/bench/statistics.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace vox::bench {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

Range rangeOf(const std::vector<double>& values) {
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  return {*min, median(values), *max};
}

std::vector<double> ratios(std::span<const double> a, std::span<const double> b) {
  std::vector<double> result;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (a[i] != 0) result.push_back(b[i] / a[i]);
  return result;
}

std::optional<double> fitExponent(std::span<const double> x, std::span<const double> y) {
  double n = 0;
  double sumX = 0;
  double sumY = 0;
  const auto forLogs = [&](auto&& visit) {
    for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
      if (x[i] > 0 && y[i] > 0) visit(std::log(x[i]), std::log(y[i]));
  };
  forLogs([&](double logX, double logY) {
    ++n;
    sumX += logX;
    sumY += logY;
  });
  double variance = 0;
  double covariance = 0;
  forLogs([&](double logX, double logY) {
    variance += (logX - sumX / n) * (logX - sumX / n);
    covariance += (logX - sumX / n) * (logY - sumY / n);
  });
  if (n < 2 || !(variance > 0)) return std::nullopt;
  return covariance / variance;
}

std::optional<double> fitExponentAbove(double floor, std::span<const double> x,
                                       std::span<const double> y) {
  constexpr double kClear = 1.25;
  std::vector<double> rest;
  for (const double value : y) rest.push_back(value >= kClear * floor ? value - floor : 0);
  return fitExponent(x, rest);
}

std::optional<std::uint64_t> voxelsIn(std::string_view output) {
  const std::size_t end = output.rfind(" active voxels");
  if (end == std::string_view::npos) return std::nullopt;
  std::size_t begin = end;
  while (begin > 0 && output[begin - 1] >= '0' && output[begin - 1] <= '9') --begin;
  std::uint64_t voxels = 0;
  const auto [_, error] = std::from_chars(output.data() + begin, output.data() + end, voxels);
  if (error != std::errc()) return std::nullopt;
  return voxels;
}

}  // namespace vox::bench
