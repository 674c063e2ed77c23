// Steps from voxel to voxel that cross a surface an odd number of times, exact on a lattice.

#include "libvox/inspect/crossings.h"

#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/inspect/separation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vox {
namespace {

__extension__ using Int128 = __int128;

LatticePoint latticePoint(const Vec3d& point) {
  const auto snap = [](double x) { return std::llround(x * static_cast<double>(kLattice)); };
  return {snap(point.x()), snap(point.y()), snap(point.z())};
}

std::int64_t floorOf(std::int64_t lattice) {
  return lattice >> 16;
}

/// True if the column (atU, atV), on the lattice, pierces a triangle.
bool holds(const LatticeTriangle& triangle, std::size_t u, std::size_t v, std::int64_t atU,
           std::int64_t atV) {
  bool inside = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const LatticePoint* low = &triangle[i];
    const LatticePoint* high = &triangle[(i + 1) % 3];
    if (((*low)[v] > atV) == ((*high)[v] > atV)) continue;
    if ((*low)[v] > (*high)[v]) std::swap(low, high);
    const auto a = static_cast<Int128>((*high)[u] - (*low)[u]) * (atV - (*low)[v]);
    const auto b = static_cast<Int128>(atU - (*low)[u]) * ((*high)[v] - (*low)[v]);
    if (b < a) inside = !inside;
  }
  return inside;
}

}  // namespace

std::vector<LatticeTriangle> onLattice(const ReferenceSurface& surface) {
  std::vector<LatticeTriangle> all;
  all.reserve(surface.triangles.size());
  for (const auto& [a, b, c] : surface.triangles) {
    all.push_back({latticePoint(surface.points[a]), latticePoint(surface.points[b]),
                   latticePoint(surface.points[c])});
    std::sort(all.back().begin(), all.back().end());
  }
  parallelSort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

std::vector<LatticeEdge> boundaryOf(std::span<const LatticeTriangle> triangles) {
  std::vector<LatticeEdge> edges;
  edges.reserve(3 * triangles.size());
  for (const auto& [a, b, c] : triangles)
    for (const LatticeEdge& edge : {LatticeEdge{a, b}, LatticeEdge{b, c}, LatticeEdge{a, c}})
      if (edge[0] != edge[1]) edges.push_back(edge);
  parallelSort(edges);
  std::vector<LatticeEdge> boundary;
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin + 1;
    while (end < edges.size() && edges[end] == edges[begin]) ++end;
    if (end - begin != 2) boundary.push_back(edges[begin]);
    begin = end;
  }
  return boundary;
}

void Crossings::add(const LatticeTriangle& triangle) {
  const std::size_t u = (axis_ + 1) % 3;
  const std::size_t v = (axis_ + 2) % 3;
  const auto range = [&](std::size_t axis) {
    const auto [low, high] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
    return std::pair(-floorOf(-low), floorOf(high));  // centres within
  };
  const auto [lowU, highU] = range(u);
  const auto [lowV, highV] = range(v);
  for (std::int64_t atU = lowU; atU <= highU; ++atU)
    for (std::int64_t atV = lowV; atV <= highV; ++atV)
      if (holds(triangle, u, v, atU * kLattice, atV * kLattice)) toggle(triangle, u, v, atU, atV);
}

void Crossings::toggle(const LatticeTriangle& triangle, std::size_t u, std::size_t v,
                       std::int64_t atU, std::int64_t atV) {
  // Relative to a corner, where doubles are exact enough: a step can only be wrong if the surface
  // passes through a centre, and then that voxel is active.
  const auto relative = [&](std::size_t corner, std::size_t axis) {
    return static_cast<double>(triangle[corner][axis] - triangle[0][axis]);
  };
  const double u1 = relative(1, u), v1 = relative(1, v), w1 = relative(1, axis_);
  const double u2 = relative(2, u), v2 = relative(2, v), w2 = relative(2, axis_);
  const auto pu = static_cast<double>(atU * kLattice - triangle[0][u]);
  const auto pv = static_cast<double>(atV * kLattice - triangle[0][v]);
  const double area = u1 * v2 - u2 * v1;
  const double height = ((pu * v2 - u2 * pv) * w1 + (u1 * pv - pu * v1) * w2) / area;
  const std::int64_t at = triangle[0][axis_] + std::llround(height);
  openvdb::Coord voxel;
  voxel[static_cast<int>(u)] = static_cast<std::int32_t>(atU);
  voxel[static_cast<int>(v)] = static_cast<std::int32_t>(atV);
  voxel[static_cast<int>(axis_)] = static_cast<std::int32_t>(floorOf(at));
  accessor_.setActiveState(voxel, !accessor_.isValueOn(voxel));
}

}  // namespace vox
