#pragma once

#include <array>
#include <string>
#include <vector>

namespace vox::bench {

struct Curve {
  std::string name;
  std::vector<std::array<double, 2>> points;  ///< x, y, both positive
};

/// Curves over logarithmic axes.
struct Plot {
  std::string title;  ///< and what y is
  std::string x;
  std::vector<Curve> curves;
};

/// An SVG document. Names may hold any text.
std::string svgOf(const Plot& plot);

}  // namespace vox::bench
