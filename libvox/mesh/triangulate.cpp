// Triangulation of polygons (Cohen, Kaufman & Wang 1994, section 7): ear clipping (Meisters 1975)
// along the average normal (Newell). An ear is a corner whose triangle, seen along the normal,
// holds no other vertex. Corners are projected along the normal onto a lattice of 51 bits; on it,
// orientations are exact. A grid finds the vertices near an ear. If a vertex blocks an ear, the ear
// waits until this vertex becomes convex, so that ears are not tried again in vain.

#include "libvox/mesh/triangulate.h"

#include "libvox/mesh/flat_polygon.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>

namespace vox {
namespace {

/// Quality of an ear: first its smallest angle, in coarse steps, then a short diagonal. (By the
/// angle alone, all ears of a round polygon would be alike, and a fan would result.)
struct Shape {
  int sharpness;  ///< 256 sin(smallest angle)
  double diagonal;
  bool operator==(const Shape&) const = default;
  bool worseThan(const Shape& other) const {
    return sharpness != other.sharpness ? sharpness < other.sharpness : diagonal > other.diagonal;
  }
};

Shape shapeOf(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double ab = (b - a).norm();
  const double bc = (c - b).norm();
  const double diagonal = (a - c).norm();
  const double middle = std::max(std::min(ab, bc), std::min(std::max(ab, bc), diagonal));
  const double longer = middle * std::max(std::max(ab, bc), diagonal);
  const double sine = longer > 0 ? (b - a).cross(c - a).norm() / longer : 0;
  return {static_cast<int>(256 * sine), diagonal};
}

/// Whether a polygon is strictly convex, so that all its corners are ears, and stay ears while
/// others are cut off. (A closed walk that only turns left winds once around if it has one lowest
/// point.)
bool isConvex(std::span<const FlatPoint> flat) {
  const std::size_t n = flat.size();
  int lowest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const FlatPoint& before = flat[i == 0 ? n - 1 : i - 1];
    const FlatPoint& after = flat[i + 1 == n ? 0 : i + 1];
    if (turn(before, flat[i], after) <= 0) return false;
    lowest += flat[i] < before && flat[i] < after;
  }
  return lowest == 1;
}

/// The ear clipping of a small convex polygon: the ears in the order of EarClipper, found without
/// its tables.
class ConvexClipper {
 public:
  static constexpr std::size_t kMostCorners = 8;

  explicit ConvexClipper(std::span<const Vec3d> corners) : left_(corners.size()) {
    for (std::size_t i = 0; i < left_; ++i) ring_[i] = {static_cast<Index>(i), corners[i], {}};
    for (std::size_t i = 0; i < left_; ++i) measure(i);
  }

  void clip(std::vector<std::array<Index, 3>>& triangles) {
    while (left_ > 3) {
      std::size_t best = 0;
      for (std::size_t i = 1; i < left_; ++i)
        if (ring_[best].ear.worseThan(ring_[i].ear)) best = i;
      triangles.push_back(
          {ring_[before(best)].number, ring_[best].number, ring_[after(best)].number});
      std::copy(ring_.begin() + best + 1, ring_.begin() + left_, ring_.begin() + best);
      --left_;
      if (left_ == 3) break;
      measure(before(best));
      measure(best == left_ ? 0 : best);
    }
    triangles.push_back({ring_[0].number, ring_[1].number, ring_[2].number});
  }

 private:
  struct Corner {
    Index number;
    Vec3d position;
    Shape ear;
  };

  std::size_t before(std::size_t i) const { return (i == 0 ? left_ : i) - 1; }
  std::size_t after(std::size_t i) const { return i + 1 == left_ ? 0 : i + 1; }
  void measure(std::size_t i) {
    ring_[i].ear = shapeOf(ring_[before(i)].position, ring_[i].position, ring_[after(i)].position);
  }

  std::size_t left_;
  std::array<Corner, kMostCorners> ring_;
};

/// Vertices sorted into the cells of a square grid, about one per cell.
class VertexGrid {
 public:
  explicit VertexGrid(std::span<const FlatPoint> vertices) {
    low_ = vertices[0];
    FlatPoint high = vertices[0];
    for (const FlatPoint& v : vertices) {
      low_ = {std::min(low_.x, v.x), std::min(low_.y, v.y)};
      high = {std::max(high.x, v.x), std::max(high.y, v.y)};
    }
    columns_ = static_cast<std::int64_t>(std::sqrt(static_cast<double>(vertices.size()))) + 1;
    cell_ = std::max(high.x - low_.x, high.y - low_.y) / columns_ + 1;
    starts_.assign(static_cast<std::size_t>(columns_ * columns_) + 1, 0);
    for (const FlatPoint& v : vertices)
      ++starts_[cellOf(column(v.x - low_.x), column(v.y - low_.y)) + 1];
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    vertices_.resize(vertices.size());
    std::vector<Index> next(starts_.begin(), starts_.end() - 1);
    for (Index i = 0; i < vertices.size(); ++i) {
      const FlatPoint& v = vertices[i];
      vertices_[next[cellOf(column(v.x - low_.x), column(v.y - low_.y))]++] = i;
    }
  }

