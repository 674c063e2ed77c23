// Approximate cost of the stages.

#include "libvox/pipeline/work.h"

namespace vox {

double workOfPreparing(const PolygonMesh& mesh, bool interpolates) {
  constexpr double kPerCorner = 300;
  return mesh.cornerCount() * (interpolates ? kPerCorner / kPartBeforeInterpolation : kPerCorner);
}

double workOfSurface(double area, std::uint64_t corners) {
  constexpr double kPerSquareVoxel = 4;
  constexpr double kPerCorner = 150;
  return kPerSquareVoxel * area + kPerCorner * static_cast<double>(corners);
}

double workOfGrid(GridKind kind, Edge edge, double area) {
  switch (kind) {
    case GridKind::kDensity:
      return (edge == Edge::kSoft ? 200 : 13) * area;
    case GridKind::kMask:
      return 0;
    case GridKind::kSurface:
      return 250 * area;
    case GridKind::kNormal:
      return 100 * area;
    case GridKind::kColor:
      return 250 * area;
    case GridKind::kPart:
      return 100 * area;
  }
  return 0;
}

double workOfWriting(GridKind kind, double area) {
  constexpr double kVoxelsOfBand = 4;  // of a level set, for each voxel of the surface
  switch (kind) {
    case GridKind::kDensity:
      return 32 * area;
    case GridKind::kMask:
      return 8 * area;
    case GridKind::kSurface:
      return kVoxelsOfBand * 32 * area;
    case GridKind::kNormal:
      return 150 * area;
    case GridKind::kColor:
      return 100 * area;
    case GridKind::kPart:
      return 32 * area;
  }
  return 0;
}

}  // namespace vox
