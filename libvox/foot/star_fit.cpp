// The limit surface around a vertex within triangles as a height.

#include "libvox/foot/star_fit.h"

#include "libvox/foot/fit_sums.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace vox {
namespace {

constexpr double kSteepest = 0.5;  // slope above the rectangle

/// A limit point in the frame of the star.
struct FramePoint {
  double a, b, height;
};

struct Frame {
  Vec3d origin;
  std::array<Vec3d, 3> axes;

  FramePoint of(const Vec3d& point) const {
    const Vec3d d = point - origin;
    return {d.dot(axes[0]), d.dot(axes[1]), d.dot(axes[2])};
  }
};

/// Turns the frame so that a runs along the longer extent of the star.
void turnToLonger(const TriangleStar& star, Frame& frame) {
  double aa = 0, ab = 0, bb = 0;
  for (const Vec3d& point : star.ring) {
    const FramePoint p = frame.of(point);
    aa += p.a * p.a, ab += p.a * p.b, bb += p.b * p.b;
  }
  const double cosine = aa - bb + std::sqrt((aa - bb) * (aa - bb) + 4 * ab * ab);
  const Vec3d along = cosine * frame.axes[0] + 2 * ab * frame.axes[1];
  constexpr double kNearlyRound = 1e-6;
  if (along.squaredNorm() <= kNearlyRound * (aa + bb) * (aa + bb)) return;
  frame.axes[0] = along.normalized();
  frame.axes[1] = frame.axes[2].cross(frame.axes[0]);
}

std::optional<Frame> frameOf(const TriangleStar& star) {
  const std::size_t n = star.ring.size();
  Vec3d up = Vec3d::Zero();
  for (std::size_t k = 0; k < n; ++k)
    up += (star.ring[k] - star.centre).cross(star.ring[(k + 1) % n] - star.centre);
  const double size = up.norm();
  if (!(size > 0)) return {};
  up /= size;
  const Vec3d across = up.cross(star.ring[0] - star.centre);
  if (!(across.squaredNorm() > 0)) return {};
  const Vec3d alongB = across.normalized();
  Frame frame{star.centre, {alongB.cross(up), alongB, up}};
  turnToLonger(star, frame);
  return frame;
}

/// The limit points of a star.
struct StarPoints {
  static constexpr std::size_t kMost = 1 + 4 * kMostOfStar;
  std::array<FramePoint, kMost> points;  // the border, the inner ones, those around
  std::size_t border, within, count;     // ends of these

  StarPoints(const TriangleStar& star, const Frame& frame) {
    const std::size_t n = star.ring.size();
    border = 2 * n, within = 1 + 3 * n, count = 1 + 4 * n;
    const Vec3d& c = star.centre;
    Vec3d sum = Vec3d::Zero();
    for (const Vec3d& r : star.ring) sum += r;
    const Vec3d ofVertex = (2.0 * c + sum / static_cast<double>(n)) / 3.0;
    points[border] = frame.of(ofVertex);
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3d &before = star.ring[(k + n - 1) % n], &r = star.ring[k],
                  &s = star.ring[(k + 1) % n], &after = star.ring[(k + 2) % n];
      points[2 * k] = frame.of(ofEdge(c, r, before, s));
      points[2 * k + 1] = frame.of((c + r + s) / 3.0);
      points[border + 1 + k] = frame.of(ofCorner(star, {before, r, s, after}, ofVertex));
      points[within + k] = frame.of(ofEdge(r, s, c, star.outer[k]));
    }
  }

  const FramePoint& vertex() const { return points[border]; }
  std::span<const FramePoint> onBorder() const { return std::span(points).first(border); }
  std::span<const FramePoint> around() const {
    return std::span(points).subspan(within, count - within);
  }

