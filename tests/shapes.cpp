#include "tests/shapes.h"

#include "libvox/core/error.h"
#include "libvox/mesh/validate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <utility>

namespace vox::test {
namespace {

constexpr double kTau = 2 * std::numbers::pi;

Vec3d onCircle(int i, int n, double z) {
  return {std::cos(kTau * i / n), std::sin(kTau * i / n), z};
}

Index id(int i) {
  return static_cast<Index>(i);
}

}  // namespace

PolygonMesh meshOf(std::vector<Vec3d> points, std::initializer_list<std::vector<Index>> faces) {
  PolygonMesh mesh;
  mesh.points = std::move(points);
  for (const auto& face : faces) mesh.addFace(face);
  return mesh;
}

PolygonMesh cube() {
  std::vector<Vec3d> points;
  for (int i = 0; i < 8; ++i) points.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  return meshOf(
      points, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

PolygonMesh tetrahedron() {
  return meshOf({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}});
}

PolygonMesh regularPolygon(int sides) {
  PolygonMesh mesh;
  std::vector<Index> face;
  for (int i = 0; i < sides; ++i) {
    mesh.points.push_back(onCircle(i, sides, 0));
    face.push_back(id(i));
  }
  mesh.addFace(face);
  return mesh;
}

PolygonMesh pyramid(int sides) {
  PolygonMesh mesh = regularPolygon(sides);
  std::reverse(mesh.faceVertices.begin(), mesh.faceVertices.end());
  mesh.points.emplace_back(0, 0, 1.5);
  for (int i = 0; i < sides; ++i)
    mesh.addFace(std::vector<Index>{id(i), id((i + 1) % sides), id(sides)});
  return mesh;
}

PolygonMesh prism(int sides) {
  PolygonMesh mesh;
  std::vector<Index> bottom;
  std::vector<Index> top;
  for (int i = 0; i < sides; ++i) {
    mesh.points.push_back(onCircle(i, sides, -1));
    mesh.points.push_back(onCircle(i, sides, 1));
    bottom.insert(bottom.begin(), id(2 * i));
    top.push_back(id(2 * i + 1));
  }
  mesh.addFace(bottom);
  mesh.addFace(top);
  for (int i = 0; i < sides; ++i) {
    const int j = (i + 1) % sides;
    mesh.addFace(std::vector<Index>{id(2 * i), id(2 * j), id(2 * j + 1), id(2 * i + 1)});
  }
  return mesh;
}

PolygonMesh dodecahedron() {
  const double phi = std::numbers::phi;
  const double inv = 1 / phi;
  return meshOf({{1, 1, 1},       {1, 1, -1},      {1, -1, 1},     {1, -1, -1},    {-1, 1, 1},
                 {-1, 1, -1},     {-1, -1, 1},     {-1, -1, -1},   {0, inv, phi},  {0, inv, -phi},
                 {0, -inv, phi},  {0, -inv, -phi}, {inv, phi, 0},  {inv, -phi, 0}, {-inv, phi, 0},
                 {-inv, -phi, 0}, {phi, 0, inv},   {phi, 0, -inv}, {-phi, 0, inv}, {-phi, 0, -inv}},
                {{0, 8, 10, 2, 16},
                 {0, 16, 17, 1, 12},
                 {0, 12, 14, 4, 8},
                 {8, 4, 18, 6, 10},
                 {4, 14, 5, 19, 18},
                 {14, 12, 1, 9, 5},
                 {1, 17, 3, 11, 9},
                 {17, 16, 2, 13, 3},
                 {2, 10, 6, 15, 13},
                 {18, 19, 7, 15, 6},
                 {19, 5, 9, 11, 7},
                 {3, 13, 15, 7, 11}});
}

PolygonMesh torusGrid(int major, int minor) {
  PolygonMesh mesh;
  for (int i = 0; i < major; ++i)
    for (int j = 0; j < minor; ++j) {
      const double u = kTau * i / major;
      const double v = kTau * j / minor;
      const double r = 1 + 0.4 * std::cos(v);
      mesh.points.emplace_back(r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v));
    }
  const auto at = [&](int i, int j) { return id(i % major * minor + j % minor); };
  for (int i = 0; i < major; ++i)
    for (int j = 0; j < minor; ++j)
      mesh.addFace(std::vector<Index>{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  return mesh;
}

PolygonMesh wavyTriangles(int around, double jitter) {
  PolygonMesh quads = torusGrid(around, around / 2);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-jitter, jitter);
  const double size = around / 6.3;
  for (Vec3d& p : quads.points) {
    p *= size;
    p *= 1 + 0.02 * std::sin(p.x() * 0.4) * std::cos(p.y() * 0.3);
    p += Vec3d(shift(random), shift(random), shift(random));
  }
  PolygonMesh mesh;
  mesh.points = quads.points;
  for (Index f = 0; f < quads.faceCount(); ++f) {
    const auto face = quads.face(f);
    mesh.addFace(std::array{face[0], face[1], face[2]});
    mesh.addFace(std::array{face[0], face[2], face[3]});
  }
  return mesh;
}

PolygonMesh sheet(int columns, int rows) {
  PolygonMesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      mesh.points.emplace_back(i, j, 0.3 * std::sin(1.3 * i) * std::cos(0.7 * j));
  const auto at = [&](int i, int j) { return id(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      mesh.addFace(std::vector<Index>{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  return mesh;
}

PolygonMesh valenceTwo() {
  // A cube with one more point in the middle of an edge.
  PolygonMesh mesh = cube();
  mesh.points.emplace_back(0, -1.2, -1.2);
  PolygonMesh out;
  out.points = mesh.points;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    std::vector<Index> face;
    const auto old = mesh.face(f);
    for (std::size_t i = 0; i < old.size(); ++i) {
      const Index a = old[i];
      const Index b = old[(i + 1) % old.size()];
      face.push_back(a);
      if (a + b == 1) face.push_back(8);  // edge (0, 1)
    }
    out.addFace(face);
  }
  return out;
}

PolygonMesh bowTie() {
  PolygonMesh mesh = tetrahedron();
  const PolygonMesh other = tetrahedron();
  for (Index v = 1; v < 4; ++v) mesh.points.push_back(Vec3d(2, 2, 2) - other.points[v]);
  const auto moved = [](Index v) { return v == 0 ? 0 : v + 3; };
  for (Index f = 0; f < other.faceCount(); ++f) {
    std::vector<Index> face;
    for (const Index v : other.face(f)) face.insert(face.begin(), moved(v));  // mirrored: reversed
    mesh.addFace(face);
  }
  return mesh;
}

PolygonMesh moebius(int quads) {
  PolygonMesh mesh;
  for (int i = 0; i < quads; ++i) {
    const double u = kTau * i / quads;
    const Vec3d centre(std::cos(u), std::sin(u), 0);
    const Vec3d across = 0.3 * (std::cos(u / 2) * centre + std::sin(u / 2) * Vec3d::UnitZ());
    mesh.points.push_back(centre - across);
    mesh.points.push_back(centre + across);
  }
  for (int i = 0; i < quads; ++i) {
    const bool last = i + 1 == quads;
    const Index a = last ? 1 : id(2 * i + 2);
    const Index b = last ? 0 : id(2 * i + 3);
    mesh.addFace(std::vector<Index>{id(2 * i), a, b, id(2 * i + 1)});
  }
  return mesh;
}

PolygonMesh klein(int columns, int rows) {
  // A torus grid whose last column is glued to the first one upside down.
  PolygonMesh mesh = torusGrid(columns, rows);
  mesh.faceVertices.clear();
  mesh.faceOffsets = {0};
  const auto at = [&](int i, int j) {
    const int row = i < columns ? j : 2 * rows - j;
    return id(i % columns * rows + row % rows);
  };
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j)
      mesh.addFace(std::vector<Index>{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  return mesh;
}

PolygonMesh book(int count) {
  PolygonMesh mesh = meshOf({{0, 0, 0}, {0, 0, 1}}, {});
  for (int i = 0; i < count; ++i) {
    mesh.points.emplace_back(std::cos(0.7 * i), std::sin(0.7 * i), 0.5);
    mesh.addFace(std::vector<Index>{0, 1, mesh.pointCount() - 1});
  }
  return mesh;
}

PolygonMesh twoCones() {
  PolygonMesh mesh = regularPolygon(6);
  mesh.faceVertices.clear();
  mesh.faceOffsets = {0};
  for (int i = 0; i < 6; ++i) mesh.points.push_back(mesh.points[i] + Vec3d(0, 0, 2));
  mesh.points.emplace_back(0, 0, 1);
  for (Index ring = 0; ring < 12; ring += 6)
    for (Index i = 0; i < 6; ++i)
      mesh.addFace(std::vector<Index>{12, ring + i, ring + (i + 1) % 6});
  return mesh;
}

PolygonMesh finOnSheet() {
  PolygonMesh mesh = sheet(6, 4);
  const Index a = 2 * 7 + 2;  // the fin stands on the edges a, a + 1, a + 2
  const Index top = mesh.pointCount();
  for (Index i = 0; i < 3; ++i) mesh.points.push_back(mesh.points[a + i] + Vec3d(0, 0, 2));
  mesh.addFace(std::vector<Index>{a, a + 1, top + 1, top});
  mesh.addFace(std::vector<Index>{a + 1, a + 2, top + 2, top + 1});
  return mesh;
}

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> all = {
      {"cube", cube(), true},
      {"tetrahedron", tetrahedron(), true},
      {"pyramid 7", pyramid(7), true},
      {"prism 5", prism(5), true},
      {"prism 12", prism(12), true},
      {"dodecahedron", dodecahedron(), true},
      {"torus 8x5", torusGrid(8, 5), true},
      {"point of valence 2", valenceTwo(), true},
      {"bow tie", bowTie(), true},
      {"sheet 5x4", sheet(5, 4), false},
      {"single pentagon", regularPolygon(5), false},
  };
  return all;
}

PolygonMesh withoutFaces(const PolygonMesh& mesh, const std::vector<Index>& gone) {
  PolygonMesh out;
  out.points = mesh.points;
  for (Index f = 0; f < mesh.faceCount(); ++f)
    if (std::find(gone.begin(), gone.end(), f) == gone.end()) out.addFace(mesh.face(f));
  return out;
}

PolygonMesh openFan(int faces, int sides) {
  PolygonMesh mesh;
  mesh.points.emplace_back(0, 0, 0.3);
  const double step = 1.7 * std::numbers::pi / faces;
  const auto spoke = [&](double angle) {
    mesh.points.emplace_back(std::cos(angle), std::sin(angle), 0.2 * std::sin(3 * angle));
    return mesh.pointCount() - 1;
  };
  Index from = spoke(0);
  for (int f = 0; f < faces; ++f) {
    std::vector<Index> face = {0, from};
    for (int i = 1; i <= sides - 3; ++i) {
      const Index extra = spoke(step * (f + i / (sides - 2.0)));
      mesh.points[extra] *= 1.4;
      face.push_back(extra);
    }
    from = spoke(step * (f + 1));
    face.push_back(from);
    mesh.addFace(face);
  }
  return mesh;
}

PolygonMesh tube(int around, int along) {
  PolygonMesh mesh;
  for (int j = 0; j <= along; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      const double r = 1 + 0.3 * std::sin(1.1 * j + angle);
      mesh.points.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.7 * j);
    }
  const auto at = [&](int i, int j) { return static_cast<Index>(j * around + i % around); };
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i)
      mesh.addFace(std::vector<Index>{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  return mesh;
}

namespace {

std::vector<Shape> makeOpenShapes() {
  std::vector<Shape> all;
  for (int n = 3; n <= 8; ++n)
    all.push_back({"polygon " + std::to_string(n), regularPolygon(n), false});
  for (int faces = 1; faces <= 7; ++faces)
    for (int sides = 3; sides <= 8; ++sides)
      all.push_back({"fan " + std::to_string(faces) + " of " + std::to_string(sides),
                     openFan(faces, sides), false});
  all.push_back({"sheet", sheet(4, 3), false});
  all.push_back({"strip of quads", sheet(5, 1), false});
  all.push_back({"tube", tube(7, 3), false});
  all.push_back({"short tube", tube(3, 1), false});
  all.push_back({"open dodecahedron", withoutFaces(dodecahedron(), {0}), false});
  all.push_back({"dodecahedron of two holes", withoutFaces(dodecahedron(), {0, 10}), false});
  all.push_back(
      {"torus of holes", withoutFaces(torusGrid(9, 7), {0, 4, 16, 17, 30, 45, 60}), false});
  all.push_back({"cap", withoutFaces(pyramid(7), {0}), false});
  return all;
}

}  // namespace

const std::vector<Shape>& openShapes() {
  static const std::vector<Shape> all = makeOpenShapes();
  return all;
}

PolygonMesh unwelded(const PolygonMesh& mesh) {
  PolygonMesh out;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    std::vector<Index> face;
    for (const Index v : mesh.face(f)) {
      face.push_back(out.pointCount());
      out.points.push_back(mesh.points[v]);
    }
    out.addFace(face);
  }
  return out;
}

void flipFace(PolygonMesh& mesh, Index f) {
  std::reverse(mesh.faceVertices.begin() + mesh.faceOffsets[f],
               mesh.faceVertices.begin() + mesh.faceOffsets[f + 1]);
}

PolygonMesh insideOut(PolygonMesh mesh) {
  for (Index f = 0; f < mesh.faceCount(); ++f) flipFace(mesh, f);
  return mesh;
}

PolygonMesh stirred(PolygonMesh mesh, double flips, std::uint32_t seed) {
  std::mt19937 random(seed);
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto begin = mesh.faceVertices.begin() + mesh.faceOffsets[f];
    const auto end = mesh.faceVertices.begin() + mesh.faceOffsets[f + 1];
    std::rotate(begin, begin + random() % mesh.faceSize(f), end);
    if (std::uniform_real_distribution<double>()(random) < flips) flipFace(mesh, f);
  }
  return mesh;
}

PolygonMesh scaled(PolygonMesh mesh, double scale) {
  for (Vec3d& p : mesh.points) p *= scale;
  return mesh;
}

PolygonMesh moved(PolygonMesh mesh, const Vec3d& shift, double scale) {
  for (Vec3d& p : mesh.points) p = scale * p + shift;
  return mesh;
}

PolygonMesh together(PolygonMesh a, const PolygonMesh& b, const Vec3d& shift, double scale) {
  const Index offset = a.pointCount();
  for (const Vec3d& p : b.points) a.points.push_back(scale * p + shift);
  for (Index f = 0; f < b.faceCount(); ++f) {
    std::vector<Index> face;
    for (const Index v : b.face(f)) face.push_back(v + offset);
    a.addFace(face);
  }
  return a;
}

void mutate(PolygonMesh& mesh, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return static_cast<Index>(random() % n); };
  const Index f = below(mesh.faceCount());
  const auto begin = mesh.faceVertices.begin() + mesh.faceOffsets[f];
  const std::vector<Index> face(begin, begin + mesh.faceSize(f));
  switch (random() % 9) {
    case 0:
      std::reverse(begin, begin + static_cast<std::ptrdiff_t>(face.size()));
      break;
    case 1:
      mesh.addFace(face);
      break;
    case 2: {  // delete
      PolygonMesh rest;
      rest.points = mesh.points;
      for (Index g = 0; g < mesh.faceCount(); ++g)
        if (g != f || mesh.faceCount() == 1) rest.addFace(mesh.face(g));
      mesh = rest;
      break;
    }
    case 3:  // weld two vertices by name
      std::replace(mesh.faceVertices.begin(), mesh.faceVertices.end(), below(mesh.pointCount()),
                   below(mesh.pointCount()));
      break;
    case 4:  // collapse an edge
      std::replace(mesh.faceVertices.begin(), mesh.faceVertices.end(), Index(face[0]),
                   Index(face[1]));
      break;
    case 5:  // move a corner
      mesh.faceVertices[below(mesh.cornerCount())] = below(mesh.pointCount());
      break;
    case 6:  // weld two vertices by place
      mesh.points[below(mesh.pointCount())] = Vec3d(mesh.points[below(mesh.pointCount())]);
      break;
    case 7:  // a face of random vertices
      mesh.addFace(std::vector<Index>{below(mesh.pointCount()), below(mesh.pointCount()),
                                      below(mesh.pointCount()), below(mesh.pointCount())});
      break;
    default:  // swap two corners
      std::swap(mesh.faceVertices[below(mesh.cornerCount())],
                mesh.faceVertices[below(mesh.cornerCount())]);
  }
}

PolygonMesh shuffled(const PolygonMesh& mesh, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Index> newName(mesh.pointCount());
  std::iota(newName.begin(), newName.end(), 0);
  std::shuffle(newName.begin(), newName.end(), random);
  std::vector<Index> faceOrder(mesh.faceCount());
  std::iota(faceOrder.begin(), faceOrder.end(), 0);
  std::shuffle(faceOrder.begin(), faceOrder.end(), random);

  PolygonMesh out;
  out.points.resize(mesh.points.size());
  for (Index v = 0; v < mesh.pointCount(); ++v) out.points[newName[v]] = mesh.points[v];
  for (const Index f : faceOrder) {
    std::vector<Index> face;
    for (const Index v : mesh.face(f)) face.push_back(newName[v]);
    std::rotate(face.begin(), face.begin() + random() % face.size(), face.end());
    out.addFace(face);
  }
  return out;
}

bool sameMesh(const PolygonMesh& a, const PolygonMesh& b) {
  return a.points == b.points && a.faceOffsets == b.faceOffsets && a.faceVertices == b.faceVertices;
}

std::int64_t eulerCharacteristic(const PolygonMesh& mesh) {
  std::set<std::pair<Index, Index>> edges;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i)
      edges.insert(std::minmax(face[i], face[(i + 1) % face.size()]));
  }
  return std::int64_t{mesh.pointCount()} - static_cast<std::int64_t>(edges.size()) +
         mesh.faceCount();
}

