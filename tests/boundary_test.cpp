#include "libvox/mesh/validate.h"
#include "libvox/subdivide/doo_sabin.h"
#include "tests/reference.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace vox;

namespace {

/// Point of the closed uniform quadratic B-spline; span i belongs to control point i and runs from
/// u = i - 1/2 to i + 1/2.
Vec3d onSpline(const std::vector<Vec3d>& controls, double u) {
  const auto n = static_cast<std::int64_t>(controls.size());
  const double span = std::floor(u + 0.5);
  const double t = u + 0.5 - span;
  const auto at = [&](std::int64_t i) {
    return controls[static_cast<std::size_t>(((static_cast<std::int64_t>(span) + i) % n + n) % n)];
  };
  return 0.5 * (1 - t) * (1 - t) * at(-1) + (0.5 + t * (1 - t)) * at(0) + 0.5 * t * t * at(1);
}

std::vector<std::vector<Vec3d>> loopPoints(const SubdivisionLevel& level) {
  std::vector<std::vector<Vec3d>> loops;
  for (const auto& loop : boundaryLoops(level.mesh, level.adjacency)) {
    auto& points = loops.emplace_back();
    for (const Index c : loop) points.push_back(level.mesh.points[level.mesh.faceVertices[c]]);
  }
  return loops;
}

/// Largest distance between the edge midpoints of a boundary loop of level k and the points of the
/// spline at the same parameters, for the best start of the loop.
double distanceToSpline(const std::vector<Vec3d>& loop, const std::vector<Vec3d>& controls) {
  const std::size_t n = loop.size();
  const double step = static_cast<double>(controls.size()) / static_cast<double>(n);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t start = 0; start < n; ++start) {
    double worst = 0;
    for (std::size_t i = 0; i < n && worst < best; ++i) {
      const Vec3d middle = 0.5 * (loop[i] + loop[(i + 1) % n]);
      const double u = step * static_cast<double>(start + i);
      worst = std::max(worst, (middle - onSpline(controls, u)).norm());
    }
    best = std::min(best, worst);
  }
  return best;
}

/// Two fans of faces that touch in one vertex of their boundaries.
PolygonMesh openBowTie() {
  return test::meshOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.3}, {-1, 0, 0}, {-1, -1, 0}},
                      {{0, 1, 2}, {0, 2, 3}, {0, 4, 5}});
}

}  // namespace

TEST_CASE("the surface ends at the quadratic B-spline of each boundary loop",
          "[subdivide][boundary][property]") {
  for (const auto& shape : test::openShapes()) {
    CAPTURE(shape.name);
    const SubdivisionLevel base = baseLevel(shape.mesh);
    const auto controls = loopPoints(base);
    SubdivisionLevel level = base;
    for (int k = 1; k <= 4; ++k) {
      CAPTURE(k);
      level = subdivide(std::move(level), 1);
      const auto loops = loopPoints(level);
      REQUIRE(loops.size() == controls.size());
      for (const auto& control : controls) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& loop : loops)
          if (loop.size() == control.size() << k)
            nearest = std::min(nearest, distanceToSpline(loop, control));
        CHECK(nearest < 1e-12);
      }
    }
  }
}

TEST_CASE("every level of an extended mesh is an oriented manifold of the same topology",
          "[subdivide][boundary][property]") {
  for (const auto& shape : test::openShapes()) {
    CAPTURE(shape.name);
    SubdivisionLevel level = baseLevel(shape.mesh);
    const auto expected = test::eulerCharacteristic(level.mesh);
    const auto loops = loopPoints(level).size();
    for (int k = 1; k <= 3; ++k) {
      CAPTURE(k);
      const auto bound = nextCornerCount(level);
      const auto points = nextPointCount(level);
      level = subdivide(std::move(level), 1);
      CHECK(level.mesh.cornerCount() <= bound);
      CHECK(level.mesh.pointCount() == points);
      CHECK(level.boundary == BoundaryStage::kStrips);
      REQUIRE_NOTHROW(requireValidArrays(level.mesh));
      const Adjacency searched = buildAdjacency(level.mesh);
      CHECK(level.adjacency.twin == searched.twin);
      CHECK(level.adjacency.cornerFace == searched.cornerFace);
      CHECK(findDefects(level.mesh, searched).empty());
      CHECK(test::eulerCharacteristic(level.mesh) == expected);
      CHECK(loopPoints(level).size() == loops);
      bool atMostOne = true;
      for (Index f = 0; f < level.mesh.faceCount(); ++f) {
        int edges = 0;
        for (Index c = level.mesh.faceOffsets[f]; c < level.mesh.faceOffsets[f + 1]; ++c)
          edges += searched.twin[c] == kNone;
        atMostOne = atMostOne && edges <= 1;
      }
      CHECK(atMostOne);
    }
  }
}