  /// The first vertex in the cells of a box for which wanted(vertex) is true, or kNone.
  template <class Wanted>
  Index find(const FlatPoint& low, const FlatPoint& high, Wanted&& wanted) const {
    for (std::int64_t y = column(low.y - low_.y); y <= column(high.y - low_.y); ++y)
      for (std::int64_t x = column(low.x - low_.x); x <= column(high.x - low_.x); ++x) {
        const std::size_t cell = cellOf(x, y);
        for (Index k = starts_[cell]; k < starts_[cell + 1]; ++k)
          if (wanted(vertices_[k])) return vertices_[k];
      }
    return kNone;
  }

 private:
  std::int64_t column(std::int64_t offset) const { return offset / cell_; }
  std::size_t cellOf(std::int64_t x, std::int64_t y) const {
    return static_cast<std::size_t>(y * columns_ + x);
  }

  FlatPoint low_;
  std::int64_t columns_, cell_;
  std::vector<Index> starts_;  ///< for each cell, the first of its entries in vertices_
  std::vector<Index> vertices_;
};

class EarClipper {
 public:
  EarClipper(std::span<const Vec3d> corners, std::span<const FlatPoint> flat)
      : corners_(corners),
        flat_(flat),
        grid_(flat_),
        vertices_(corners.size()),
        waiting_(corners.size()) {
    const auto n = static_cast<Index>(corners.size());
    for (Index i = 0; i < n; ++i) vertices_[i] = {(i + n - 1) % n, (i + 1) % n};
    for (Index i = 0; i < n; ++i) vertices_[i].convex = turnAt(i) > 0;
    for (Index i = 0; i < n; ++i) tryEar(i);
  }

  /// Appends the triangles.
  /// @return false if ears ran out, so that the rest became a fan
  bool clip(std::vector<std::array<Index, 3>>& triangles) {
    auto left = corners_.size();
    while (left > 3 && !ears_.empty()) {
      const Ear ear = ears_.top();
      ears_.pop();
      Vertex& tip = vertices_[ear.tip];
      if (tip.gone || tip.version != ear.version) continue;
      triangles.push_back({tip.before, ear.tip, tip.after});
      tip.gone = true;
      vertices_[tip.before].after = tip.after;
      vertices_[tip.after].before = tip.before;
      --left;
      changed(tip.before);
      changed(tip.after);
    }
    return fan(triangles);
  }

 private:
  struct Vertex {
    Index before = 0, after = 0;
    Index version = 0;  ///< number of changes of its two neighbours
    bool convex = false;
    bool gone = false;
  };
  struct Ear {
    Shape shape;
    Index tip;
    Index version;
    bool operator<(const Ear& other) const {
      return shape == other.shape ? tip > other.tip : shape.worseThan(other.shape);
    }
  };

  Int128 turnAt(Index i) const {
    return turn(flat_[vertices_[i].before], flat_[i], flat_[vertices_[i].after]);
  }

  void changed(Index i) {
    ++vertices_[i].version;
    vertices_[i].convex = turnAt(i) > 0;
    tryEar(i);
    if (!vertices_[i].convex) return;
    const auto waiting = std::move(waiting_[i]);
    waiting_[i].clear();
    for (const Ear& ear : waiting)
      if (!vertices_[ear.tip].gone && vertices_[ear.tip].version == ear.version) tryEar(ear.tip);
  }

  void tryEar(Index tip) {
    const Vertex& v = vertices_[tip];
    if (!v.convex) return;
    const Index blocker = blockerOf(tip);
    const Ear ear = {shapeOf(corners_[v.before], corners_[tip], corners_[v.after]), tip, v.version};
    if (blocker == kNone)
      ears_.push(ear);
    else
      waiting_[blocker].push_back(ear);
  }

  /// A vertex in the closed triangle at `tip`, or kNone. Only vertices that are not convex are
  /// tried: if there is any vertex in the triangle, there is such a vertex.
  Index blockerOf(Index tip) const {
    const FlatPoint& a = flat_[vertices_[tip].before];
    const FlatPoint& b = flat_[tip];
    const FlatPoint& c = flat_[vertices_[tip].after];
    const FlatPoint low = {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})};
    const FlatPoint high = {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
    return grid_.find(low, high, [&](Index i) {
      const FlatPoint& p = flat_[i];
      if (vertices_[i].convex || vertices_[i].gone) return false;
      if (p.x < low.x || p.x > high.x || p.y < low.y || p.y > high.y) return false;
      if (p == a || p == b || p == c) return false;  // a corner of the triangle, or at its place
      return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
    });
  }

