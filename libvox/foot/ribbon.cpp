// Slivers of the surface as strips of triangles.

#include "libvox/foot/ribbon.h"

#include "libvox/foot/triangle_prism.h"
#include "libvox/mesh/patch.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vox {
namespace {

constexpr double kMostWidth = 0.15;      // voxels
constexpr double kLeastSlenderness = 6;  // length / width
constexpr double kChordError = 0.003;    // voxels
constexpr double kLongestSegment = 20;   // voxels
constexpr int kStepsOfLeg = 8;
constexpr int kMostSegments = 64;

RibbonPoint pointAt(const LimitPiece& piece, double u, double v) {
  const auto [point, normal] = splinePoint(piece.points, {u}, {v});
  return {u, v, point, normal};
}

/// The normals a little farther in (kBesideCorner).
void takeInnerNormals(const LimitPiece& piece, std::vector<RibbonPoint>& points) {
  const auto farther = [](double p) { return 0.5 + kBesideCorner * (p - 0.5); };
  for (RibbonPoint& point : points)
    point.normal = pointAt(piece, farther(point.u), farther(point.v)).normal;
}

/// Half of the border of a piece: two sides, one after the other.
class BorderPath {
 public:
  /// @param from    u of the first corner, whose v is 0
  /// @param uFirst  whether the side along u comes first
  BorderPath(const LimitPiece& piece, int from, bool uFirst) : piece_(piece) {
    for (int i = 0; i <= 2 * kStepsOfLeg; ++i) {
      const double first = std::min(1.0, static_cast<double>(i) / kStepsOfLeg);
      const double second = std::max(0.0, static_cast<double>(i) / kStepsOfLeg - 1);
      const double towardsU = uFirst ? first : second;
      const double u = from == 0 ? towardsU : 1 - towardsU;
      const double v = uFirst ? second : first;
      places_[static_cast<std::size_t>(i)] = {u, v};
      const Vec3d point = pointAt(piece, u, v).point;
      lengths_[static_cast<std::size_t>(i)] =
          i == 0 ? 0 : lengths_[static_cast<std::size_t>(i) - 1] + (point - last_).norm();
      last_ = point;
    }
  }

  double length() const { return lengths_.back(); }
  /// The fraction of the length at which the second side begins.
  double corner() const { return length() > 0 ? lengths_[kStepsOfLeg] / length() : 0; }

  /// The point at a fraction of the length.
  RibbonPoint at(double fraction) const {
    const double length = fraction * lengths_.back();
    const auto next = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, length);
    const auto i = static_cast<std::size_t>(next - lengths_.begin());
    const double step = lengths_[i] - lengths_[i - 1];
    const double t = step > 0 ? std::clamp((length - lengths_[i - 1]) / step, 0.0, 1.0) : 0;
    const auto blend = [&](std::size_t k) {
      return (1 - t) * places_[i - 1][k] + t * places_[i][k];
    };
    return pointAt(piece_, blend(0), blend(1));
  }

 private:
  static constexpr std::size_t kPoints = 2 * kStepsOfLeg + 1;
  const LimitPiece& piece_;
  std::array<std::array<double, 2>, kPoints> places_;
  std::array<double, kPoints> lengths_;
  Vec3d last_ = Vec3d::Zero();
};

/// Segments that keep the chords of a piece's sides near them.
/// @param from  as BorderPath
int segmentsOf(const LimitPiece& piece, int from, double length) {
  const auto& p = piece.points;
  const Vec3d along = (from == 0 ? p[2][2] - p[0][0] : p[0][2] - p[2][0]).stableNormalized();
  double bend = 0;  // second differences across the ribbon
  const auto add = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    bend = std::max(bend, (a - 2.0 * b + c).cross(along).norm());
  };
  for (std::size_t i = 0; i < 3; ++i) {
    add(p[0][i], p[1][i], p[2][i]);
    add(p[i][0], p[i][1], p[i][2]);
  }
  const double count = std::max(length / kLongestSegment, 2 * std::sqrt(bend / (8 * kChordError)));
  return std::max(1, static_cast<int>(std::ceil(std::min(count, 1.0 + kMostSegments))));
}

/// The middle of a path of two straight steps.
Vec3d middleOfPath(const Vec3d& start, const Vec3d& turn, const Vec3d& end) {
  const double first = (turn - start).norm();
  const double second = (end - turn).norm();
  const double half = (first + second) / 2;
  if (first >= half) return start + (first > 0 ? half / first : 0) * (turn - start);
  return turn + (half - first) / second * (end - turn);
}

/// A test that costs little: the width in the middle between the corners, if its sides are
/// straight.
bool mayBeNarrow(const LimitPiece& piece, int from) {
  constexpr double kMostBend = 1.3;  // the width of straight sides, at most
  const auto corner = [&](std::size_t u, std::size_t v) -> Vec3d {
    const auto& p = piece.points;
    return (p[u][v] + p[u + 1][v] + p[u][v + 1] + p[u + 1][v + 1]) / 4.0;
  };
  const std::size_t first = from == 0 ? 0 : 1;
  const Vec3d start = corner(first, 0), end = corner(1 - first, 1);
  const Vec3d right = corner(1 - first, 0), left = corner(first, 1);
  const double length = std::max((right - start).norm() + (end - right).norm(),
                                 (left - start).norm() + (end - left).norm());
  if (length <= 2 * kMostWidth) return false;
  const double mostWidth = kMostBend * std::min(kMostWidth, length / kLeastSlenderness);
  const Vec3d width = middleOfPath(start, right, end) - middleOfPath(start, left, end);
  return width.squaredNorm() <= mostWidth * mostWidth;
}