TEST_CASE("the first level of a square adds half faces around it",
          "[subdivide][boundary][golden]") {
  const PolygonMesh square =
      test::meshOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}});
  const SubdivisionLevel level = subdivide(baseLevel(square), 1);
  REQUIRE(level.mesh.pointCount() == 4 + 8);
  REQUIRE(level.mesh.faceCount() == 1 + 4 + 4);  // F-face, half V-faces, half E-faces
  CHECK(level.mesh.points[0] == Vec3d(0.25, 0.25, 0));
  CHECK(level.mesh.points[4] == Vec3d(0.25, 0, 0));
  CHECK(level.mesh.points[5] == Vec3d(0.75, 0, 0));
  const auto face = [&](Index f) {
    return std::vector<Index>(level.mesh.face(f).begin(), level.mesh.face(f).end());
  };
  CHECK(face(1) == std::vector<Index>{0, 11, 4});
  CHECK(face(5) == std::vector<Index>{1, 0, 4, 5});
}

TEST_CASE("a strip face is subdivided as half of a 2m-gon by weights that are not negative",
          "[subdivide][boundary][property]") {
  for (int inner = 1; inner <= 40; ++inner) {
    CAPTURE(inner);
    // A polygon joined to a neighbour along all of its edges but one.
    const int sides = inner + 2;
    PolygonMesh strip = test::regularPolygon(sides);
    strip.points.emplace_back(0, 0, 1);
    for (Index i = 0; i + 1 < static_cast<Index>(sides); ++i)
      strip.addFace(std::vector<Index>{i + 1, i, static_cast<Index>(sides)});
    SubdivisionLevel level = baseLevel(strip);
    level.boundary = BoundaryStage::kStrips;
    const auto n = static_cast<std::size_t>(sides);
    std::vector<double> sums(n, 0.0);
    double least = 1;
    for (std::size_t j = 0; j < n; ++j) {
      for (Vec3d& p : level.mesh.points) p.setZero();
      level.mesh.points[j].x() = 1;
      const auto image = imageVertices(level);
      for (std::size_t i = 0; i < n; ++i) {
        least = std::min(least, image[i].x());
        sums[i] += image[i].x();
      }
    }
    CHECK(least > -1e-16);
    for (const double sum : sums) CHECK(sum == Approx(1).margin(1e-14));
    if (inner == 1) continue;

    // The 2m-gon consists of the inner points and their reflections in the points c + r_i d of the
    // boundary line. Plain Doo-Sabin of it must give the same images.
    level.mesh = strip;
    PolygonMesh whole = test::regularPolygon(2 * inner);
    const auto m = static_cast<std::size_t>(inner);
    const double scale = std::cos(std::numbers::pi / (2.0 * inner));
    for (std::size_t i = 0; i < m; ++i) {
      const double t = std::numbers::pi * (2.0 * static_cast<double>(i) + 1) / (2.0 * inner);
      const Vec3d u(std::cos(t) / scale, std::sin(t) * (1 + 0.1 * static_cast<double>(i * i)), 0.2);
      const Vec3d foot(u.x(), 0, 0.2);
      whole.points[i] = u;
      whole.points[2 * m - 1 - i] = 2 * foot - u;
      level.mesh.points[(i + 1) % n] = u;
    }
    // The boundary edge is the last one of the polygon, from Mm = point n - 1 to M1 = point 0.
    level.mesh.points[n - 1] = Vec3d(-1, 0, 0.2);
    level.mesh.points[0] = Vec3d(1, 0, 0.2);
    const auto image = imageVertices(level);
    const auto expected = imageVertices(baseLevel(whole, BoundaryRule::kFree));
    double worst = 0;
    for (std::size_t i = 0; i < m; ++i)
      worst = std::max(worst, (image[i + 1] - expected[i]).norm());
    CHECK(worst < 1e-12);
  }
}

