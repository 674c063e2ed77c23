// Whether small triangles can fill a strip of a patch, from the vertices around it alone.

#include "libvox/subdivide/patch_strips.h"

#include "libvox/subdivide/stop.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vox {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

/// The quadratic on which n descendants of three control points lie: number j at (j + 1/2) / n.
Quadratic quadraticThrough(const CurvePoints& p, std::int64_t n) {
  const double square = static_cast<double>(n) * static_cast<double>(n);
  const Vec3d offset = (p[0] - 2.0 * p[1] + p[2]) / (8 * square);
  return {(p[0] + p[1]) / 2.0 - offset, p[1] - offset, (p[1] + p[2]) / 2.0 - offset};
}

/// The part of a quadratic from a to b, by its polar form.
Quadratic partOf(const Quadratic& q, double a, double b) {
  const auto at = [&](double s, double t) {
    return Vec3d((1 - s) * (1 - t) * q[0] + (s * (1 - t) + t * (1 - s)) * q[1] + s * t * q[2]);
  };
  return {at(a, a), at(a, b), at(b, b)};
}

/// A box that holds some vectors and 0.
struct Box {
  Vec3d low = Vec3d::Zero();
  Vec3d high = Vec3d::Zero();
  void add(const Vec3d& vector) {
    low = low.cwiseMin(vector);
    high = high.cwiseMax(vector);
  }
  Vec3d size() const { return high - low; }
};

/// Parameter of a curve at which it is closest, about, to a point.
/// @param d  vector from the start of the curve to the point
/// @param a  tangent of the curve at its start
/// @param h  second derivative of the curve
double placeAlong(const Vec3d& d, const Vec3d& a, const Vec3d& h) {
  const double aa = a.squaredNorm();
  if (!(aa > 0)) return 0;
  const double ha = h.dot(a);
  const double da = d.dot(a);
  double place = da / aa;
  constexpr int kNewtonSteps = 2;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const double slope = aa + place * ha;
    if (!(slope > aa / 4)) return da / aa;
    place -= (place * aa + place * place / 2 * ha - da) / slope;
  }
  return place;
}

/// One number for each of the four sides of a walk.
using Lanes = Eigen::Array4d;

/// Polynomials on 0 .. 1, one for each side, as Bernstein coefficients times binomial coefficients:
/// in this form, products of polynomials are convolutions of the lists.
template <std::size_t kSize>
using Polynomials = std::array<Lanes, kSize>;

template <std::size_t kSizeA, std::size_t kSizeB>
Polynomials<kSizeA + kSizeB - 1> operator*(const Polynomials<kSizeA>& a,
                                           const Polynomials<kSizeB>& b) {
  Polynomials<kSizeA + kSizeB - 1> product;
  for (Lanes& lanes : product) lanes.setZero();
  for (std::size_t i = 0; i < kSizeA; ++i)
    for (std::size_t j = 0; j < kSizeB; ++j) product[i + j] += a[i] * b[j];
  return product;
}

/// The sides of a walk: quadratics for each of the three coordinates.
using Sides = std::array<Polynomials<3>, 3>;

Sides sidesOf(const std::array<Quadratic, 4>& curves, const Vec3d& origin) {
  Sides sides;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t side = 0; side < curves.size(); ++side) {
      const auto at = [&](std::size_t k) {
        const auto a = static_cast<Eigen::Index>(axis);
        return curves[side][k][a] - origin[a];
      };
      const auto lane = static_cast<Eigen::Index>(side);
      sides[axis][0][lane] = at(0);
      sides[axis][1][lane] = 2 * at(1);
      sides[axis][2][lane] = at(2);
    }
  return sides;
}

constexpr std::size_t kCubic = 4;
using Cubic = std::array<Vec3d, kCubic>;  // Bernstein coefficients

