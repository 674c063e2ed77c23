#include "tests/spline_torus.h"

#include "tests/shapes.h"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <limits>

namespace vox::test {
namespace {

/// Values and derivatives of the three quadratic B-splines over [0, 1].
struct Basis {
  std::array<double, 3> b, d, dd;
  explicit Basis(double t)
      : b{(1 - t) * (1 - t) / 2, 0.5 + t - t * t, t * t / 2},
        d{t - 1, 1 - 2 * t, t},
        dd{1, -2, 1} {}
};

}  // namespace

SplineTorus::SplineTorus(int major, int minor)
    : major_(major), minor_(minor), controls_(torusGrid(major, minor).points) {
  for (int i = 0; i < major * kSamples; ++i)
    for (int j = 0; j < minor * kSamples; ++j)
      samples_.push_back(at(double(i) / kSamples, double(j) / kSamples));
}

SplineTorus::Frame SplineTorus::frame(double u, double v) const {
  const int i = static_cast<int>(std::floor(u));
  const int j = static_cast<int>(std::floor(v));
  const Basis bu(u - i);
  const Basis bv(v - j);
  const auto wrap = [](int a, int n) { return ((a % n) + n) % n; };
  Frame f{Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero()};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      const std::size_t x = static_cast<std::size_t>(a);
      const std::size_t y = static_cast<std::size_t>(b);
      const Vec3d& p =
          controls_[static_cast<std::size_t>(wrap(i + a, major_) * minor_ + wrap(j + b, minor_))];
      f.at += bu.b[x] * bv.b[y] * p;
      f.du += bu.d[x] * bv.b[y] * p;
      f.dv += bu.b[x] * bv.d[y] * p;
      f.duu += bu.dd[x] * bv.b[y] * p;
      f.duv += bu.d[x] * bv.d[y] * p;
      f.dvv += bu.b[x] * bv.dd[y] * p;
    }
  return f;
}

Vec3d SplineTorus::at(double u, double v) const {
  return frame(u, v).at;
}

Vec3d SplineTorus::normalAt(double u, double v) const {
  const Frame f = frame(u, v);
  return f.du.cross(f.dv).normalized();
}

double SplineTorus::volume() const {
  // Degree 5 in each parameter.
  const std::array<double, 3> nodes = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
  const std::array<double, 3> weights = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  double volume = 0;
  for (int i = 0; i < major_; ++i)
    for (int j = 0; j < minor_; ++j)
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) {
          const Frame f = frame(i + nodes[a], j + nodes[b]);
          volume += weights[a] * weights[b] * f.at.dot(f.du.cross(f.dv)) / 3;
        }
  return volume;
}

std::array<double, 2> SplineTorus::nearest(const Vec3d& point) const {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < samples_.size(); ++s)
    if (const double d = (samples_[s] - point).squaredNorm(); d < least) {
      least = d;
      nearest = s;
    }
  const auto columns = static_cast<std::size_t>(minor_ * kSamples);
  double u = static_cast<double>(nearest / columns) / kSamples;
  double v = static_cast<double>(nearest % columns) / kSamples;
  for (int step = 0; step < 12; ++step) {
    const Frame f = frame(u, v);
    const Vec3d r = f.at - point;
    const Eigen::Vector2d gradient(r.dot(f.du), r.dot(f.dv));
    Eigen::Matrix2d hessian;
    hessian << f.du.dot(f.du) + r.dot(f.duu), f.du.dot(f.dv) + r.dot(f.duv),
        f.du.dot(f.dv) + r.dot(f.duv), f.dv.dot(f.dv) + r.dot(f.dvv);
    const Eigen::Vector2d move = hessian.ldlt().solve(gradient);
    u -= move.x();
    v -= move.y();
  }
  return {u, v};
}

double SplineTorus::distance(const Vec3d& point) const {
  const auto [u, v] = nearest(point);
  const Vec3d r = point - at(u, v);
  return r.dot(normalAt(u, v)) < 0 ? -r.norm() : r.norm();
}

Vec3d SplineTorus::normalNear(const Vec3d& point) const {
  const auto [u, v] = nearest(point);
  return normalAt(u, v);
}

}  // namespace vox::test
