#include "tests/scan_reference.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <cmath>

namespace vox::test {
namespace {

__extension__ using Int128 = __int128;

constexpr int kUnit = 65536;

template <class Int>
using Vec = std::array<Int, 3>;

template <class Int>
Vec<Int> operator-(const Vec<Int>& a, const Vec<Int>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class Int>
Vec<Int> cross(const Vec<Int>& a, const Vec<Int>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Int>
Int dot(const Vec<Int>& a, const Vec<Int>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Int>
using Triangle = std::array<Vec<Int>, 3>;
template <class Int>
struct Box {
  Vec<Int> low, high;
};

template <class Int>
Triangle<Int> snapped(const Corners& corners) {
  Triangle<Int> triangle;
  for (std::size_t i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis)
      triangle[i][axis] = static_cast<Int>(std::nearbyint(corners[i][axis] * kUnit));
  return triangle;
}

template <class Int>
std::array<Vec<Int>, 8> cornersOf(const Box<Int>& box) {
  std::array<Vec<Int>, 8> corners;
  for (unsigned i = 0; i < 8; ++i)
    for (unsigned axis = 0; axis < 3; ++axis)
      corners[i][axis] = (i >> axis & 1) != 0 ? box.high[axis] : box.low[axis];
  return corners;
}

template <class Int, std::size_t kCount>
std::pair<Int, Int> shadow(const std::array<Vec<Int>, kCount>& points, const Vec<Int>& axis) {
  std::pair<Int, Int> range = {dot(points[0], axis), dot(points[0], axis)};
  for (const Vec<Int>& point : points) {
    range.first = std::min(range.first, dot(point, axis));
    range.second = std::max(range.second, dot(point, axis));
  }
  return range;
}

template <class Int>
bool separates(const Vec<Int>& axis, const Triangle<Int>& triangle,
               const std::array<Vec<Int>, 8>& box) {
  const auto a = shadow(triangle, axis);
  const auto b = shadow(box, axis);
  return a.second < b.first || b.second < a.first;
}

template <class Int>
bool meets(const Triangle<Int>& triangle, const Box<Int>& box) {
  const std::array<Vec<Int>, 8> corners = cornersOf(box);
  const std::array<Vec<Int>, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const std::array<Vec<Int>, 3> edges = {
      {triangle[1] - triangle[0], triangle[2] - triangle[1], triangle[0] - triangle[2]}};
  for (const Vec<Int>& axis : axes)
    if (separates(axis, triangle, corners)) return false;
  if (separates(cross(edges[0], edges[1]), triangle, corners)) return false;
  for (const Vec<Int>& axis : axes)
    for (const Vec<Int>& edge : edges)
      if (separates(cross(axis, edge), triangle, corners)) return false;
  return true;
}

template <class Int>
Box<Int> boxOf(const Voxel& low, const Voxel& high, const std::array<int, 3>& widths) {
  Box<Int> box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = Int{low[axis]} * kUnit - widths[axis] * kUnit / 2;
    box.high[axis] = Int{high[axis]} * kUnit + widths[axis] * kUnit / 2;
  }
  return box;
}

template <class Int>
void scanBox(const Triangle<Int>& triangle, const Voxel& low, const Voxel& high,
             std::array<std::vector<Voxel>, 2>& voxels) {
  if (!meets(triangle, boxOf<Int>(low, high, {1, 1, 1}))) return;
  if (low == high) {
    for (const Separation separation : {Separation::k6, Separation::k26}) {
      const auto targets = targetWidths(separation);
      if (std::any_of(targets.begin(), targets.end(), [&](const std::array<int, 3>& widths) {
            return meets(triangle, boxOf<Int>(low, low, widths));
          }))
        voxels[static_cast<std::size_t>(separation)].push_back(low);
    }
    return;
  }
  std::size_t longest = 0;
  for (const std::size_t axis : {1U, 2U})
    if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
  Voxel middle = high;
  middle[longest] = low[longest] + (high[longest] - low[longest]) / 2;
  scanBox(triangle, low, middle, voxels);
  Voxel next = low;
  next[longest] = middle[longest] + 1;
  scanBox(triangle, next, high, voxels);
}

}  // namespace

std::vector<std::array<int, 3>> targetWidths(Separation separation) {
  if (separation == Separation::k26) return {{1, 1, 1}};
  return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

std::array<std::vector<Voxel>, 2> naiveScan(const Corners& corners) {
  Voxel low{};
  Voxel high{};
  double reach = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [first, last] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
    low[axis] = static_cast<int>(std::ceil(first - 0.6));
    high[axis] = static_cast<int>(std::floor(last + 0.6));
    reach = std::max({reach, -first, last});
  }
  std::array<std::vector<Voxel>, 2> voxels;
  if (reach < 6)
    scanBox(snapped<std::int64_t>(corners), low, high, voxels);  // terms below 2^61
  else
    scanBox(snapped<Int128>(corners), low, high, voxels);
  for (auto& list : voxels) std::sort(list.begin(), list.end());
  return voxels;
}

bool clipMeets(const Corners& corners, const Voxel& voxel, const std::array<int, 3>& widths) {
  using Rational = boost::multiprecision::cpp_rational;
  using Point = std::array<Rational, 3>;
  std::vector<Point> polygon;
  for (const auto& corner : snapped<std::int64_t>(corners)) {
    Point point;
    for (std::size_t axis = 0; axis < 3; ++axis)
      point[axis] = Rational(corner[axis], kUnit) - voxel[axis];
    polygon.push_back(point);
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      const auto depth = [&](const Point& p) {
        return Rational(Rational(widths[axis], 2) - side * p[axis]);
      };
      std::vector<Point> rest;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point& p = polygon[i];
        const Point& q = polygon[(i + 1) % polygon.size()];
        const Rational a = depth(p);
        const Rational b = depth(q);
        if (a >= 0) rest.push_back(p);
        if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
          Point crossing;
          for (std::size_t k = 0; k < 3; ++k) crossing[k] = p[k] + a / (a - b) * (q[k] - p[k]);
          rest.push_back(crossing);
        }
      }
      polygon = rest;
    }
  return !polygon.empty();
}

}  // namespace vox::test