TEST_CASE("an extended tube is plain Doo-Sabin of the tube with reflected rows",
          "[subdivide][boundary][property]") {
  const int around = 8;
  const int along = 4;
  const PolygonMesh mesh = test::tube(around, along);
  PolygonMesh longer;
  const auto row = [&](int j) {
    return mesh.points.begin() + static_cast<std::ptrdiff_t>(j) * around;
  };
  for (int i = 0; i < around; ++i) longer.points.push_back(2 * row(0)[i] - row(1)[i]);
  longer.points.insert(longer.points.end(), mesh.points.begin(), mesh.points.end());
  for (int i = 0; i < around; ++i) longer.points.push_back(2 * row(along)[i] - row(along - 1)[i]);
  longer.faceVertices = test::tube(around, along + 2).faceVertices;
  longer.faceOffsets = test::tube(around, along + 2).faceOffsets;

  SubdivisionLevel level = baseLevel(mesh);
  SubdivisionLevel plain = baseLevel(longer, BoundaryRule::kFree);
  for (int k = 1; k <= 3; ++k) {
    CAPTURE(k);
    level = subdivide(std::move(level), 1);
    plain = subdivide(std::move(plain), 1);
    std::vector<bool> onBoundary(level.mesh.pointCount(), false);
    for (Index c = 0; c < level.mesh.cornerCount(); ++c) {
      if (level.adjacency.twin[c] != kNone) continue;
      onBoundary[level.mesh.faceVertices[c]] = true;
      onBoundary[level.mesh.faceVertices[nextCorner(level.mesh, level.adjacency, c)]] = true;
    }
    // Inner points are points of the plain mesh; points on the boundary are halfway between a row
    // and its reflection, so plain edges have them as midpoints.
    std::vector<Vec3d> middles;
    for (Index c = 0; c < plain.mesh.cornerCount(); ++c)
      middles.push_back(
          0.5 *
          (plain.mesh.points[plain.mesh.faceVertices[c]] +
           plain.mesh.points[plain.mesh.faceVertices[nextCorner(plain.mesh, plain.adjacency, c)]]));
    double worst = 0;
    for (Index v = 0; v < level.mesh.pointCount(); ++v) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec3d& p : onBoundary[v] ? middles : plain.mesh.points)
        nearest = std::min(nearest, (p - level.mesh.points[v]).norm());
      worst = std::max(worst, nearest);
    }
    CHECK(worst < 1e-13);
  }
}

