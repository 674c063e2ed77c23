// Closest points of patches and triangles: a tree of boxes, then branch and bound on the Bernstein
// coefficients of the squared distance, then Newton's method where they prove it convex.

#include "tests/closest_point.h"

#include "libvox/mesh/patch.h"
#include "libvox/mesh/triangulate.h"
#include "tests/limit_pieces.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

namespace vox::test {
namespace {

using Box = Eigen::AlignedBox3d;
using Triangle = std::array<Vec3d, 3>;

/// A binary tree of boxes.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    if (!boxes_.empty()) make(0, boxes_.size());
  }

  /// Calls visit(i) for the boxes i whose squared distance from p is less than bound(), near ones
  /// first.
  template <class Bound, class Visit>
  void visitNear(const Vec3d& p, Bound&& bound, Visit&& visit) const {
    if (!nodes_.empty()) descend(0, p, bound, visit);
  }

 private:
  static constexpr std::size_t kLeafSize = 2;

  struct Node {
    Box box;
    std::size_t begin, end;  // in order_
    std::size_t right = 0;   // the left child is the next node; 0: a leaf
  };

  std::size_t make(std::size_t begin, std::size_t end) {
    const std::size_t me = nodes_.size();
    nodes_.push_back({Box(), begin, end});
    Box box;
    for (std::size_t i = begin; i < end; ++i) box.extend(boxes_[order_[i]]);
    nodes_[me].box = box;
    if (end - begin <= kLeafSize) return me;
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    const std::size_t half = begin + (end - begin) / 2;
    std::nth_element(at(begin), at(half), at(end), [&](std::size_t a, std::size_t b) {
      return boxes_[a].center()[axis] < boxes_[b].center()[axis];
    });
    make(begin, half);
    const std::size_t right = make(half, end);
    nodes_[me].right = right;
    return me;
  }

  template <class Bound, class Visit>
  void descend(std::size_t n, const Vec3d& p, Bound& bound, Visit& visit) const {
    const Node& node = nodes_[n];
    if (node.right == 0) {
      for (std::size_t i = node.begin; i < node.end; ++i)
        if (boxes_[order_[i]].squaredExteriorDistance(p) < bound()) visit(order_[i]);
      return;
    }
    std::array<std::size_t, 2> child = {n + 1, node.right};
    std::array<double, 2> away = {nodes_[child[0]].box.squaredExteriorDistance(p),
                                  nodes_[child[1]].box.squaredExteriorDistance(p)};
    if (away[1] < away[0]) {
      std::swap(child[0], child[1]);
      std::swap(away[0], away[1]);
    }
    for (std::size_t k = 0; k < 2; ++k)
      if (away[k] < bound()) descend(child[k], p, bound, visit);
  }

  std::vector<Box> boxes_;
  std::vector<std::size_t> order_;
  std::vector<Node> nodes_;
};

/// Chooses pieces at random, in proportion to their areas.
class ByArea {
 public:
  void add(double area) { sums_.push_back(area + (sums_.empty() ? 0 : sums_.back())); }
  std::size_t at(double fraction) const {
    const auto found = std::upper_bound(sums_.begin(), sums_.end(), fraction * sums_.back());
    return std::min(static_cast<std::size_t>(found - sums_.begin()), sums_.size() - 1);
  }

 private:
  std::vector<double> sums_;
};

Surface::Foot footAt(const Vec3d& p, const Vec3d& point, const Vec3d& normal) {
  const Vec3d way = p - point;
  const double distance = way.norm();
  const double side = way.dot(normal);
  const double cosine = distance > 0 ? std::min(std::abs(side) / distance, 1.0) : 1;
  return {distance, side < 0 ? -distance : distance, point, normal, cosine};
}

/// The parts of a triangle: corner i, the side from corner i to the next one, the inside.
struct TrianglePlace {
  enum Part { kCorner, kSide, kInside } part;
  std::size_t number;
  Vec3d point;
};

