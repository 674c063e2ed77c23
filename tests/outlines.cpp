#include "tests/outlines.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <utility>

namespace vox::test {
namespace {

constexpr double kPi = std::numbers::pi;

double signedArea(const Loop& loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    sum += loop[i].cross(loop[(i + 1) % loop.size()]).z() / 2;
  return sum;
}

Outline made(const std::string& name, std::vector<Loop> loops) {
  for (std::size_t i = 0; i < loops.size(); ++i)
    if ((signedArea(loops[i]) > 0) != (i == 0)) std::reverse(loops[i].begin(), loops[i].end());
  return {name, std::move(loops)};
}

Loop loopOf(std::initializer_list<std::array<double, 2>> corners) {
  Loop loop;
  for (const auto& corner : corners) loop.emplace_back(corner[0], corner[1], 0);
  return loop;
}

Vec3d polar(double radius, double angle) {
  return {radius * std::cos(angle), radius * std::sin(angle), 0};
}

/// Appends n + 1 points of an arc.
void arc(Loop& loop, int n, const Vec3d& center, double radius, double from, double to) {
  for (int i = 0; i <= n; ++i) loop.push_back(center + polar(radius, from + (to - from) * i / n));
}

/// A band of a width around a curve.
Loop bandAround(const Loop& curve, double halfWidth) {
  Loop left, right;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Vec3d along =
        (curve[std::min(i + 1, curve.size() - 1)] - curve[i == 0 ? 0 : i - 1]).normalized();
    const Vec3d across = halfWidth * Vec3d(-along.y(), along.x(), 0);
    left.push_back(curve[i] + across);
    right.push_back(curve[i] - across);
  }
  right.insert(right.end(), left.rbegin(), left.rend());
  return right;
}

bool isInside(const Outline& outline, const Vec3d& p) {
  bool inside = false;
  for (const Loop& loop : outline.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec3d& a = loop[i];
      const Vec3d& b = loop[(i + 1) % loop.size()];
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < a.x() + (p.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y()))
        inside = !inside;
    }
  return inside;
}

double distanceToSegment(const Vec3d& a, const Vec3d& b, const Vec3d& p) {
  const Vec3d side = b - a;
  const double length = side.squaredNorm();
  const double s = length > 0 ? std::clamp((p - a).dot(side) / length, 0.0, 1.0) : 0;
  return (a + s * side - p).norm();
}

using Square = std::pair<int, int>;

/// Whether two squares of the set meet in a corner only, at some corner of `square`.
bool pinches(const std::set<Square>& squares, const Square& square) {
  for (const int x : {square.first, square.first + 1})
    for (const int y : {square.second, square.second + 1}) {
      const bool a = squares.count({x - 1, y - 1}) > 0;
      const bool b = squares.count({x, y - 1}) > 0;
      const bool c = squares.count({x, y}) > 0;
      const bool d = squares.count({x - 1, y}) > 0;
      if (a == c && b == d && a != b) return true;
    }
  return false;
}

std::vector<Loop> loopsAround(const std::set<Square>& squares) {
  std::map<Square, Square> next;  // no pinches: one side leaves each corner
  for (const auto& [x, y] : squares) {
    if (squares.count({x, y - 1}) == 0) next[{x, y}] = {x + 1, y};
    if (squares.count({x + 1, y}) == 0) next[{x + 1, y}] = {x + 1, y + 1};
    if (squares.count({x, y + 1}) == 0) next[{x + 1, y + 1}] = {x, y + 1};
    if (squares.count({x - 1, y}) == 0) next[{x, y + 1}] = {x, y};
  }
  std::vector<Loop> loops;
  while (!next.empty()) {
    loops.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      loops.back().emplace_back(at->first.first, at->first.second, 0);
      const Square to = at->second;
      next.erase(at);
      at = next.find(to);
    }
  }
  std::stable_partition(loops.begin(), loops.end(),
                        [](const Loop& loop) { return signedArea(loop) > 0; });
  return loops;
}

}  // namespace

Loop circle(int corners, double radius, const Vec3d& center) {
  Loop loop;
  for (int i = 0; i < corners; ++i) loop.push_back(center + polar(radius, 2 * kPi * i / corners));
  return loop;
}

Loop rectangle(const Vec3d& low, const Vec3d& high) {
  return {low, {high.x(), low.y(), 0}, high, {low.x(), high.y(), 0}};
}

Outline letterU() {
  return made("U", {loopOf({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}})});
}