/// The cubic closest to the sides, by least squares at some points of each side.
/// @param places  the parameters of the cubic along each side
Cubic cubicAlong(const Sides& sides, const Polynomials<3>& places) {
  std::array<std::array<Lanes, kCubic>, kCubic> products;
  std::array<std::array<Lanes, 3>, kCubic> moments;
  for (std::size_t k = 0; k < kCubic; ++k) {
    for (Lanes& lanes : products[k]) lanes.setZero();
    for (Lanes& lanes : moments[k]) lanes.setZero();
  }
  constexpr int kSamples = 4;
  for (int sample = 0; sample <= kSamples; ++sample) {
    const double t = static_cast<double>(sample) / kSamples;
    const auto at = [&](const Polynomials<3>& q) {
      return Lanes((1 - t) * (1 - t) * q[0] + t * (1 - t) * q[1] + t * t * q[2]);
    };
    const Lanes s = at(places);
    const Lanes r = 1 - s;
    const std::array<Lanes, kCubic> weights = {r * r * r, 3 * s * r * r, 3 * s * s * r, s * s * s};
    const std::array<Lanes, 3> point = {at(sides[0]), at(sides[1]), at(sides[2])};
    for (std::size_t a = 0; a < kCubic; ++a) {
      for (std::size_t b = 0; b <= a; ++b) products[a][b] += weights[a] * weights[b];
      for (std::size_t axis = 0; axis < 3; ++axis) moments[a][axis] += weights[a] * point[axis];
    }
  }
  Eigen::Matrix4d matrix;
  Eigen::Matrix<double, kCubic, 3> values;
  for (std::size_t a = 0; a < kCubic; ++a) {
    const auto row = static_cast<Eigen::Index>(a);
    for (std::size_t b = 0; b <= a; ++b) {
      const auto column = static_cast<Eigen::Index>(b);
      matrix(row, column) = matrix(column, row) = products[a][b].sum();
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
      values(row, static_cast<Eigen::Index>(axis)) = moments[a][axis].sum();
  }
  const Eigen::Matrix<double, kCubic, 3> solution = matrix.inverse() * values;
  return {solution.row(0), solution.row(1), solution.row(2), solution.row(3)};
}

/// A box of the differences between the sides and a cubic, which are polynomials of degree 6.
/// @param s  the parameters of the cubic along each side
Box differencesFrom(const Cubic& cubic, const Sides& sides, const Polynomials<3>& s) {
  const Polynomials<3> one = {Lanes::Constant(1), Lanes::Constant(2), Lanes::Constant(1)};
  const Polynomials<3> r = {one[0] - s[0], one[1] - s[1], one[2] - s[2]};
  const Polynomials<5> ss = s * s;
  const Polynomials<5> rr = r * r;
  const std::array<Polynomials<7>, kCubic> powers = {rr * r, rr * s, ss * r, ss * s};
  constexpr std::array<double, kCubic> kThrice = {1, 3, 3, 1};
  constexpr std::array<double, 7> kBinomials = {1, 6, 15, 20, 15, 6, 1};
  const Polynomials<5> whole = one * one;
  Box box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const Polynomials<7> side = sides[axis] * whole;
    for (std::size_t k = 0; k < kBinomials.size(); ++k) {
      Lanes difference = side[k];
      for (std::size_t c = 0; c < kCubic; ++c)
        difference -= kThrice[c] * cubic[c][a] * powers[c][k];
      difference /= kBinomials[k];
      box.low[a] = std::min(box.low[a], difference.minCoeff());
      box.high[a] = std::max(box.high[a], difference.maxCoeff());
    }
  }
  return box;
}

/// The Bernstein coefficient of some curves that is farthest from a point.
Vec3d farthestFrom(const Vec3d& from, const std::array<Quadratic, 4>& curves) {
  Vec3d farthest = from;
  double most = 0;
  for (const Quadratic& curve : curves)
    for (const Vec3d& point : curve)
      if (const double square = (point - from).squaredNorm(); square > most) {
        most = square;
        farthest = point;
      }
  return farthest;
}

/// Whether the strip between two rows has too much area to lie along a curve.
bool isWide(const Quadratic& first, const Quadratic& second) {
  const auto middle = [](const Quadratic& q) { return Vec3d((q[0] + 2.0 * q[1] + q[2]) / 4.0); };
  const Vec3d a = middle(first);
  const Vec3d b = middle(second);
  const double area =
      ((b - first[0]).cross(a - second[0])).norm() + ((second[2] - a).cross(first[2] - b)).norm();
  const double length = std::max({(first[2] - first[0]).norm(), (second[2] - second[0]).norm(),
                                  (second[2] - first[0]).norm(), (second[0] - first[2]).norm()});
  return area > length;
}

}  // namespace

PatchStrips::PatchStrips(const Patch& patch, int levels)
    : patch_(patch), n_(std::int64_t{1} << levels) {
  const auto& p = patch.points;
  CurvePoints bend;
  for (std::size_t v = 0; v < 3; ++v) bend[v] = p[0][v] - 2.0 * p[1][v] + p[2][v];
  bendAcross_ = quadraticThrough(bend, n_);
  for (const std::size_t end : {0U, 1U}) {
    const PatchWeights weights(end == 0 ? 0 : n_ - 1, n_);
    CurvePoints column;
    for (std::size_t u = 0; u < 3; ++u) column[u] = weights(p[u][0], p[u][1], p[u][2]);
    columns_[end] = quadraticThrough(column, n_);
  }
}

bool PatchStrips::fillable(std::int64_t i, std::int64_t j) const {
  const Strip strip = {row(i), row(j), placeAcross(i), placeAcross(j), static_cast<double>(j - i)};
  return longestSideAlongRow(strip) <= kVertexConversionSpan ||
         longestSideAlongCubic(strip) <= kVertexConversionSpan;
}