/// Source: Ericson, Real-time collision detection, 2005, section 5.1.5.
TrianglePlace closestOf(const Triangle& t, const Vec3d& p) {
  const auto& [a, b, c] = t;
  const Vec3d ab = b - a;
  const Vec3d ac = c - a;
  const double d1 = ab.dot(p - a);
  const double d2 = ac.dot(p - a);
  if (d1 <= 0 && d2 <= 0) return {TrianglePlace::kCorner, 0, a};
  const double d3 = ab.dot(p - b);
  const double d4 = ac.dot(p - b);
  if (d3 >= 0 && d4 <= d3) return {TrianglePlace::kCorner, 1, b};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {TrianglePlace::kSide, 0, a + d1 / (d1 - d3) * ab};
  const double d5 = ab.dot(p - c);
  const double d6 = ac.dot(p - c);
  if (d6 >= 0 && d5 <= d6) return {TrianglePlace::kCorner, 2, c};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {TrianglePlace::kSide, 2, a + d2 / (d2 - d6) * ac};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6)
    return {TrianglePlace::kSide, 1, b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)};
  const double sum = va + vb + vc;
  return {TrianglePlace::kInside, 0, a + vb / sum * ab + vc / sum * ac};
}

Vec3d normalOf(const Triangle& t) {
  return normalOfTangents(t[1] - t[0], t[2] - t[0]);
}
double areaOf(const Triangle& t) {
  return (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2;
}
Box boxOf(const Triangle& t) {
  Box box;
  for (const Vec3d& corner : t) box.extend(corner);
  return box;
}
Vec3d randomPoint(const Triangle& t, double u, double v) {
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

/// A biquadratic polynomial over [0, 1]^2, by its Bezier points.
class BezierPatch {
 public:
  struct Jet {
    Vec3d s, su, sv, suu, suv, svv;  // the point and its derivatives
  };

  explicit BezierPatch(const Patch& spline) {
    std::array<std::array<Vec3d, 3>, 3> rows;
    for (std::size_t v = 0; v < 3; ++v) {
      const auto& p = spline.points;
      rows[0][v] = (p[0][v] + p[1][v]) / 2;
      rows[1][v] = p[1][v];
      rows[2][v] = (p[1][v] + p[2][v]) / 2;
    }
    for (std::size_t u = 0; u < 3; ++u)
      points_[u] = {(rows[u][0] + rows[u][1]) / 2, rows[u][1], (rows[u][1] + rows[u][2]) / 2};
  }

  const Vec3d& control(std::size_t u, std::size_t v) const { return points_[u][v]; }

  Jet at(double u, double v) const {
    const std::array<Vec3d, 3> a = {along(u, 0), along(u, 1), along(u, 2)};
    const std::array<Vec3d, 3> da = {slope(u, 0), slope(u, 1), slope(u, 2)};
    const std::array<Vec3d, 3> dda = {bend(0), bend(1), bend(2)};
    return {value(a, v), value(da, v), slopeOf(a, v), value(dda, v), slopeOf(da, v), bendOf(a)};
  }

  /// Outward unit normal. Where the surface has none, that of a point towards the middle.
  Vec3d normal(double u, double v) const {
    for (const double shift : {0.0, 1e-6, 1e-4, 1e-2, 1.0}) {
      const Jet jet = at(u + shift * (0.5 - u), v + shift * (0.5 - v));
      const Vec3d n = normalOfTangents(jet.su, jet.sv);
      if (!n.isZero(0)) return n;
    }
    return Vec3d::Zero();
  }

  Box box() const {
    Box box;
    for (const auto& row : points_)
      for (const Vec3d& p : row) box.extend(p);
    return box;
  }
  double area() const {  // about
    return (points_[2][2] - points_[0][0]).cross(points_[0][2] - points_[2][0]).norm() / 2;
  }

 private:
  static Vec3d value(const std::array<Vec3d, 3>& p, double t) {
    return (1 - t) * ((1 - t) * p[0] + t * p[1]) + t * ((1 - t) * p[1] + t * p[2]);
  }
  static Vec3d slopeOf(const std::array<Vec3d, 3>& p, double t) {
    return 2 * ((1 - t) * (p[1] - p[0]) + t * (p[2] - p[1]));
  }
  static Vec3d bendOf(const std::array<Vec3d, 3>& p) { return 2 * (p[0] - 2 * p[1] + p[2]); }
  std::array<Vec3d, 3> column(std::size_t v) const {
    return {points_[0][v], points_[1][v], points_[2][v]};
  }
  Vec3d along(double u, std::size_t v) const { return value(column(v), u); }
  Vec3d slope(double u, std::size_t v) const { return slopeOf(column(v), u); }
  Vec3d bend(std::size_t v) const { return bendOf(column(v)); }

  std::array<std::array<Vec3d, 3>, 3> points_;  // [u][v]
};

/// A part of the parameters of a patch.
struct Rectangle {
  std::array<double, 2> low = {0, 0};
  std::array<double, 2> high = {1, 1};
  double clamp(std::size_t axis, double t) const { return std::clamp(t, low[axis], high[axis]); }
};

/// A polynomial of degree 4 along u and v by its Bernstein coefficients: the squared distance of a
/// point from a patch.
class SquaredDistance {
 public:
  SquaredDistance(const BezierPatch& patch, const Vec3d& p) {
    constexpr std::array<double, 3> kOfTwo = {1, 2, 1};
    constexpr std::array<double, 5> kOfFour = {1, 4, 6, 4, 1};
    for (auto& row : b_) row.fill(0);
    for (std::size_t i = 0; i < 9; ++i)
      for (std::size_t j = 0; j < 9; ++j) {
        const std::size_t iu = i / 3, iv = i % 3, ju = j / 3, jv = j % 3;
        const double product = (patch.control(iu, iv) - p).dot(patch.control(ju, jv) - p);
        b_[iu + ju][iv + jv] += kOfTwo[iu] * kOfTwo[iv] * kOfTwo[ju] * kOfTwo[jv] * product /
                                (kOfFour[iu + ju] * kOfFour[iv + jv]);
      }
  }

  double lowerBound() const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& row : b_)
      for (const double b : row) least = std::min(least, b);
    return least;
  }
  /// The value at a corner of the rectangle.
  double corner(bool highU, bool highV) const { return b_[highU ? 4 : 0][highV ? 4 : 0]; }

  /// Whether bounds of the second derivatives prove strict convexity.
  bool isConvex() const {
    double uu = std::numeric_limits<double>::infinity();
    double vv = uu;
    double uv = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 5; ++j) {
        uu = std::min(uu, b_[i][j] - 2 * b_[i + 1][j] + b_[i + 2][j]);
        vv = std::min(vv, b_[j][i] - 2 * b_[j][i + 1] + b_[j][i + 2]);
      }
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        uv = std::max(uv, std::abs(b_[i][j] - b_[i + 1][j] - b_[i][j + 1] + b_[i + 1][j + 1]));
    return uu > 0 && vv > 0 && 12 * uu * 12 * vv > 16 * uv * 16 * uv;
  }

  /// The axis along which the coefficients differ more.
  std::size_t longAxis() const {
    double u = 0;
    double v = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 5; ++j) {
        u = std::max(u, std::abs(b_[i + 1][j] - b_[i][j]));
        v = std::max(v, std::abs(b_[j][i + 1] - b_[j][i]));
      }
    return u >= v ? 0 : 1;
  }

  /// The polynomial over the two halves of the rectangle, by de Casteljau's algorithm.
  std::array<SquaredDistance, 2> halves(std::size_t axis) const {
    std::array<SquaredDistance, 2> halves = {*this, *this};
    for (std::size_t line = 0; line < 5; ++line) {
      const auto at = [&](SquaredDistance& d, std::size_t i) -> double& {
        return axis == 0 ? d.b_[i][line] : d.b_[line][i];
      };
      for (std::size_t step = 0; step < 4; ++step) {
        for (std::size_t i = 4; i > step; --i)
          at(halves[0], i) = (at(halves[0], i) + at(halves[0], i - 1)) / 2;
        for (std::size_t i = 0; i + step < 4; ++i)
          at(halves[1], i) = (at(halves[1], i) + at(halves[1], i + 1)) / 2;
      }
    }
    return halves;
  }

 private:
  std::array<std::array<double, 5>, 5> b_;
};