  /// Appends a fan for the rest of the polygon.
  /// @return whether the rest was a single triangle
  bool fan(std::vector<std::array<Index, 3>>& triangles) const {
    const auto first = static_cast<Index>(
        std::find_if(vertices_.begin(), vertices_.end(), [](const Vertex& v) { return !v.gone; }) -
        vertices_.begin());
    Index b = vertices_[first].after;
    Index c = vertices_[b].after;
    const bool single = vertices_[c].after == first;
    for (; c != first; b = c, c = vertices_[c].after) triangles.push_back({first, b, c});
    return single;
  }

  std::span<const Vec3d> corners_;
  std::span<const FlatPoint> flat_;
  VertexGrid grid_;
  std::vector<Vertex> vertices_;
  std::vector<std::vector<Ear>> waiting_;  ///< for each vertex, the ears that it blocks
  std::priority_queue<Ear> ears_;
};

/// Cuts a quad along a diagonal.
/// @return whether a diagonal lies inside
bool splitQuad(std::span<const Vec3d> corners, std::vector<std::array<Index, 3>>& triangles) {
  const Vec3d normal = twiceAreaVector(corners);
  const auto turnsLeft = [&](std::size_t a, std::size_t b, std::size_t c) {
    return (corners[b] - corners[a]).cross(corners[c] - corners[a]).dot(normal) > 0;
  };
  const bool even = turnsLeft(0, 1, 2) && turnsLeft(2, 3, 0);  // diagonal 0-2 lies inside
  const bool odd = turnsLeft(1, 2, 3) && turnsLeft(3, 0, 1);
  const bool evenShorter =
      (corners[2] - corners[0]).squaredNorm() <= (corners[3] - corners[1]).squaredNorm();
  if (even == odd ? evenShorter : even)
    triangles.insert(triangles.end(), {{0, 1, 2}, {0, 2, 3}});
  else
    triangles.insert(triangles.end(), {{0, 1, 3}, {1, 2, 3}});
  return even || odd;
}

/// The corners that are not at the place of the one before.
std::vector<Index> cornersApart(std::span<const Vec3d> corners) {
  std::vector<Index> apart;
  for (Index i = 0; i < corners.size(); ++i)
    if (corners[i] != (i > 0 ? corners[i - 1] : corners.back())) apart.push_back(i);
  return apart;
}

/// Whether two of some corners are at one place: a spike, or a bridge to a hole.
bool meetsItself(std::span<const Vec3d> corners, std::span<const Index> some) {
  std::vector<std::array<double, 3>> places;
  for (const Index i : some) places.push_back({corners[i].x(), corners[i].y(), corners[i].z()});
  std::sort(places.begin(), places.end());
  return std::adjacent_find(places.begin(), places.end()) != places.end();
}

/// Cuts a polygon as if it had only the corners `kept`; the others get triangles without area.
void cutWithout(std::span<const Vec3d> corners, std::span<const Index> kept,
                std::vector<std::array<Index, 3>>& triangles, TriangulationReport& report) {
  std::vector<Vec3d> places;
  for (const Index i : kept) places.push_back(corners[i]);
  const std::size_t first = triangles.size();
  triangulate(places, triangles, report);
  for (std::size_t t = first; t < triangles.size(); ++t)
    for (Index& corner : triangles[t]) corner = kept[corner];
  const auto n = static_cast<Index>(corners.size());
  for (std::size_t k = 0; k < kept.size(); ++k)
    for (Index i = (kept[k] + 1) % n; i != kept[(k + 1) % kept.size()]; i = (i + 1) % n)
      triangles.push_back({kept[k], i, (i + 1) % n});
}

}  // namespace

bool clipEars(std::span<const Vec3d> corners, std::span<const FlatPoint> flat,
              std::vector<std::array<Index, 3>>& triangles) {
  if (corners.size() <= ConvexClipper::kMostCorners && isConvex(flat)) {
    ConvexClipper(corners).clip(triangles);
    return true;
  }
  return EarClipper(corners, flat).clip(triangles);
}

void triangulate(std::span<const Vec3d> corners, std::vector<std::array<Index, 3>>& triangles,
                 TriangulationReport& report) {
  if (corners.size() < 3) return;
  if (corners.size() == 3) {
    triangles.push_back({0, 1, 2});
    return;
  }
  const std::size_t first = triangles.size();
  const bool cut = corners.size() == 4
                       ? splitQuad(corners, triangles)
                       : clipEars(corners, flattened(corners, twiceAreaVector(corners)), triangles);
  if (cut) return;
  const std::vector<Index> apart = cornersApart(corners);
  if (apart.size() < 3 || apart.size() == corners.size() || meetsItself(corners, apart)) {
    ++report.fanned;
    return;
  }
  triangles.resize(first);
  cutWithout(corners, apart, triangles, report);
}

void FaceTriangulator::add(std::span<const Vec3d> points, std::span<const Index> face,
                           std::vector<std::array<Index, 3>>& triangles) {
  corners_.clear();
  for (const Index v : face) corners_.push_back(points[v]);
  const std::size_t first = triangles.size();
  triangulate(corners_, triangles, report_);
  for (std::size_t t = first; t < triangles.size(); ++t)
    for (Index& corner : triangles[t]) corner = face[corner];
}

}  // namespace vox
