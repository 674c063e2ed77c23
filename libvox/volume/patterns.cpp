// Patterns in space, of unit size.

#include "libvox/volume/patterns.h"

#include "libvox/volume/noise.h"

#include <algorithm>
#include <cmath>

namespace vox {

std::size_t cyclic(std::int64_t i, std::size_t n) {
  const auto size = static_cast<std::int64_t>(n);
  return static_cast<std::size_t>((i % size + size) % size);
}

std::size_t checkerAt(const Vec3d& p, std::size_t n) {
  return cyclic(latticeCell(p.x()).cell + latticeCell(p.y()).cell + latticeCell(p.z()).cell, n);
}

std::size_t stripeAt(double x, std::size_t n) {
  return cyclic(latticeCell(x).cell, n);
}

double ringAt(double radius) {
  constexpr double kRise = 0.8;
  const double t = latticeCell(radius).inside;
  return t < kRise ? t / kRise : (1 - t) / (1 - kRise);
}

double veinAt(double x) {
  const double away = std::abs(2 * latticeCell(x + 0.5).inside - 1);  // 0 .. 1
  return away * (2 - away);
}

BrickCell brickAt(const Vec3d& p, double thickness, std::uint32_t seed) {
  constexpr double kPerWidth = 2;
  constexpr double kPerHeight = 3;
  const LatticeCell course = latticeCell(p.z() * kPerHeight);
  const double shift = cyclic(course.cell, 2) == 0 ? 0 : 0.5;
  const LatticeCell along = latticeCell(p.x() + shift);
  const LatticeCell across = latticeCell(p.y() * kPerWidth + shift);
  const auto toSide = [](const LatticeCell& at, double size) {
    return size * std::min(at.inside, 1 - at.inside);
  };
  const double nearest = std::min(
      {toSide(course, 1), toSide(across, kPerHeight / kPerWidth), toSide(along, kPerHeight)});
  return {nearest < thickness / 2, hashOfCell(along.cell, across.cell, course.cell, seed)};
}

Vec3d rampAt(std::span<const Vec3d> colors, double t) {
  const double inside = t > 0 ? std::min(t, 1.0) : 0;  // nan becomes 0
  const double place = inside * static_cast<double>(colors.size() - 1);
  const auto first = std::min(static_cast<std::size_t>(place), colors.size() - 2);
  const double part = place - static_cast<double>(first);
  return (1 - part) * colors[first] + part * colors[first + 1];
}

}  // namespace vox
