// Sharp edges by angle, smoothing groups and lists.

#include "libvox/prepare/sharp_features.h"

#include "libvox/core/error.h"
#include "libvox/mesh/area_vector.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace vox {
namespace {

/// Marks the inner edges for which isSharp(face, other face) holds.
template <class IsSharp>
void markBetweenFaces(const Adjacency& adjacency, const InputElements& input, SharpFeatures& sharp,
                      IsSharp&& isSharp) {
  for (Index c = 0; c < static_cast<Index>(adjacency.twin.size()); ++c) {
    const Index t = adjacency.twin[c];
    if (t == kNone || t < c) continue;
    const Index f = adjacency.cornerFace[c];
    const Index g = adjacency.cornerFace[t];
    if (input.faces[f] != input.faces[g] && isSharp(f, g)) sharp.edges[c] = sharp.edges[t] = true;
  }
}

void requirePoint(Index v, const InputElements& input, const char* what) {
  if (v >= input.weldedTo.size())
    throw MeshError(std::string(what) + " names vertex " + std::to_string(v) +
                    ", but there are only " + std::to_string(input.weldedTo.size()));
}

PointPair ordered(Index a, Index b) {
  return a < b ? PointPair{a, b} : PointPair{b, a};
}

}  // namespace

SharpFeatures nothingSharp(const PolygonMesh& mesh) {
  return {std::vector<bool>(mesh.cornerCount(), false),
          std::vector<bool>(mesh.pointCount(), false)};
}

void markByAngle(const PolygonMesh& mesh, const Adjacency& adjacency, const InputElements& input,
                 double degrees, SharpFeatures& sharp) {
  constexpr double kRounding = 1e-12;
  const double limit = std::cos(degrees * std::numbers::pi / 180) - kRounding;
  const auto areaVectorOf = [&](Index f) {
    const auto face = mesh.face(f);
    return twiceAreaVector(face.size(), [&](std::size_t i) { return mesh.points[face[i]]; });
  };
  markBetweenFaces(adjacency, input, sharp, [&](Index f, Index g) {
    const Vec3d one = areaVectorOf(f).normalized();  // 0 for a face without area
    const Vec3d other = areaVectorOf(g).normalized();
    return !one.isZero() && !other.isZero() && one.dot(other) < limit;
  });
}

void markByGroups(const Adjacency& adjacency, const InputElements& input,
                  std::span<const std::uint32_t> groups, SharpFeatures& sharp) {
  markBetweenFaces(adjacency, input, sharp, [&](Index f, Index g) {
    const std::uint32_t one = groups[input.faces[f]];
    return one == 0 || one != groups[input.faces[g]];
  });
}

std::vector<std::size_t> markByPoints(const PolygonMesh& mesh, const Adjacency& adjacency,
                                      const InputElements& input, std::span<const PointPair> pairs,
                                      SharpFeatures& sharp) {
  struct Wanted {
    PointPair ends;
    std::size_t place;
  };
  std::vector<Wanted> wanted;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (const Index v : pairs[i]) requirePoint(v, input, "a sharp edge");
    wanted.push_back({ordered(input.weldedTo[pairs[i][0]], input.weldedTo[pairs[i][1]]), i});
  }
  const auto before = [](const Wanted& a, const Wanted& b) { return a.ends < b.ends; };
  std::stable_sort(wanted.begin(), wanted.end(), before);
  std::vector<bool> found(pairs.size(), false);
  for (Index c = 0; c < mesh.cornerCount(); ++c) {
    const Index from = mesh.faceVertices[c];
    const Index to = mesh.faceVertices[nextCorner(mesh, adjacency, c)];
    const Wanted edge{ordered(input.points[from], input.points[to]), 0};
    const auto [first, last] = std::equal_range(wanted.begin(), wanted.end(), edge, before);
    if (first == last) continue;
    for (auto it = first; it != last; ++it) found[it->place] = true;
    if (adjacency.twin[c] != kNone) sharp.edges[c] = sharp.edges[adjacency.twin[c]] = true;
  }
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (!found[i]) missing.push_back(i);
  return missing;
}

void markVertices(const InputElements& input, std::span<const Index> points, SharpFeatures& sharp) {
  std::vector<bool> wanted(input.weldedTo.size(), false);
  for (const Index v : points) {
    requirePoint(v, input, "a corner");
    wanted[input.weldedTo[v]] = true;
  }
  for (Index v = 0; v < input.points.size(); ++v)
    if (wanted[input.points[v]]) sharp.vertices[v] = true;
}

void markBoundaryCorners(const PolygonMesh& mesh, const Adjacency& adjacency,
                         SharpFeatures& sharp) {
  for (Index c = 0; c < mesh.cornerCount(); ++c)
    if (adjacency.twin[c] == kNone && adjacency.twin[previousCorner(mesh, adjacency, c)] == kNone)
      sharp.vertices[mesh.faceVertices[c]] = true;
}

}  // namespace vox