/// A convex quadratic function of two variables: gradient at the origin and second derivatives.
struct Quadratic {
  double gu, gv, huu, huv, hvv;
  double at(double u, double v) const {
    return gu * u + gv * v + (huu * u * u + hvv * v * v) / 2 + huv * u * v;
  }
  /// The minimum in a rectangle: inside, or the best of the four sides.
  std::array<double, 2> minimum(const Rectangle& r) const {
    const double det = huu * hvv - huv * huv;
    const double u = (huv * gv - hvv * gu) / det;
    const double v = (huv * gu - huu * gv) / det;
    if (r.clamp(0, u) == u && r.clamp(1, v) == v) return {u, v};
    std::array<double, 2> best = {r.clamp(0, 0), r.clamp(1, 0)};
    const auto consider = [&](double a, double b) {
      if (at(a, b) < at(best[0], best[1])) best = {a, b};
    };
    for (const double a : {r.low[0], r.high[0]}) consider(a, r.clamp(1, -(gv + huv * a) / hvv));
    for (const double b : {r.low[1], r.high[1]}) consider(r.clamp(0, -(gu + huv * b) / huu), b);
    return best;
  }
};

/// Searches for the point of some patches that is closest to p.
class PatchSearch {
 public:
  PatchSearch(const Vec3d& p, double bound2) : p_(p), best2_(bound2) {}