 private:
  /// The image of a in the triangle a, b, c.
  static Vec3d image(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return (4.0 * a + b + c) / 6.0;
  }
  /// The centroid of the face that an edge from a to b becomes.
  static Vec3d ofEdge(const Vec3d& a, const Vec3d& b, const Vec3d& left, const Vec3d& right) {
    return (5.0 * (a + b) + left + right) / 12.0;
  }
  /// The limit point of the image of the centre in the face of ring[1] and ring[2], if its faces
  /// are treated as quads (LimitWalk).
  static Vec3d ofCorner(const TriangleStar& star, const std::array<Vec3d, 4>& ring,
                        const Vec3d& ofVertex) {
    const Vec3d& c = star.centre;
    const auto& [before, r, s, after] = ring;
    const Vec3d here = image(c, r, s), last = image(c, before, r), next = image(c, s, after);
    const Vec3d beside = image(r, s, c) + image(s, c, r) + last + next;
    const Vec3d ofFace = (c + r + s) / 3.0;
    const Vec3d acrossV = 4.0 * ofVertex - here - last - next;
    const Vec3d diagonal = ofFace + acrossV + image(r, c, before) + image(s, after, c);
    return (36.0 * here + 6.0 * beside + diagonal) / 64.0;
  }
};

/// Whether a closed polygon runs counter-clockwise around a point, and all of it is seen from
/// there.
bool runsAround(const FramePoint& o, std::span<const FramePoint> polygon) {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const FramePoint &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    if (!((p.a - o.a) * (q.b - o.b) - (p.b - o.b) * (q.a - o.a) > 0)) return false;
  }
  return true;
}

struct Rectangle {
  double middleA, middleB, halfA, halfB;

  /// Around points.
  explicit Rectangle(std::span<const FramePoint> points) {
    double lowA = points[0].a, highA = lowA, lowB = points[0].b, highB = lowB;
    for (const FramePoint& p : points) {
      lowA = std::min(lowA, p.a), highA = std::max(highA, p.a);
      lowB = std::min(lowB, p.b), highB = std::max(highB, p.b);
    }
    middleA = (lowA + highA) / 2, middleB = (lowB + highB) / 2;
    halfA = (highA - lowA) / 2, halfB = (highB - lowB) / 2;
  }

  FramePoint inUnits(const FramePoint& p) const {
    return {(p.a - middleA) / halfA, (p.b - middleB) / halfB, p.height};
  }

  /// Whether a polygon around a point in it holds it, nearly.
  bool isWithin(const FramePoint& centre, std::span<const FramePoint> polygon) const {
    // Only the star counts; corners of the rectangle farther out may lack points around them.
    constexpr double kNearly = 1.3;
    for (const double a : {-1, 1})
      for (const double b : {-1, 1})
        if (!runsAround({centre.a + (middleA + a * halfA - centre.a) / kNearly,
                         centre.b + (middleB + b * halfB - centre.b) / kNearly, 0},
                        polygon))
          return false;
    return true;
  }
};

/// Calls visit(m, i, j) for each term m, of a^i b^j, in the order of Quartic.
template <class Visit>
void forEachTerm(Visit&& visit) {
  std::size_t m = 0;
  for (std::size_t j = 0; j < 5; ++j)
    for (std::size_t i = 0; i + j < 5; ++i) visit(m++, i, j);
}

/// The polynomial with the least squares of differences.
Quartic<double> leastSquares(std::span<const FramePoint> points) {
  PointsToFit columns;
  std::size_t count = 0;
  for (const FramePoint& p : points) columns.set(count++, p.a, p.b, p.height);
  const FitSums sums = sumsOf(columns, count);
  Eigen::Matrix<double, 15, 15> matrix;
  Eigen::Matrix<double, 15, 1> right;
  forEachTerm([&](std::size_t m, std::size_t i, std::size_t j) {
    right[static_cast<Eigen::Index>(m)] = sums.heights[m];
    forEachTerm([&](std::size_t n, std::size_t k, std::size_t l) {
      matrix(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(n)) =
          sums.powers[j + l][i + k];
    });
    constexpr double kRegular = 1e-8;  // where there are too few points
    matrix(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(m)) += kRegular;
  });
  const Eigen::Matrix<double, 15, 1> solution = matrix.llt().solve(right);
  Quartic<double> terms;
  std::copy_n(solution.data(), terms.size(), terms.begin());
  return terms;
}

/// Half planes along the sides of the polygon of every other point on the border, so far out that
/// they hold all points.
void setSides(std::span<const FramePoint> border, HeightPatch& patch) {
  patch.sideCount = border.size() / 2;
  for (std::size_t k = 0; k < patch.sideCount; ++k) {
    const FramePoint &p = border[2 * k + 1], &q = border[(2 * k + 3) % border.size()];
    const double a = (q.b - p.b) * patch.half[1], b = (p.a - q.a) * patch.half[0];
    const double size = std::sqrt(a * a + b * b);
    double most = 0;
    for (const FramePoint& point : border)
      most = std::max(most, a * patch.half[0] * point.a + b * patch.half[1] * point.b);
    patch.sides[k] = {a / size, b / size, most / size};
  }
}

