#include "libvox/volume/image_texture.h"

#include "libvox/core/color.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

using namespace vox;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding = 1e-6;  // of a few sums of floats up to 1

std::shared_ptr<const Image> randomImage(int width, int height, bool opaque) {
  std::mt19937 random(7);
  auto image = std::make_shared<Image>(width, height);
  for (Pixel& pixel : image->pixels) {
    for (std::uint8_t& value : pixel) value = static_cast<std::uint8_t>(random());
    if (opaque) pixel[3] = 255;
  }
  return image;
}

std::shared_ptr<const Image> imageOf(int width, int height, const std::vector<Pixel>& pixels) {
  auto image = std::make_shared<Image>(width, height);
  image->pixels = pixels;
  return image;
}

/// Linear colour, times coverage, and coverage of a texel; coordinates outside wrap or clamp.
Eigen::Vector4d texel(const Image& image, long x, long y, bool clamp) {
  const auto inside = [&](long n, long count) {
    return clamp ? std::clamp(n, 0L, count - 1) : ((n % count) + count) % count;
  };
  const Pixel& pixel =
      image.at(static_cast<int>(inside(x, image.width)), static_cast<int>(inside(y, image.height)));
  const double alpha = pixel[3] / 255.0;
  return {alpha * linearFromScreen(pixel[0] / 255.0), alpha * linearFromScreen(pixel[1] / 255.0),
          alpha * linearFromScreen(pixel[2] / 255.0), alpha};
}

/// The bilinear value as a sum over all texels, each with a tent around its centre.
Eigen::Vector4d bruteForce(const Image& image, const Vec2d& uv, bool clamp) {
  const double x = (clamp ? std::clamp(uv[0], 0.0, 1.0) : uv[0]) * image.width - 0.5;
  const double y = (1 - (clamp ? std::clamp(uv[1], 0.0, 1.0) : uv[1])) * image.height - 0.5;
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (long j = std::lround(y) - 2; j <= std::lround(y) + 2; ++j)
    for (long i = std::lround(x) - 2; i <= std::lround(x) + 2; ++i) {
      const double weight = std::max(0.0, 1 - std::abs(x - static_cast<double>(i))) *
                            std::max(0.0, 1 - std::abs(y - static_cast<double>(j)));
      sum += weight * texel(image, i, j, clamp);
    }
  if (sum[3] > 0) sum.head<3>() /= sum[3];
  return sum;
}

void requireNear(const Vec4f& value, const Eigen::Vector4d& expected) {
  CAPTURE(value.transpose(), expected.transpose());
  REQUIRE((value.cast<double>() - expected).cwiseAbs().maxCoeff() < kRounding);
}

}  // namespace

TEST_CASE("the centre of a texel has its colour, row 0 at the top", "[volume][image][golden]") {
  const auto image = randomImage(5, 3, true);
  const bool clamp = GENERATE(false, true);
  const ImageTexture texture(image, {.clamp = clamp});
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 5; ++i)
      requireNear(texture.at(Vec2d((i + 0.5) / 5, 1 - (j + 0.5) / 3)), texel(*image, i, j, clamp));
}

TEST_CASE("values between centres are bilinear in linear light", "[volume][image][property]") {
  const bool clamp = GENERATE(false, true);
  const bool opaque = GENERATE(false, true);
  const auto [width, height] = GENERATE(table<int, int>({{7, 4}, {1, 1}, {1, 9}, {2, 2}}));
  CAPTURE(clamp, opaque, width, height);
  const auto image = randomImage(width, height, opaque);
  const ImageTexture texture(image, {.clamp = clamp});
  std::mt19937 random(2);
  std::uniform_real_distribution<double> anywhere(-2, 3);
  for (int n = 0; n < 2000; ++n) {
    const Vec2d uv(anywhere(random), anywhere(random));
    CAPTURE(uv.transpose());
    requireNear(texture.at(uv), bruteForce(*image, uv, clamp));
  }
}

TEST_CASE("images meet at their edges when they repeat, and end there when they are clamped",
          "[volume][image][golden]") {
  const auto image = imageOf(2, 1, {{0, 0, 0, 255}, {255, 255, 255, 255}});
  const ImageTexture repeated(image);
  const ImageTexture clamped(image, {.clamp = true});
  for (const double u : {0.0, 1.0, -3.0, 1e15}) CHECK(repeated.at({u, 0.5})[0] == Approx(0.5));
  CHECK(clamped.at({0, 0.5})[0] == 0);
  CHECK(clamped.at({-1e300, 0.5})[0] == 0);
  CHECK(clamped.at({1, 0.5})[0] == 1);
  CHECK(clamped.at({7, -7})[0] == 1);
}