  double best2() const { return best2_; }
  const BezierPatch* patch() const { return patch_; }
  double u() const { return u_; }
  double v() const { return v_; }

  void consider(const BezierPatch& patch) {
    search(patch, SquaredDistance(patch, p_), {}, kMostHalvings);
  }

 private:
  static constexpr int kMostHalvings = 40;  // 20 along each axis
  static constexpr double kDistanceSlack = 1e-11;

  void search(const BezierPatch& patch, const SquaredDistance& d, const Rectangle& r,
              int halvings) {
    for (const bool highU : {false, true})
      for (const bool highV : {false, true})
        if (d.corner(highU, highV) < best2_)
          take(patch, highU ? r.high[0] : r.low[0], highV ? r.high[1] : r.low[1]);
    if (d.lowerBound() > best2_ - kDistanceSlack * std::sqrt(best2_)) return;
    if (halvings == 0 || d.isConvex()) return descend(patch, r);

    const std::size_t axis = d.longAxis();
    const std::array<SquaredDistance, 2> halves = d.halves(axis);
    std::array<Rectangle, 2> parts = {r, r};
    parts[0].high[axis] = parts[1].low[axis] = (r.low[axis] + r.high[axis]) / 2;
    const std::size_t first = halves[0].lowerBound() <= halves[1].lowerBound() ? 0 : 1;
    for (const std::size_t k : {first, 1 - first}) search(patch, halves[k], parts[k], halvings - 1);
  }

  /// Newton's method in a rectangle, with the step to the minimum of the quadratic model there, cut
  /// in half until the distance falls.
  void descend(const BezierPatch& patch, const Rectangle& r) {
    constexpr int kMostSteps = 60;
    constexpr double kSmallStep = 1e-5;  // from here on, Newton's method squares the error
    constexpr double kLastStep = 1e-13;
    double u = (r.low[0] + r.high[0]) / 2;
    double v = (r.low[1] + r.high[1]) / 2;
    for (int k = 0; k < kMostSteps; ++k) {
      const BezierPatch::Jet jet = patch.at(u, v);
      const auto target =
          modelAt(jet).minimum({{r.low[0] - u, r.low[1] - v}, {r.high[0] - u, r.high[1] - v}});
      const double size = std::max(std::abs(target[0]), std::abs(target[1]));
      double scale = 1;
      const double now = (p_ - jet.s).squaredNorm();
      if (size > kSmallStep)
        while (scale > kLastStep &&
               distance2(patch, u + scale * target[0], v + scale * target[1]) > now)
          scale /= 2;
      u = r.clamp(0, u + scale * target[0]);
      v = r.clamp(1, v + scale * target[1]);
      if (size * scale < kLastStep) break;
    }
    take(patch, u, v);
  }

  /// Half the squared distance as a quadratic function of a step, by its second derivatives, or
  /// Gauss-Newton where these are not those of a convex function.
  Quadratic modelAt(const BezierPatch::Jet& jet) const {
    const Vec3d way = p_ - jet.s;
    const double e = jet.su.squaredNorm(), f = jet.su.dot(jet.sv), g = jet.sv.squaredNorm();
    Quadratic q{-way.dot(jet.su), -way.dot(jet.sv), e - way.dot(jet.suu), f - way.dot(jet.suv),
                g - way.dot(jet.svv)};
    constexpr double kTiny = 1e-9;
    if (q.huu <= kTiny * e || q.hvv <= kTiny * g ||
        q.huu * q.hvv - q.huv * q.huv <= kTiny * q.huu * q.hvv) {
      const double more = kTiny * (e + g) + std::numeric_limits<double>::min();
      q.huu = e + more;
      q.huv = f;
      q.hvv = g + more;
    }
    return q;
  }