/// Measures the extent of a patch at 3 x 3 places.
void setExtent(HeightPatch& patch) {
  patch.low = patch.high = patch.height[0];
  patch.steepest = {};
  for (const double a : {-1, 0, 1})
    for (const double b : {-1, 0, 1}) {
      const HeightSlope at = heightAt(patch.height, a, b);
      patch.low = std::min(patch.low, at.height);
      patch.high = std::max(patch.high, at.height);
      patch.steepest[0] = std::max(patch.steepest[0], std::abs(at.alongA) / patch.half[0]);
      patch.steepest[1] = std::max(patch.steepest[1], std::abs(at.alongB) / patch.half[1]);
    }
}

/// Whether the patch has nearly the normals of the surface at the limit points of the faces: those
/// of the triangles.
/// @param most  slope between them
bool hasNormals(const TriangleStar& star, std::span<const FramePoint> points,
                const HeightPatch& patch, double most) {
  for (std::size_t k = 0; k < star.ring.size(); ++k) {
    const Vec3d normal =
        (star.ring[k] - star.centre).cross(star.ring[(k + 1) % star.ring.size()] - star.centre);
    const double up = normal.dot(patch.axes[2]);
    const FramePoint& p = points[2 * k + 1];
    const HeightSlope at = heightAt(patch.height, p.a, p.b);
    const double errorA = at.alongA / patch.half[0] * up + normal.dot(patch.axes[0]);
    const double errorB = at.alongB / patch.half[1] * up + normal.dot(patch.axes[1]);
    if (!(up > 0 && errorA * errorA + errorB * errorB <= most * most * up * up)) return false;
  }
  return true;
}

}  // namespace

HeightSlope heightAt(const Quartic<double>& terms, double a, double b) {
  HeightSlope at{0, 0, 0};
  for (std::size_t j = 5, end = terms.size(); j-- > 0;) {
    double row = 0, slope = 0;
    for (std::size_t i = 5 - j; i-- > 0;) {
      slope = slope * a + row;
      row = row * a + terms[--end];
    }
    at.alongB = at.alongB * b + at.height;
    at.height = at.height * b + row;
    at.alongA = at.alongA * b + slope;
  }
  return at;
}

std::optional<HeightPatch> fitStar(const TriangleStar& star, double longest, double tolerance) {
  const std::optional<Frame> frame = frameOf(star);
  if (!frame) return {};
  StarPoints limit(star, *frame);
  const Rectangle rectangle(limit.onBorder());
  constexpr double kLeastHalf = 0.01;  // voxels: terms of smaller ones are too large for floats
  if (!(2 * std::max(rectangle.halfA, rectangle.halfB) <= longest &&
        std::min(rectangle.halfA, rectangle.halfB) >= kLeastHalf))
    return {};
  if (!runsAround(limit.vertex(), limit.onBorder()) ||
      !rectangle.isWithin(limit.vertex(), limit.around()))
    return {};
  const std::span<FramePoint> points = std::span(limit.points).first(limit.count);
  for (FramePoint& p : points) p = rectangle.inUnits(p);
  HeightPatch patch{
      frame->origin + rectangle.middleA * frame->axes[0] + rectangle.middleB * frame->axes[1],
      frame->axes,
      {rectangle.halfA, rectangle.halfB},
      leastSquares(points)};
  for (std::size_t i = 0; i < points.size(); ++i) {
    constexpr double kBeside = 1.1;  // points farther out steady the fit, but need not be met
    const FramePoint& p = points[i];
    if (i >= limit.within && std::max(std::abs(p.a), std::abs(p.b)) > kBeside) continue;
    if (!(std::abs(heightAt(patch.height, p.a, p.b).height - p.height) <= tolerance)) return {};
  }
  if (!hasNormals(star, points, patch, std::min(kMostSlopeError, kSlopeError * tolerance)))
    return {};
  setExtent(patch);
  if (!(std::max(patch.steepest[0], patch.steepest[1]) <= kSteepest)) return {};
  setSides(points.first(limit.border), patch);
  return patch;
}

}  // namespace vox
