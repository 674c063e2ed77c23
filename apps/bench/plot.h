#pragma once

#include <array>
#include <string>
#include <vector>

namespace vox::bench {

struct Curve {
  std::string name;
  std::vector<std::array<double, 2>> points;  ///< x, y, both positive
};

/// Curves in a coordinate system with logarithmic axes.
struct Plot {
  std::string title;  ///< also names y
  std::string x;
  std::vector<Curve> curves;
};

/// The plot as an SVG document. Names may hold any text.
std::string svgOf(const Plot& plot);

}  // namespace vox::bench