  double distance2(const BezierPatch& patch, double u, double v) const {
    return (p_ - patch.at(u, v).s).squaredNorm();
  }

  void take(const BezierPatch& patch, double u, double v) {
    const double d2 = distance2(patch, u, v);
    if (d2 >= best2_) return;
    best2_ = d2;
    patch_ = &patch;
    u_ = u;
    v_ = v;
  }

  Vec3d p_;
  double best2_;
  const BezierPatch* patch_ = nullptr;
  double u_ = 0;
  double v_ = 0;
};

}  // namespace

class ClosestPoint::Pieces {
 public:
  explicit Pieces(const LimitPieces& pieces)
      : patches_(pieces.patches.begin(), pieces.patches.end()),
        triangles_(pieces.triangles),
        patchTree_(boxesOf(patches_)),
        triangleTree_(boxesOf(triangles_)) {
    for (const BezierPatch& patch : patches_) byArea_.add(patch.area());
    for (const Triangle& triangle : triangles_) byArea_.add(areaOf(triangle));
  }

  Foot of(const Vec3d& p) const {
    PatchSearch search(p, std::numeric_limits<double>::infinity());
    patchTree_.visitNear(
        p, [&] { return search.best2(); }, [&](std::size_t i) { search.consider(patches_[i]); });
    double best2 = search.best2();
    const Triangle* nearest = nullptr;
    Vec3d point = Vec3d::Zero();
    triangleTree_.visitNear(
        p, [&] { return best2; },
        [&](std::size_t i) {
          const Vec3d candidate = closestOf(triangles_[i], p).point;
          if ((candidate - p).squaredNorm() >= best2) return;
          best2 = (candidate - p).squaredNorm();
          nearest = &triangles_[i];
          point = candidate;
        });
    if (nearest != nullptr) return footAt(p, point, normalOf(*nearest));
    if (search.patch() == nullptr) return {best2, best2, p, Vec3d::Zero(), 0};  // no surface
    const BezierPatch& patch = *search.patch();
    return footAt(p, patch.at(search.u(), search.v()).s, patch.normal(search.u(), search.v()));
  }

  Sample sample(std::uint64_t number) const {
    const std::size_t i = byArea_.at(mixedFraction(3 * number));
    const double u = mixedFraction(3 * number + 1);
    const double v = mixedFraction(3 * number + 2);
    if (i < patches_.size()) return {patches_[i].at(u, v).s, patches_[i].normal(u, v)};
    const Triangle& triangle = triangles_[i - patches_.size()];
    return {randomPoint(triangle, u, v), normalOf(triangle)};
  }

 private:
  static std::vector<Box> boxesOf(const std::vector<BezierPatch>& patches) {
    std::vector<Box> boxes;
    for (const BezierPatch& patch : patches) boxes.push_back(patch.box());
    return boxes;
  }
  static std::vector<Box> boxesOf(const std::vector<Triangle>& triangles) {
    std::vector<Box> boxes;
    for (const Triangle& triangle : triangles) boxes.push_back(boxOf(triangle));
    return boxes;
  }

  std::vector<BezierPatch> patches_;
  std::vector<Triangle> triangles_;
  BoxTree patchTree_;
  BoxTree triangleTree_;
  ByArea byArea_;
};

ClosestPoint::ClosestPoint(const SubdivisionLevel& base, int levels)
    : pieces_(std::make_unique<Pieces>(limitPieces(base, levels))) {}
ClosestPoint::~ClosestPoint() = default;
Surface::Foot ClosestPoint::of(const Vec3d& p) const {
  return pieces_->of(p);
}
Surface::Sample ClosestPoint::sample(std::uint64_t number) const {
  return pieces_->sample(number);
}

class ClosestPolygon::Triangles {
 public:
  explicit Triangles(const PolygonMesh& mesh)
      : points_(mesh.points),
        corners_(trianglesOf(mesh)),
        cornerNormals_(points_.size(), Vec3d::Zero()),
        tree_(boxes()) {
    for (std::size_t i = 0; i < corners_.size(); ++i) addNormals(i);
    for (const auto& [ends, side] : sides_)
      if (side.triangles != 2) open_.insert(open_.end(), {ends.first, ends.second});
    std::sort(open_.begin(), open_.end());
    for (std::size_t i = 0; i < corners_.size(); ++i) byArea_.add(areaOf(triangle(i)));
  }