TEST_CASE("an extended sheet is the biquadratic B-spline of the grid with reflected rows",
          "[subdivide][boundary][property]") {
  // x and y of the sheet are its parameters, since B-splines reproduce linear functions. The half
  // cells at the corners are left out: corners are rounded, by the spline of the loop.
  const int columns = GENERATE(3, 5);
  const int rows = GENERATE(2, 4);
  const PolygonMesh mesh = test::sheet(columns, rows);
  std::vector<std::vector<Vec3d>> grid;  // rows and columns from -1 on
  const auto reflected = [](std::vector<Vec3d> line) {
    line.insert(line.begin(), 2 * line[0] - line[1]);
    line.push_back(2 * line[line.size() - 1] - line[line.size() - 2]);
    return line;
  };
  for (int j = 0; j <= rows; ++j) {
    const auto begin = mesh.points.begin() + static_cast<std::ptrdiff_t>(j) * (columns + 1);
    grid.push_back(reflected({begin, begin + columns + 1}));
  }
  std::vector<Vec3d> below;
  std::vector<Vec3d> above;
  for (std::size_t i = 0; i < grid[0].size(); ++i) {
    below.push_back(2 * grid[0][i] - grid[1][i]);
    above.push_back(2 * grid[grid.size() - 1][i] - grid[grid.size() - 2][i]);
  }
  grid.insert(grid.begin(), below);
  grid.push_back(above);
  const auto basis = [](double t) {
    return Vec3d(0.5 * (1 - t) * (1 - t), 0.5 + t * (1 - t), 0.5 * t * t);
  };
  const auto surface = [&](double u, double v) {
    const auto i = static_cast<std::size_t>(u + 0.5);
    const auto j = static_cast<std::size_t>(v + 0.5);
    const Vec3d bu = basis(u + 0.5 - static_cast<double>(i));
    const Vec3d bv = basis(v + 0.5 - static_cast<double>(j));
    Vec3d sum = Vec3d::Zero();
    for (std::size_t b = 0; b < 3; ++b)
      for (std::size_t a = 0; a < 3; ++a) sum += bu[a] * bv[b] * grid[j + b][i + a];
    return sum;
  };

  SubdivisionLevel level = baseLevel(mesh);
  for (int k = 1; k <= 4; ++k) {
    CAPTURE(k);
    level = subdivide(std::move(level), 1);
    double worst = 0;
    int compared = 0;
    for (Index f = 0; f < level.mesh.faceCount(); ++f) {
      Vec3d onSurface = test::faceCentroid(level.mesh, f);
      for (Index c = level.mesh.faceOffsets[f]; c < level.mesh.faceOffsets[f + 1]; ++c)
        if (level.adjacency.twin[c] == kNone)  // a strip face touches the limit at its edge
          onSurface =
              0.5 *
              (level.mesh.points[level.mesh.faceVertices[c]] +
               level.mesh
                   .points[level.mesh.faceVertices[nextCorner(level.mesh, level.adjacency, c)]]);
      const double u = onSurface.x();
      const double v = onSurface.y();
      if (std::min(u, columns - u) < 0.5 && std::min(v, rows - v) < 0.5) continue;
      worst = std::max(worst, (onSurface - surface(std::max(u, 0.0), std::max(v, 0.0))).norm());
      ++compared;
    }
    CHECK(compared >= columns * rows << (2 * k - 1));
    CHECK(worst < 1e-13);
  }
}

TEST_CASE("the boundary rule does not change closed meshes", "[subdivide][boundary]") {
  for (const auto& shape : test::shapes()) {
    if (!shape.closed) continue;
    CAPTURE(shape.name);
    const auto extended = subdivide(baseLevel(shape.mesh, BoundaryRule::kExtend), 2);
    const auto free = subdivide(baseLevel(shape.mesh, BoundaryRule::kFree), 2);
    CHECK(extended.mesh.points == free.mesh.points);
    CHECK(extended.mesh.faceVertices == free.mesh.faceVertices);
    CHECK(extended.boundary == BoundaryStage::kPlain);
  }
}

TEST_CASE("fans that touch in a boundary vertex are separated, each with its own boundary",
          "[subdivide][boundary]") {
  SubdivisionLevel level = subdivide(baseLevel(openBowTie()), 1);
  CHECK(level.adjacency.twin == buildAdjacency(level.mesh).twin);
  CHECK(findDefects(level.mesh, level.adjacency).empty());
  CHECK(loopPoints(level).size() == 2);
  CHECK(test::eulerCharacteristic(level.mesh) == 2);
}

TEST_CASE("a boundary vertex of 5000 faces and a lone face of 5000 corners take linear time",
          "[subdivide][boundary][property]") {
  CHECK(subdivide(baseLevel(test::openFan(5000, 3)), 2).mesh.faceCount() > 5000);
  CHECK(subdivide(baseLevel(test::regularPolygon(5000)), 2).mesh.faceCount() > 5000);
}