/// Points without a normal take the one of the nearest point that has one.
void fillNormals(std::vector<RibbonPoint>& points) {
  const auto count = static_cast<std::ptrdiff_t>(points.size());
  std::vector<Vec3d> normals;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    Vec3d normal = points[static_cast<std::size_t>(i)].normal;
    for (std::ptrdiff_t d = 1; normal.isZero(0) && d < count; ++d)
      for (const std::ptrdiff_t j : {i - d, i + d})
        if (normal.isZero(0) && j >= 0 && j < count)
          normal = points[static_cast<std::size_t>(j)].normal;
    normals.push_back(normal);
  }
  for (std::size_t i = 0; i < points.size(); ++i) points[i].normal = normals[i];
}

}  // namespace

bool Ribbon::set(const LimitPiece& piece, bool crease) {
  for (const int from : {0, 1}) {
    if (!mayBeNarrow(piece, from)) continue;
    const BorderPath a(piece, from, true);
    const BorderPath b(piece, from, false);
    const double length = std::max(a.length(), b.length());
    const double mostWidth = std::min(kMostWidth, length / kLeastSlenderness);
    bool narrow = true;
    for (int i = 1; narrow && i < kStepsOfLeg; ++i) {
      const double fraction = static_cast<double>(i) / kStepsOfLeg;
      narrow = (a.at(fraction).point - b.at(fraction).point).norm() <= mostWidth;
    }
    if (!narrow) continue;
    const int segments = segmentsOf(piece, from, length);
    if (segments > kMostSegments) continue;
    std::vector<double> fractions = {a.corner(), b.corner()};  // without them, chords cut corners
    for (int i = 0; i <= segments; ++i) fractions.push_back(static_cast<double>(i) / segments);
    std::sort(fractions.begin(), fractions.end());
    right.clear();
    left.clear();
    for (const double fraction : fractions) {
      right.push_back((from == 0 ? a : b).at(fraction));
      left.push_back((from == 0 ? b : a).at(fraction));
    }
    for (auto* side : {&right, &left}) {
      if (crease) takeInnerNormals(piece, *side);
      fillNormals(*side);
    }
    return !right[0].normal.isZero(0) && !left[0].normal.isZero(0);
  }
  return false;
}

void addRibbon(const Ribbon& ribbon, const LimitPiece& piece, float reach, float creaseBias,
               std::uint32_t owner, CellStore& store) {
  const auto add = [&](const RibbonPoint& a, const RibbonPoint& b, const RibbonPoint& c) {
    const std::array<const RibbonPoint*, 3> corners = {&a, &b, &c};
    const openvdb::Coord origin = openvdb::Coord::round(openvdb::Vec3d(a.point.data()));
    const Vec3d shift(origin.x(), origin.y(), origin.z());
    std::array<Vec3d, 3> points;
    for (std::size_t i = 0; i < 3; ++i) points[i] = corners[i]->point - shift;
    const Vec3d mean = (a.normal + b.normal + c.normal).stableNormalized();
    const TriangleFrame frame(points, mean);
    double margin[2] = {0, 0};
    for (std::size_t k = 0; k < 2; ++k) {
      for (const RibbonPoint* corner : corners)
        margin[k] = std::max(margin[k], std::abs(corner->normal.dot(frame.axes[k])));
      if (piece.boundarySides != 0) margin[k] = 1;
    }
    constexpr double kMargin = 0.05;  // voxels
    const double tube = double{reach} + kMargin;
    const Prism prism = prismAround(points, origin, frame,
                                    {margin[0] * tube + kMargin, margin[1] * tube + kMargin, tube});
    if (prism.box.empty()) return;
    const auto added = store.triangles.emplace_back();
    TriangleCell& cell = *added;
    cell.prism = prism;
    cell.normal = asFloats(mean);
    cell.creaseBias = creaseBias;
    for (std::size_t i = 0; i < 3; ++i) {
      cell.points[i] = asFloats(points[i]);
      cell.edgeNormals[i] = asFloats(corners[i]->normal + corners[(i + 1) % 3]->normal);
      cell.vertexNormals[i] = asFloats(corners[i]->normal);
      const CornerSquare& square = piece.square;
      cell.places[i] = {static_cast<float>(square.u + square.sideU * corners[i]->u),
                        static_cast<float>(square.v + square.sideV * corners[i]->v)};
    }
    store.bin(prism, owner, added - store.triangles.begin(), CellKind::kRibbon);
  };
  const std::size_t last = ribbon.right.size() - 1;
  // The first and the last point are on both sides.
  for (std::size_t i = 1; i <= last; ++i) {
    const RibbonPoint &r0 = ribbon.right[i - 1], &r1 = ribbon.right[i];
    const RibbonPoint &l0 = ribbon.left[i - 1], &l1 = ribbon.left[i];
    if (i < last) add(r0, r1, l1);
    if (i > 1) add(r0, i < last ? l1 : r1, l0);
  }
}

}  // namespace vox