TEST_CASE("halfway between black and white is half of the light", "[volume][image][golden]") {
  const ImageTexture texture(imageOf(2, 1, {{0, 0, 0, 255}, {255, 255, 255, 255}}));
  CHECK(texture.at({0.5, 0.5}) == Vec4f(0.5F, 0.5F, 0.5F, 1));
  const auto middle = [](double a, double) { return Vec2d(a / 2 + 0.25, 0.5); };
  CHECK(texture.mean(16, middle)[0] == Approx(0.5));
}

TEST_CASE("transparent texels give their neighbours no colour", "[volume][image][golden]") {
  const ImageTexture texture(imageOf(2, 1, {{255, 0, 0, 255}, {0, 255, 0, 0}}));
  CHECK(texture.at({0.5, 0.5}) == Vec4f(1, 0, 0, 0.5F));
  CHECK(texture.mean(2, [](double a, double) { return Vec2d(a, 0.5); }) == Vec4f(1, 0, 0, 0.5F));
  CHECK(texture.at({0.75, 0.5}) == Vec4f(0, 1, 0, 0));  // all of it is transparent
}

TEST_CASE("scale and offset move texture coordinates as MTL's -s and -o do",
          "[volume][image][golden]") {
  const auto image = randomImage(6, 5, true);
  const ImageTexture plain(image);
  const ImageTexture moved(image, {.scale = Vec2d(2, -0.5), .offset = Vec2d(0.25, 3)});
  for (const Vec2d& uv : {Vec2d(0, 0), Vec2d(0.3, 0.9), Vec2d(-5, 0.1)})
    CHECK(moved.at(uv) == plain.at(Vec2d(2 * uv[0] + 0.25, -0.5 * uv[1] + 3)));
}

TEST_CASE("any texture coordinate has a colour", "[volume][image][property]") {
  const bool clamp = GENERATE(false, true);
  const double scale = GENERATE(1.0, 1e300, 0.0, -1.0);
  const ImageTexture texture(randomImage(3, 3, false), {.scale = {scale, scale}, .clamp = clamp});
  for (const double u : {kNan, kInfinity, -kInfinity, 1e308, -1e308, 1e-320, -1e-320, -1e-17, 0.0})
    for (const double v : {kNan, -1e308, 0.5}) {
      CAPTURE(u, v);
      const Vec4f color = texture.at({u, v});
      CHECK(color.minCoeff() >= 0);
      CHECK(color.maxCoeff() <= 1 + kRounding);
      CHECK(ImageTexture::samplesAcross(texture.texelsAcross({u, v}, {v, u})) >= 1);
    }
  CHECK(texture.at({kNan, kInfinity}) == texture.at({0, 0}));
}

TEST_CASE("a part is as large as its longer side in texels", "[volume][image][golden]") {
  const auto image = randomImage(8, 4, true);
  CHECK(ImageTexture(image).texelsAcross({0.5, 0}, {0, 0.5}) == 4);
  CHECK(ImageTexture(image).texelsAcross({3.0 / 8, 1}, {0, 0.5}) == 5);
  CHECK(ImageTexture(image, {.scale = Vec2d(2, 3)}).texelsAcross({0.5, 0}, {0, -1}) == 12);
}

TEST_CASE("samples follow the texels, from 1 to 64; of noise there are 16",
          "[volume][image][golden]") {
  CHECK(ImageTexture::samplesAcross(0) == 1);
  CHECK(ImageTexture::samplesAcross(1) == 1);
  CHECK(ImageTexture::samplesAcross(1.01) == 2);
  CHECK(ImageTexture::samplesAcross(7) == 7);
  CHECK(ImageTexture::samplesAcross(100) == 64);
  CHECK(ImageTexture::samplesAcross(1e300) == 16);
  CHECK(ImageTexture::samplesAcross(kInfinity) == 16);
  CHECK(ImageTexture::samplesAcross(kNan) == 1);
}

TEST_CASE("the mean over the whole image is the mean of its texels", "[volume][image][property]") {
  const bool opaque = GENERATE(false, true);
  const auto image = randomImage(16, 16, opaque);
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 16; ++i) sum += texel(*image, i, j, false);
  sum.head<3>() /= sum[3];
  sum[3] /= 256;
  requireNear(ImageTexture(image).mean(16, [](double a, double b) { return Vec2d(a, b); }), sum);
}

TEST_CASE("the alpha of an opaque image does not count", "[volume][image]") {
  const auto image = randomImage(5, 4, false);
  auto covered = std::make_shared<Image>(*image);
  for (Pixel& pixel : covered->pixels) pixel[3] = 255;
  ImageMap opaque;
  opaque.opaque = true;
  const ImageTexture texture(image, opaque);
  const ImageTexture expected(covered);
  for (double u = 0; u < 1; u += 0.07)
    for (double v = 0; v < 1; v += 0.07) {
      CHECK(texture.at({u, v}) == expected.at({u, v}));
      CHECK(texture.at({u, v})[3] == Approx(1));
    }
}
