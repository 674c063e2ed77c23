// Images at texture coordinates: bilinear, in linear light.

#include "libvox/volume/image_texture.h"

#include "libvox/core/color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace vox {

namespace {

/// Linear light of each 8-bit value.
const std::array<float, 256>& lightTable() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> light{};
    for (std::size_t i = 0; i < light.size(); ++i)
      light[i] = static_cast<float>(linearFromScreen(static_cast<double>(i) / 255));
    return light;
  }();
  return table;
}

/// Two texels next to each other along a side of the image, and the weight of the second.
struct Pair {
  int first;
  int second;
  double fraction;
};

/// The texels around a place along a side of `count` texels, 0 to 1 from end to end.
Pair texelsAround(double place, int count, bool clamp) {
  if (!std::isfinite(place)) place = 0;
  place = clamp ? std::clamp(place, 0.0, 1.0) : place - std::floor(place);  // 0 to 1, both included
  const double position = place * count - 0.5;
  const double below = std::floor(position);
  const int first = static_cast<int>(below);  // -1 to count - 1
  const int end = clamp ? count - 1 : 0;      // what follows the last texel
  const int start = clamp ? 0 : count - 1;    // what precedes the first
  return {first < 0 ? start : first, first + 1 < count ? first + 1 : end, position - below};
}

}  // namespace

ImageTexture::ImageTexture(std::shared_ptr<const Image> image, ImageMap map)
    : image_(std::move(image)), map_(std::move(map)) {}

Vec4f ImageTexture::Sum::mean() const {
  Vec4f result;
  result.head<3>() = coverage > 0 ? Vec3f(covered / coverage) : Vec3f(plain / weight);
  result[3] = coverage / weight;
  return result;
}

void ImageTexture::addTexel(int x, int y, double weight, Sum& sum) const {
  const std::array<float, 256>& light = lightTable();
  const Pixel& pixel = image_->at(x, y);
  const Vec3f color(light[pixel[0]], light[pixel[1]], light[pixel[2]]);
  const auto part = static_cast<float>(weight);
  const float coverage = map_.opaque ? part : part * (static_cast<float>(pixel[3]) / 255);
  sum.covered += coverage * color;
  sum.plain += part * color;
  sum.coverage += coverage;
  sum.weight += part;
}

void ImageTexture::addSample(const Vec2d& uv, Sum& sum) const {
  const Vec2d place = uv.cwiseProduct(map_.scale) + map_.offset;
  const Pair x = texelsAround(place[0], image_->width, map_.clamp);
  const Pair up = texelsAround(place[1], image_->height, map_.clamp);
  const Pair y{image_->height - 1 - up.first, image_->height - 1 - up.second, up.fraction};
  addTexel(x.first, y.first, (1 - x.fraction) * (1 - y.fraction), sum);
  addTexel(x.second, y.first, x.fraction * (1 - y.fraction), sum);
  addTexel(x.first, y.second, (1 - x.fraction) * y.fraction, sum);
  addTexel(x.second, y.second, x.fraction * y.fraction, sum);
}

Vec4f ImageTexture::at(const Vec2d& uv) const {
  Sum sum;
  addSample(uv, sum);
  return sum.mean();
}

double ImageTexture::texelsAcross(const Vec2d& alongA, const Vec2d& alongB) const {
  const Vec2d texels = map_.scale.cwiseProduct(Vec2d(image_->width, image_->height));
  return std::max(alongA.cwiseProduct(texels).norm(), alongB.cwiseProduct(texels).norm());
}

int ImageTexture::samplesAcross(double texels) {
  if (!(texels > 1)) return 1;  // NaN, too
  constexpr double kMostTexels = 4 * kMostSamples;
  if (texels > kMostTexels) return kSamplesOfNoise;
  return static_cast<int>(std::min(std::ceil(texels), double{kMostSamples}));
}

}  // namespace vox
