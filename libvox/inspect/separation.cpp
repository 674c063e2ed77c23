// Tunnels, by flood and parity.

#include "libvox/inspect/separation.h"

#include "libvox/grid/openvdb.h"
#include "libvox/grid/voxel.h"
#include "libvox/inspect/crossings.h"
#include "libvox/mesh/triangulate.h"
#include "libvox/options/voxelize.h"
#include "libvox/voxelize/scan.h"

#include <Eigen/Geometry>
#include <openvdb/tools/Morphology.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::MaskTree;
using Accessor = openvdb::tree::ValueAccessor<MaskTree>;
using ConstAccessor = openvdb::tree::ValueAccessor<const MaskTree>;

/// True if a triangle, given relative to the centre of a cube, meets the cube: no axis separates
/// them. Candidates are the axes of the cube, the normal, and the products of the axes with the
/// sides.
bool meetsCube(const std::array<Vec3d, 3>& t, double halfSide) {
  const auto apart = [&](const Vec3d& axis) {
    const auto [low, high] = std::minmax({axis.dot(t[0]), axis.dot(t[1]), axis.dot(t[2])});
    const double reach = halfSide * axis.lpNorm<1>();
    return low > reach || high < -reach;
  };
  for (int i = 0; i < 3; ++i)
    if (apart(Vec3d::Unit(i))) return false;
  const std::array<Vec3d, 3> sides = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  if (apart(sides[0].cross(sides[1]))) return false;
  for (const Vec3d& side : sides)
    for (int i = 0; i < 3; ++i)
      if (apart(side.cross(Vec3d::Unit(i)))) return false;
  return true;
}

/// Voxels whose closed cubes meet the surface.
MaskTree voxelsOn(const ReferenceSurface& surface) {
  MaskTree voxels;
  Accessor accessor(voxels);
  scanTriangles(surface.points, surface.triangles, Separation::k26, [&](const VoxelBlock& block) {
    forEachVoxel(block, [&](int x, int y, int z) { accessor.setValueOn({x, y, z}); });
  });
  return voxels;
}

/// Adds all voxels within a distance (L-inf).
void widen(MaskTree& voxels, int distance) {
  openvdb::tools::dilateActiveValues(voxels, distance, openvdb::tools::NN_FACE_EDGE_VERTEX,
                                     openvdb::tools::IGNORE_TILES);
}

/// Voxels within 1/2 and the tolerance (L-inf) of the surface.
MaskTree layerAround(const ReferenceSurface& surface) {
  const double tolerance = surface.tolerance;
  if (tolerance == 0) return voxelsOn(surface);
  if (tolerance >= 1) {
    MaskTree layer = voxelsOn(surface);
    widen(layer, static_cast<int>(std::ceil(tolerance)));
    return layer;
  }
  MaskTree layer;
  Accessor accessor(layer);
  const Vec3d reach = Vec3d::Constant(tolerance);  // voxelOf adds the half
  for (const auto& [i, j, k] : surface.triangles) {
    const Vec3d& a = surface.points[i];
    const Vec3d& b = surface.points[j];
    const Vec3d& c = surface.points[k];
    const CoordBBox box(voxelOf(a.cwiseMin(b).cwiseMin(c) - reach),
                        voxelOf(a.cwiseMax(b).cwiseMax(c) + reach));
    for (const Coord& voxel : box) {
      if (accessor.isValueOn(voxel)) continue;
      const Vec3d centre(voxel.x(), voxel.y(), voxel.z());
      if (meetsCube({a - centre, b - centre, c - centre}, 0.5 + tolerance))
        accessor.setValueOn(voxel);
    }
  }
  return layer;
}