std::string faultOf(const PolygonMesh& mesh) {
  try {
    requireValidArrays(mesh);
    const auto defects = findDefects(mesh, buildAdjacency(mesh), 1);
    return defects.empty() ? std::string() : defects[0].message;
  } catch (const Error& error) {
    return error.what();
  }
}

Vec3d centroid(const std::vector<Vec3d>& points) {
  Vec3d sum = Vec3d::Zero();
  for (const Vec3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

Vec3d faceCentroid(const PolygonMesh& mesh, Index f) {
  std::vector<Vec3d> corners;
  for (const Index v : mesh.face(f)) corners.push_back(mesh.points[v]);
  return centroid(corners);
}

bool samePoints(std::vector<Vec3d> a, std::vector<Vec3d> b, double tolerance) {
  if (a.size() != b.size()) return false;
  // Both clouds are sorted along a generic direction; points within the tolerance of each other
  // along it are searched.
  const Vec3d direction(0.5403023058681398, 0.3217505543966422, 0.7762943114830101);
  const auto less = [&](const Vec3d& p, const Vec3d& q) {
    return direction.dot(p) < direction.dot(q);
  };
  std::sort(a.begin(), a.end(), less);
  std::sort(b.begin(), b.end(), less);
  std::vector<bool> taken(b.size(), false);
  std::size_t first = 0;
  for (const Vec3d& p : a) {
    while (first < b.size() && taken[first]) ++first;
    bool found = false;
    for (std::size_t k = first; k < b.size() && !found; ++k) {
      if (direction.dot(b[k] - p) > 3 * tolerance) break;
      found = !taken[k] && (b[k] - p).lpNorm<Eigen::Infinity>() <= tolerance;
      if (found) taken[k] = true;
    }
    if (!found) return false;
  }
  return true;
}

}  // namespace vox::test