  Foot of(const Vec3d& p) const {
    double best2 = std::numeric_limits<double>::infinity();
    std::size_t nearest = 0;
    TrianglePlace place{TrianglePlace::kInside, 0, p};
    tree_.visitNear(
        p, [&] { return best2; },
        [&](std::size_t i) {
          const TrianglePlace candidate = closestOf(triangle(i), p);
          if ((candidate.point - p).squaredNorm() >= best2) return;
          best2 = (candidate.point - p).squaredNorm();
          nearest = i;
          place = candidate;
        });
    if (corners_.empty()) return {best2, best2, p, Vec3d::Zero(), 0};
    const auto [normal, closed] = normalAt(nearest, place);
    Foot foot = footAt(p, place.point, normal);
    if (closed) foot.cosine = 1;
    return foot;
  }

  Sample sample(std::uint64_t number) const {
    const Triangle t = triangle(byArea_.at(mixedFraction(3 * number)));
    return {randomPoint(t, mixedFraction(3 * number + 1), mixedFraction(3 * number + 2)),
            normalOf(t)};
  }

 private:
  using Ends = std::pair<Index, Index>;
  struct Side {
    Vec3d normal = Vec3d::Zero();
    int triangles = 0;
  };

  static std::vector<std::array<Index, 3>> trianglesOf(const PolygonMesh& mesh) {
    std::vector<std::array<Index, 3>> triangles;
    FaceTriangulator triangulator;
    for (Index f = 0; f < mesh.faceCount(); ++f) triangulator.add(mesh, f, triangles);
    return triangles;
  }

  std::vector<Box> boxes() const {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < corners_.size(); ++i) boxes.push_back(boxOf(triangle(i)));
    return boxes;
  }

  Triangle triangle(std::size_t i) const {
    const auto& [a, b, c] = corners_[i];
    return {points_[a], points_[b], points_[c]};
  }

  Ends endsOf(std::size_t i, std::size_t side) const {
    const Index a = corners_[i][side];
    const Index b = corners_[i][(side + 1) % 3];
    return {std::min(a, b), std::max(a, b)};
  }

  void addNormals(std::size_t i) {
    const Triangle t = triangle(i);
    const Vec3d normal = normalOf(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d a = t[(k + 1) % 3] - t[k];
      const Vec3d b = t[(k + 2) % 3] - t[k];
      cornerNormals_[corners_[i][k]] += std::atan2(a.cross(b).norm(), a.dot(b)) * normal;
      Side& side = sides_[endsOf(i, k)];
      side.normal += normal;
      ++side.triangles;
    }
  }

  /// The normal at a place, and whether the surface goes on all around it.
  std::pair<Vec3d, bool> normalAt(std::size_t i, const TrianglePlace& place) const {
    if (place.part == TrianglePlace::kInside) return {normalOf(triangle(i)), true};
    if (place.part == TrianglePlace::kSide) {
      const Side& side = sides_.at(endsOf(i, place.number));
      return {side.normal.stableNormalized(), side.triangles == 2};
    }
    const Index v = corners_[i][place.number];
    return {cornerNormals_[v].stableNormalized(),
            !std::binary_search(open_.begin(), open_.end(), v)};
  }

  std::vector<Vec3d> points_;
  std::vector<std::array<Index, 3>> corners_;
  std::vector<Vec3d> cornerNormals_;  // per point
  std::map<Ends, Side> sides_;
  std::vector<Index> open_;  // points on boundary edges
  BoxTree tree_;
  ByArea byArea_;
};

ClosestPolygon::ClosestPolygon(const PolygonMesh& mesh)
    : triangles_(std::make_unique<Triangles>(mesh)) {}
ClosestPolygon::~ClosestPolygon() = default;
Surface::Foot ClosestPolygon::of(const Vec3d& p) const {
  return triangles_->of(p);
}
Surface::Sample ClosestPolygon::sample(std::uint64_t number) const {
  return triangles_->sample(number);
}

}  // namespace vox::test