/// Voxels within about two, and the tolerance, of the boundary.
MaskTree rimOf(std::span<const LatticeTriangle> triangles, double tolerance) {
  const int wide = 2 + static_cast<int>(tolerance);
  MaskTree rim;
  Accessor accessor(rim);
  const auto inVoxels = [](const LatticePoint& p) {
    return Vec3d(Eigen::Map<const Eigen::Matrix<std::int64_t, 3, 1>>(p.data()).cast<double>() /
                 static_cast<double>(kLattice));
  };
  for (const LatticeEdge& edge : boundaryOf(triangles)) {
    const Vec3d from = inVoxels(edge[0]);
    const Vec3d along = inVoxels(edge[1]) - from;
    const int steps = 1 + static_cast<int>(along.cwiseAbs().maxCoeff());
    for (int i = 0; i <= steps; ++i) {
      const Coord at = voxelOf(from + along * i / steps);
      for (const Coord& voxel : CoordBBox(at.offsetBy(-wide), at.offsetBy(wide)))
        accessor.setValueOn(voxel);
    }
  }
  return rim;
}

/// The space around a surface, with the queries of a flood.
class Space {
 public:
  Space(const MaskTree& voxels, const ReferenceSurface& surface,
        std::span<const LatticeTriangle> triangles)
      : layer_(layerAround(surface)),
        rim_(rimOf(triangles, surface.tolerance)),
        voxels_(voxels),
        inLayer_(layer_),
        inRim_(rim_),
        crossings_{Crossings(0), Crossings(1), Crossings(2)} {
    for (const LatticeTriangle& triangle : triangles)
      for (Crossings& crossings : crossings_) crossings.add(triangle);
  }

  const MaskTree& layer() const { return layer_; }
  bool isInactive(const Coord& voxel) const { return !voxels_.isValueOn(voxel); }
  bool isInLayer(const Coord& voxel) const { return inLayer_.isValueOn(voxel); }

  /// True if a step to a neighbour crosses the surface away from its boundary.
  bool crosses(const Coord& from, const Coord& to) const {
    const Coord lower = std::min(from, to);
    const std::size_t axis = from.x() != to.x() ? 0 : from.y() != to.y() ? 1 : 2;
    return crossings_[axis].odd().isValueOn(lower) && !inRim_.isValueOn(lower);
  }

 private:
  MaskTree layer_;
  MaskTree rim_;
  ConstAccessor voxels_;
  ConstAccessor inLayer_;
  ConstAccessor inRim_;
  std::array<Crossings, 3> crossings_;
};

template <class Visit>
void forEachNeighbour(const Coord& voxel, Visit&& visit) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int step : {-1, 1}) {
      Coord next = voxel;
      next[axis] += step;
      visit(next);
    }
}

/// Connected inactive voxels of the layer, with the side of each: crossings modulo 2.
class Flood {
 public:
  explicit Flood(const Space& space) : space_(space), visited_(visitedTree_), far_(farTree_) {}

  bool hasVisited(const Coord& voxel) const { return visited_.isValueOn(voxel); }

  struct Cluster {
    bool leaks = false;
    std::vector<Coord> holes;  ///< lower ends of steps that cross between inactive voxels
  };

  Cluster flood(const Coord& start) {
    Cluster cluster;
    std::array<bool, 2> reachesFar{};
    std::vector<Coord> left = {start};
    visited_.setValueOn(start);
    while (!left.empty()) {
      const Coord voxel = left.back();
      left.pop_back();
      forEachNeighbour(voxel, [&](const Coord& next) {
        if (!space_.isInactive(next)) return;
        const bool crosses = space_.crosses(voxel, next);
        const bool side = far_.isValueOn(voxel) != crosses;
        if (crosses) cluster.holes.push_back(std::min(voxel, next));
        if (!space_.isInLayer(next)) {
          reachesFar[side ? 1 : 0] = true;
        } else if (!visited_.isValueOn(next)) {
          visited_.setValueOn(next);
          if (side) far_.setValueOn(next);
          left.push_back(next);
        } else if (far_.isValueOn(next) != side) {
          cluster.leaks = true;
        }
      });
    }
    cluster.leaks = cluster.leaks || (reachesFar[0] && reachesFar[1]);
    return cluster;
  }

