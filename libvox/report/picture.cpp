// Pictures as figures of HTML.

#include "libvox/report/picture.h"

#include "libvox/core/markup.h"
#include "libvox/io/write_png.h"
#include "libvox/report/html.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <sstream>

namespace vox {
namespace {

/// Circles around places, over a picture.
std::string circlesOf(const Picture& picture) {
  if (picture.marks.empty()) return {};
  constexpr double kRadius = 0.03;
  std::ostringstream svg;
  svg << "<svg viewBox=\"0 0 " << picture.image.width << ' ' << picture.image.height
      << "\" aria-hidden=\"true\">";
  for (const auto& [x, y] : picture.marks)
    svg << "<circle cx=\"" << x * picture.image.width << "\" cy=\"" << y * picture.image.height
        << "\" r=\"" << kRadius * picture.image.width << "\"/>";
  svg << "</svg>";
  return svg.str();
}

}  // namespace

Image halved(const Image& image) {
  Image half(image.width / 2, image.height / 2);
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x) {
      std::array<unsigned, 4> sum{};
      unsigned covered = 0;
      for (int k = 0; k < 4; ++k) {
        const Pixel& pixel = image.at(2 * x + k % 2, 2 * y + k / 2);
        for (std::size_t i = 0; i < 3; ++i) sum[i] += pixel[3] > 0 ? pixel[i] : 0U;
        sum[3] += pixel[3];
        covered += pixel[3] > 0 ? 1U : 0U;
      }
      Pixel& pixel = half.at(x, y);
      for (std::size_t i = 0; i < 3; ++i)
        pixel[i] = static_cast<std::uint8_t>(sum[i] / std::max(covered, 1U));
      pixel[3] = static_cast<std::uint8_t>(sum[3] / 4);
    }
  return half;
}

std::string figureOf(const Picture& picture) {
  std::ostringstream png;
  writePng(png, picture.image);
  return "<figure><div class=\"picture\"><img src=\"" + dataUri(png.str(), "image/png") +
         "\" width=\"" + std::to_string(picture.image.width) + "\" height=\"" +
         std::to_string(picture.image.height) + "\" alt=" + escapedValue(picture.description) +
         ">" + circlesOf(picture) + "</div><figcaption><b>" + escaped(picture.title) + "</b> " +
         escaped(picture.description) + "</figcaption></figure>\n";
}

}  // namespace vox