Outline letterA() {
  return made("A", {loopOf({{0, 0}, {2, 0}, {3, 3}, {7, 3}, {8, 0}, {10, 0}, {6, 10}, {4, 10}}),
                    loopOf({{3.6, 4.6}, {6.4, 4.6}, {5, 8.6}})});
}

Outline letterB(int corners) {
  Loop rim = {Vec3d(0, 0, 0)};
  arc(rim, corners, {4, 2.5, 0}, 2.5, -kPi / 2, kPi / 2);
  rim.pop_back();
  arc(rim, corners, {4, 7.5, 0}, 2.5, -kPi / 2, kPi / 2);
  rim.emplace_back(0, 10, 0);
  std::vector<Loop> loops = {rim};
  for (const double y : {2.5, 7.5}) {
    Loop hole = {Vec3d(1.5, y - 1.3, 0)};
    arc(hole, corners, {4, y, 0}, 1.3, -kPi / 2, kPi / 2);
    hole.emplace_back(1.5, y + 1.3, 0);
    loops.push_back(hole);
  }
  return made("B", loops);
}

Outline letterC(int corners) {
  Loop curve;
  arc(curve, corners, Vec3d::Zero(), 3, kPi / 4, 7 * kPi / 4);
  return made("C", {bandAround(curve, 0.7)});
}

Outline letterS(int corners) {
  Loop curve;
  arc(curve, corners / 2, {0, 2, 0}, 2, kPi / 4, 3 * kPi / 2);
  curve.pop_back();
  arc(curve, corners / 2, {0, -2, 0}, 2, kPi / 2, -3 * kPi / 4);
  return made("S", {bandAround(curve, 0.8)});
}

Outline letterO(int corners) {
  return made("O", {circle(corners, 4), circle(corners - corners / 5, 2.4)});
}

Outline letterI() {
  return made("I", {loopOf({{0, 0},
                            {6, 0},
                            {6, 0.6},
                            {4, 1},
                            {4, 9},
                            {6, 9.4},
                            {6, 10},
                            {0, 10},
                            {0, 9.4},
                            {2, 9},
                            {2, 1},
                            {0, 0.6}})});
}

Outline figureEight(int corners) {
  return made("8", {circle(corners, 4), circle(corners / 2, 1.2, {0, 1.7, 0}),
                    circle(corners / 2, 1.4, {0, -1.6, 0})});
}

Outline spiral(int corners, double turns) {
  Loop curve;
  for (int i = 0; i < corners; ++i) {
    const double t = turns * i / (corners - 1);
    curve.push_back(polar(0.5 + t, 2 * kPi * t));
  }
  return made("spiral", {bandAround(curve, 0.25)});
}

Outline comb(int teeth) {
  Loop rim = loopOf({{0, 0}, {2.0 * teeth - 1, 0}});
  for (int k = teeth - 1; k >= 0; --k) {
    rim.emplace_back(2 * k + 1, 6, 0);
    rim.emplace_back(2 * k, 6, 0);
    if (k == 0) break;
    rim.emplace_back(2 * k, 1, 0);
    rim.emplace_back(2 * k - 1, 1, 0);
  }
  return made("comb", {rim});
}

Outline gear(int teeth, double hole) {
  Loop rim;
  for (int k = 0; k < teeth; ++k)
    for (const auto& [part, radius] : {std::pair{0.2, 3.0}, {0.3, 4.0}, {0.7, 4.0}, {0.8, 3.0}})
      rim.push_back(polar(radius, 2 * kPi * (k + part) / teeth));
  std::vector<Loop> loops = {rim};
  if (hole > 0) loops.push_back(circle(2 * teeth, hole));
  return made("gear", loops);
}

Outline star(int tips) {
  Loop rim;
  for (int i = 0; i < 2 * tips; ++i) rim.push_back(polar(i % 2 == 0 ? 2 : 4, kPi * i / tips));
  return made("star", {rim});
}

Outline plate(int columns, int rows, int corners) {
  std::vector<Loop> loops = {rectangle(Vec3d::Zero(), Vec3d(4 * columns, 4 * rows, 0))};
  for (int x = 0; x < columns; ++x)
    for (int y = 0; y < rows; ++y)
      loops.push_back(circle(corners, 1, {4.0 * x + 2, 4.0 * y + 2, 0}));
  return made("plate", loops);
}