 private:
  const Space& space_;
  MaskTree visitedTree_;
  MaskTree farTree_;
  Accessor visited_;
  Accessor far_;
};

/// True if a short path of inactive voxels leads out of the layer without crossing the surface.
bool leadsOut(const Space& space, const Coord& start) {
  constexpr int kReach = 6;
  std::set<Coord> seen = {start};
  std::deque<Coord> left = {start};
  while (!left.empty()) {
    const Coord voxel = left.front();
    left.pop_front();
    if (!space.isInLayer(voxel)) return true;
    forEachNeighbour(voxel, [&](const Coord& next) {
      const Coord d = next - start;
      if (std::max({std::abs(d.x()), std::abs(d.y()), std::abs(d.z())}) > kReach) return;
      if (space.isInactive(next) && !space.crosses(voxel, next) && seen.insert(next).second)
        left.push_back(next);
    });
  }
  return false;
}

/// The steps that are holes, not entrances of pockets. All steps if no step is known to be a hole.
std::vector<Coord> throughHoles(const Space& space, std::vector<Coord> steps) {
  std::sort(steps.begin(), steps.end());
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
  std::vector<Coord> holes;
  for (const Coord& lower : steps)
    for (int axis = 0; axis < 3; ++axis) {
      Coord upper = lower;
      ++upper[axis];
      if (!space.isInactive(lower) || !space.isInactive(upper) || !space.crosses(lower, upper))
        continue;
      if (leadsOut(space, lower) && leadsOut(space, upper)) holes.push_back(lower);
    }
  holes.erase(std::unique(holes.begin(), holes.end()), holes.end());
  return holes.empty() ? steps : holes;
}

void note(SeparationReport& report, const std::vector<Coord>& holes) {
  report.tunnels += std::max<std::size_t>(1, holes.size());
  for (const Coord& hole : holes) {
    const VoxelIndex at = {hole.x(), hole.y(), hole.z()};
    if (!report.first || at < *report.first) report.first = at;
  }
}

SeparationReport findTunnels6(const MaskTree& voxels, const ReferenceSurface& surface) {
  const Space space(voxels, surface, onLattice(surface));
  Flood flood(space);
  SeparationReport report;
  for (auto voxel = space.layer().cbeginValueOn(); voxel; ++voxel) {
    const Coord at = voxel.getCoord();
    if (!space.isInactive(at) || flood.hasVisited(at)) continue;
    const Flood::Cluster cluster = flood.flood(at);
    if (cluster.leaks) note(report, throughHoles(space, cluster.holes));
  }
  return report;
}

}  // namespace

ReferenceSurface referenceSurface(PolygonMesh mesh, double tolerance) {
  ReferenceSurface surface;
  FaceTriangulator faces;
  for (Index f = 0; f < mesh.faceCount(); ++f) faces.add(mesh, f, surface.triangles);
  surface.points = std::move(mesh.points);
  surface.tolerance = tolerance;
  return surface;
}

std::optional<int> reachOf(const ReferenceSurface& reference, const ReferenceSurface& other) {
  const MaskTree voxels = voxelsOn(other);
  MaskTree layer = voxelsOn(reference);
  constexpr int kMostReach = 32;
  for (int reach = 0; reach <= kMostReach; ++reach) {
    MaskTree left(voxels);
    left.topologyDifference(layer);
    if (left.activeVoxelCount() == 0) return reach;
    widen(layer, 1);
  }
  return std::nullopt;
}

SeparationReport findTunnels(const MaskTree& voxels, const ReferenceSurface& surface,
                             Separation separation) {
  if (separation == Separation::k6) return findTunnels6(voxels, surface);
  SeparationReport report;
  MaskTree missing = voxelsOn(surface);
  missing.topologyDifference(voxels);
  std::vector<Coord> holes;
  for (auto voxel = missing.cbeginValueOn(); voxel; ++voxel) holes.push_back(voxel.getCoord());
  if (!holes.empty()) note(report, holes);
  return report;
}

}  // namespace vox
