// Narrow bands of distances by OpenVDB's meshToVolume.

#include "libvox/volume/level_set.h"

#include "libvox/grid/openvdb.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/ValueTransformer.h>

#include <cmath>
#include <limits>

namespace vox {
namespace {

/// A mesh with the interface that meshToVolume needs, in double precision.
class MeshAdapter {
 public:
  explicit MeshAdapter(const PolygonMesh& mesh) : mesh_(mesh) {}

  std::size_t polygonCount() const { return mesh_.faceCount(); }
  std::size_t pointCount() const { return mesh_.pointCount(); }
  std::size_t vertexCount(std::size_t polygon) const {
    return mesh_.faceSize(static_cast<Index>(polygon));
  }
  void getIndexSpacePoint(std::size_t polygon, std::size_t vertex, openvdb::Vec3d& point) const {
    point = openvdb::Vec3d(mesh_.points[mesh_.face(static_cast<Index>(polygon))[vertex]].data());
  }

 private:
  const PolygonMesh& mesh_;
};

/// Interrupter for OpenVDB: it ends the work when `cancelled` returns true.
struct Interrupter {
  const std::function<bool()>& cancelled;
  void start(const char*) {}
  void end() {}
  bool wasInterrupted(int = -1) { return cancelled(); }
};

/// Turns distances to the middle of a sheet into distances to the sheet.
void thicken(openvdb::FloatGrid& grid, float halfThickness) {
  openvdb::tools::foreach (grid.beginValueOn(), [halfThickness](const auto& value) {
    value.setValue(*value - halfThickness);
  });
}

/// The smallest float that is not below a value. (OpenVDB refuses a band a little below 3 voxels as
/// too narrow.)
float notBelow(double value) {
  const auto nearest = static_cast<float>(value);
  return double{nearest} < value ? std::nextafter(nearest, std::numeric_limits<float>::max())
                                 : nearest;
}

}  // namespace

openvdb::FloatGrid::Ptr distanceGrid(const PolygonMesh& polygons,
                                     const openvdb::math::Transform& transform, double band,
                                     DistanceTo what, const std::function<bool()>& cancelled) {
  constexpr double kHalfThickness = 0.5;
  const auto width = static_cast<float>(what == DistanceTo::kSheet ? band + kHalfThickness : band);
  const int flags = what == DistanceTo::kSolid ? 0 : openvdb::tools::UNSIGNED_DISTANCE_FIELD;
  Interrupter interrupter{cancelled};
  const auto grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
      interrupter, MeshAdapter(polygons), transform, width, width, flags);
  if (what == DistanceTo::kSheet)
    thicken(*grid, static_cast<float>(kHalfThickness * transform.voxelSize()[0]));
  openvdb::tools::changeLevelSetBackground(grid->tree(), notBelow(band * transform.voxelSize()[0]));
  grid->setGridClass(what == DistanceTo::kSurface ? openvdb::GRID_UNKNOWN
                                                  : openvdb::GRID_LEVEL_SET);
  return grid;
}

DistanceBytes bytesOfDistances(double area, double band) {
  using Leaf = openvdb::FloatTree::LeafNodeType;
  // On average over directions, a surface reaches leaves within 12 voxels around it.
  const double leaves = area * (12 + 2 * band) / Leaf::SIZE;
  const double bytes = leaves * (sizeof(Leaf) + Leaf::SIZE * sizeof(float));
  constexpr double kPeak = 3;  // also the nearest polygon of each voxel, and parts not yet merged
  return {kPeak * bytes, bytes};
}

}  // namespace vox