Squares randomSquares(int count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::set<Square> squares = {{0, 0}};
  std::vector<Square> list = {{0, 0}};
  for (int tries = 0; static_cast<int>(list.size()) < count && tries < 1000 * count; ++tries) {
    Square next = list[random() % list.size()];
    (random() % 2 == 0 ? next.first : next.second) += random() % 2 == 0 ? 1 : -1;
    if (!squares.insert(next).second) continue;
    if (pinches(squares, next))
      squares.erase(next);
    else
      list.push_back(next);
  }
  Squares result{{"squares", loopsAround(squares)}, static_cast<int>(list.size()), {}};
  for (const auto& [x, y] : list) result.lows.emplace_back(x, y, 0);
  return result;
}

double area(const Outline& outline) {
  double sum = 0;
  for (const Loop& loop : outline.loops) sum += signedArea(loop);
  return sum;
}

double distanceFrom(const Outline& outline, const Vec3d& p) {
  if (isInside(outline, p)) return 0;
  double least = INFINITY;
  for (const Loop& loop : outline.loops)
    for (std::size_t i = 0; i < loop.size(); ++i)
      least = std::min(least, distanceToSegment(loop[i], loop[(i + 1) % loop.size()], p));
  return least;
}

Outline splineOf(const Outline& outline) {
  constexpr int kSteps = 16;
  Outline spline{outline.name, {}};
  for (const Loop& loop : outline.loops) {
    Loop curve;
    const std::size_t n = loop.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3d from = (loop[(i + n - 1) % n] + loop[i]) / 2;
      const Vec3d to = (loop[i] + loop[(i + 1) % n]) / 2;
      for (int k = 0; k < kSteps; ++k) {
        const double t = static_cast<double>(k) / kSteps;
        curve.push_back((1 - t) * (1 - t) * from + 2 * t * (1 - t) * loop[i] + t * t * to);
      }
    }
    spline.loops.push_back(curve);
  }
  return spline;
}

PolygonMesh solidOf(const Outline& outline, double height, Bridge bridge) {
  PolygonMesh mesh;
  std::vector<Index> firsts;
  for (const Loop& loop : outline.loops) {
    firsts.push_back(mesh.pointCount());
    mesh.points.insert(mesh.points.end(), loop.begin(), loop.end());
  }
  const Index n = mesh.pointCount();
  for (Index v = 0; v < n; ++v) mesh.points.push_back(mesh.points[v] + Vec3d(0, 0, height));

  for (const bool isTop : {false, true}) {
    const auto corner = [&](std::size_t loop, std::size_t i) {
      return firsts[loop] + static_cast<Index>(i % outline.loops[loop].size()) + (isTop ? n : 0);
    };
    std::vector<Index> face;
    for (std::size_t i = 0; i < outline.loops[0].size(); ++i) face.push_back(corner(0, i));
    std::vector<Index> back;  // the corners on the way back
    if (outline.loops.size() > 1) face.push_back(corner(0, 0));
    for (std::size_t loop = 1; loop < outline.loops.size(); ++loop) {
      std::vector<Index> chain;
      const Index from = face.back();
      if (bridge == Bridge::kChain)
        for (const double t : {0.25, 0.5}) {
          chain.push_back(mesh.pointCount());
          mesh.points.push_back((1 - t) * mesh.points[from] + t * mesh.points[corner(loop, 0)]);
        }
      face.insert(face.end(), chain.begin(), chain.end());
      const std::size_t size = outline.loops[loop].size();
      for (std::size_t i = 0; i <= size; ++i)
        face.push_back(corner(loop, bridge == Bridge::kSameDirection ? size - i : i));
      if (bridge == Bridge::kHoleToHole) {
        back.push_back(from);
        continue;
      }
      face.insert(face.end(), chain.rbegin(), chain.rend());
      if (loop + 1 < outline.loops.size()) face.push_back(corner(0, 0));
    }
    face.insert(face.end(), back.rbegin(), back.rend());
    // The walk is closed; where it ends at its first corner, that corner is there already.
    if (face.size() > 1 && face.back() == face.front()) face.pop_back();
    if (!isTop) std::reverse(face.begin(), face.end());
    mesh.addFace(face);
  }
  for (std::size_t loop = 0; loop < outline.loops.size(); ++loop) {
    const auto size = static_cast<Index>(outline.loops[loop].size());
    for (Index i = 0; i < size; ++i) {
      const Index v = firsts[loop] + i;
      const Index w = firsts[loop] + (i + 1) % size;
      mesh.addFace(std::vector<Index>{v, w, w + n, v + n});
    }
  }
  if (bridge == Bridge::kEqualPositions) {
    std::vector<Vec3d> points;
    for (Index& v : mesh.faceVertices) {
      points.push_back(mesh.points[v]);
      v = static_cast<Index>(points.size() - 1);
    }
    mesh.points = std::move(points);
  }
  return mesh;
}

}  // namespace vox::test