Quadratic PatchStrips::row(std::int64_t i) const {
  return quadraticThrough(rowOf(patch_, {i, n_}), n_);
}

double PatchStrips::placeAcross(std::int64_t i) const {
  return (static_cast<double>(i) + 0.5) / static_cast<double>(n_);
}

/// The curve is the first row, continued beyond its ends; x runs from 0 to 1 along the row, and f
/// from 0 to 1 across the strip. A point of the strip is
///   S(f, x) = S(0, x) + f D(x) - f (1 - f) / 2 w^2 G(x),
/// where D leads from the first row to the second, w is the width of the strip, and G the second
/// derivative across. The point of the curve with parameter s = x + f sigma(x) is
///   S(0, s) = S(0, x) + f sigma(x) S'(x) + f^2 sigma(x)^2 / 2 H,
/// where S' is linear from A to B, and H = B - A. The difference of the two is
///   f (D - sigma S' - sigma^2 / 2 H) + f (1 - f) / 2 (sigma^2 H - w^2 G).
/// With sigma linear in x, it is quadratic in x.
double PatchStrips::longestSideAlongRow(const Strip& strip) const {
  const auto& [first, second, from, to, steps] = strip;
  const Vec3d a = 2.0 * (first[1] - first[0]);
  const Vec3d b = 2.0 * (first[2] - first[1]);
  const Vec3d h = b - a;
  const Quadratic d = {second[0] - first[0], second[1] - first[1], second[2] - first[2]};
  const double start = placeAlong(d[0], a, h);
  const double end = placeAlong(d[2], b, h);
  const double most = std::max(std::abs(start), std::abs(end));
  constexpr double kFarBeyond = 1e3;  // lengths of the row: the bound would be useless
  if (!(most < kFarBeyond)) return kNoBound;
  const double width = to - from;
  const std::array<double, 3> squares = {start * start, start * end, end * end};
  const Quadratic along = {start * a, (start * b + end * a) / 2.0, end * b};
  Box across;
  Box bulge;
  for (std::size_t k = 0; k < 3; ++k) {
    across.add(d[k] - along[k] - squares[k] / 2 * h);
    bulge.add(squares[k] * h - width * width * bendAcross_[k]);
  }
  const double step = std::max((1 + std::abs(end - start)) / static_cast<double>(n_), most / steps);
  const Vec3d speed = a.cwiseAbs().cwiseMax(b.cwiseAbs()) + most * h.cwiseAbs();
  return (step * speed + across.size() + bulge.size() / 8.0).maxCoeff();
}

/// The curve is a cubic, fitted to the walk; its parameter s runs from 0 to 1 along a straight
/// line. For strips whose rows turn back on themselves.
double PatchStrips::longestSideAlongCubic(const Strip& strip) const {
  const auto& [first, second, from, to, steps] = strip;
  if (isWide(first, second)) return kNoBound;
  const std::array<Quadratic, 4> curves = {first, second, partOf(columns_[0], from, to),
                                           partOf(columns_[1], from, to)};
  const Vec3d start = farthestFrom(curves[0][0], curves);
  const Vec3d line = farthestFrom(start, curves) - start;
  const Sides sides = sidesOf(curves, start);

  Polynomials<3> places;
  for (std::size_t k = 0; k < 3; ++k)
    places[k] = line[0] * sides[0][k] + line[1] * sides[1][k] + line[2] * sides[2][k];
  const Lanes low = places[0].min(places[1] / 2).min(places[2]);
  const Lanes high = places[0].max(places[1] / 2).max(places[2]);
  const double least = low.minCoeff();
  const double range = high.maxCoeff() - least;
  places[0] = (places[0] - least) / range;
  places[1] = (places[1] - 2 * least) / range;
  places[2] = (places[2] - least) / range;
  const Lanes change = (places[1] / 2 - places[0]).abs().max((places[2] - places[1] / 2).abs());
  const auto columns = static_cast<double>(n_);
  const double step = (2 * change / Lanes(columns, columns, steps, steps)).maxCoeff();

  const Cubic cubic = cubicAlong(sides, places);
  if (!std::all_of(cubic.begin(), cubic.end(), [](const Vec3d& c) { return c.allFinite(); }))
    return kNoBound;
  Vec3d speed = Vec3d::Zero();
  for (std::size_t k = 0; k + 1 < kCubic; ++k)
    speed = speed.cwiseMax(3.0 * (cubic[k + 1] - cubic[k]).cwiseAbs());
  return (step * speed + differencesFrom(cubic, sides, places).size()).maxCoeff();
}

}  // namespace vox
