// Solid textures from noise and patterns.
// K. Perlin, An image synthesizer, 1985; D. Peachey, Solid texturing of complex surfaces, 1985.

#include "libvox/volume/texture.h"

#include "libvox/volume/noise.h"
#include "libvox/volume/patterns.h"

#include <cmath>
#include <utility>

namespace vox {
namespace {

/// Default scale, in longest sides of the object.
constexpr double kPartOfSide = 0.125;

/// Lowest and highest position of a box along an axis.
std::pair<double, double> extentAlong(const Box& box, const Vec3d& axis) {
  const Vec3d toLow = box.low.cwiseProduct(axis);
  const Vec3d toHigh = box.high.cwiseProduct(axis);
  return {toLow.cwiseMin(toHigh).sum(), toLow.cwiseMax(toHigh).sum()};
}

}  // namespace

SolidTexture::SolidTexture(const TextureSpec& spec, const Box& extent)
    : spec_(spec), axis_(spec.axis / std::sqrt(spec.axis.dot(spec.axis))) {
  const double side = extent.longestSide();
  scale_ = spec.scale.value_or(side > 0 ? kPartOfSide * side : 1);
  const auto [low, high] = extent.empty() ? std::pair(0.0, 1.0) : extentAlong(extent, axis_);
  from_ = spec.from.value_or(low);
  to_ = spec.to.value_or(high);
}

Vec3d SolidTexture::colorAt(const Vec3d& place) const {
  const Vec3d p = place / scale_;
  const auto& colors = spec_.colors;
  switch (spec_.kind) {
    case TextureKind::kChecker:
      return colors[checkerAt(p, colors.size())];
    case TextureKind::kStripes:
      return colors[stripeAt(p.dot(axis_) + displacement(p), colors.size())];
    case TextureKind::kRings:
      return ringColor(p);
    case TextureKind::kMarble:
      return rampAt(colors, veinAt(p.dot(axis_) + displacement(p)));
    case TextureKind::kNoise: {
      constexpr double kContrast = 0.9;  // noise seldom comes near its bounds
      return rampAt(colors, 0.5 + kContrast * fractalNoise(p, spec_.octaves, spec_.seed));
    }
    case TextureKind::kGradient: {
      const double at = place.dot(axis_);
      if (from_ == to_) return colors[at < from_ ? 0 : colors.size() - 1];
      return rampAt(colors, (at - from_) / (to_ - from_));
    }
    case TextureKind::kBrick:
      return brickColor(p);
    case TextureKind::kImage:  // not solid
      break;
  }
  return Vec3d::Zero();
}

double SolidTexture::displacement(const Vec3d& p) const {
  if (spec_.turbulence == 0) return 0;
  return spec_.turbulence * fractalNoise(p, spec_.octaves, spec_.seed);
}

Vec3d SolidTexture::ringColor(const Vec3d& p) const {
  const Vec3d fromAxis = p - p.dot(axis_) * axis_;
  return rampAt(spec_.colors, ringAt(std::sqrt(fromAxis.dot(fromAxis)) + displacement(p)));
}

Vec3d SolidTexture::brickColor(const Vec3d& p) const {
  const BrickCell cell = brickAt(p, spec_.mortar, spec_.seed);
  const std::size_t bricks = spec_.colors.size() - 1;
  return spec_.colors[cell.mortar ? bricks : static_cast<std::size_t>(cell.hash % bricks)];
}

}  // namespace vox
