// Histograms of differences.

#include "libvox/report/histogram.h"

#include "libvox/core/markup.h"
#include "libvox/report/html.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace vox {
namespace {

constexpr std::size_t kBars = 24;

/// Calls visit(value, number of voxels).
template <class Visit>
void forValues(const openvdb::FloatTree& values, Visit&& visit) {
  for (auto value = values.cbeginValueOn(); value; ++value)
    visit(static_cast<double>(*value), value.getVoxelCount());
}

}  // namespace

Histogram histogramOf(const openvdb::FloatTree& values) {
  Histogram histogram;
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  forValues(values, [&](double value, std::uint64_t voxels) {
    if (!std::isfinite(value)) {
      histogram.notFinite += voxels;
    } else if (value > 0) {
      least = std::min(least, value);
      most = std::max(most, value);
    }
  });
  if (most == 0) return histogram;
  constexpr double kWideRange = 50;
  const bool byRatio = most > kWideRange * least;
  const double low = byRatio ? std::log(least) : least == most ? most : 0;
  const double high = byRatio ? std::log(most) : most;
  for (std::size_t i = 0; i <= kBars; ++i) {
    const double t = low + (high - low) * static_cast<double>(i) / kBars;
    histogram.bounds.push_back(byRatio ? std::exp(t) : t);
  }
  histogram.bounds.back() = most;
  histogram.counts.resize(kBars);
  forValues(values, [&](double value, std::uint64_t voxels) {
    if (!std::isfinite(value) || value <= 0) return;
    const auto& bounds = histogram.bounds;
    const auto above = std::upper_bound(bounds.begin() + 1, bounds.end() - 1, value);
    histogram.counts[static_cast<std::size_t>(above - bounds.begin() - 1)] += voxels;
  });
  return histogram;
}

std::string histogramFigure(const Histogram& histogram) {
  const std::string notFinite =
      histogram.notFinite == 0 ? "" : " Not finite: " + grouped(histogram.notFinite) + '.';
  if (histogram.counts.empty() && notFinite.empty()) return {};
  if (histogram.counts.empty() || histogram.bounds.front() == histogram.bounds.back())
    return "<p>" +
           (histogram.counts.empty()
                ? "The differences of values cannot be shown."
                : "All values differ by " + shortNumber(histogram.bounds.back()) + '.') +
           notFinite + "</p>\n";
  constexpr int kWidth = 420;
  constexpr int kHeight = 200;
  constexpr int kAxis = 24;
  const auto highest = std::max_element(histogram.counts.begin(), histogram.counts.end());
  const double width = static_cast<double>(kWidth) / static_cast<double>(histogram.counts.size());
  const auto bar = static_cast<std::size_t>(highest - histogram.counts.begin());
  const std::string range =
      shortNumber(histogram.bounds[bar]) + " and " + shortNumber(histogram.bounds[bar + 1]);
  const std::string description = "Differences of values from " +
                                  shortNumber(histogram.bounds.front()) + " to " +
                                  shortNumber(histogram.bounds.back()) + "; most voxels, " +
                                  grouped(*highest) + ", lie between " + range + '.';
  std::ostringstream svg;
  svg << "<figure><svg class=\"bars\" viewBox=\"0 0 " << kWidth << ' ' << kHeight + kAxis
      << "\" role=\"img\" aria-label=" << escapedValue(description) << ">";
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    if (histogram.counts[i] == 0) continue;
    const double height = std::max(
        1.0, kHeight * static_cast<double>(histogram.counts[i]) / static_cast<double>(*highest));
    svg << "<rect x=\"" << static_cast<double>(i) * width + 1 << "\" y=\"" << kHeight - height
        << "\" width=\"" << width - 2 << "\" height=\"" << height << "\"><title>"
        << grouped(histogram.counts[i]) << ": " << shortNumber(histogram.bounds[i]) << " to "
        << shortNumber(histogram.bounds[i + 1]) << "</title></rect>";
  }
  svg << "<text x=\"2\" y=\"" << kHeight + 18 << "\">" << shortNumber(histogram.bounds.front())
      << "</text><text x=\"" << kWidth - 2 << "\" y=\"" << kHeight + 18 << "\" text-anchor=\"end\">"
      << shortNumber(histogram.bounds.back()) << "</text></svg>"
      << "<figcaption><b>Differences of values</b> " << escaped(description) << notFinite
      << "</figcaption></figure>\n";
  return svg.str();
}

}  // namespace vox
