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

double workOfDensity(double area) {
  return 13 * area;
}

double workOfSoftDensity(double area) {
  return 200 * area;
}

double workOfLevelSet(double area) {
  return 250 * area;
}

double workOfNormals(double area) {
  return 100 * area;
}

double workOfColor(double area) {
  return 250 * area;
}

double workOfWritingMask(double area) {
  return 8 * area;
}

double workOfWritingDensity(double area) {
  return 32 * area;
}

double workOfWritingNormals(double area) {
  return 150 * area;
}

double workOfWritingColor(double area) {
  return 100 * area;
}

}  // namespace vox
