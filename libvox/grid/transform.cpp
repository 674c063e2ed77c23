// World space and index space; the voxel size.

#include "libvox/grid/transform.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <sstream>
#include <vector>

namespace vox {
namespace {

std::string str(double x) {
  std::ostringstream out;
  out.precision(6);
  out << x;
  return out.str();
}

}  // namespace

Box usedBox(const PolygonMesh& mesh) {
  constexpr std::size_t kCornersPerPart = 1 << 16;
  const std::span<const Index> corners = mesh.faceVertices;
  std::vector<Box> parts((corners.size() + kCornersPerPart - 1) / kCornersPerPart);
  parallelForEach(parts.size(), 1, [&](std::size_t p) {
    const std::size_t first = p * kCornersPerPart;
    for (const Index v : corners.subspan(first, std::min(kCornersPerPart, corners.size() - first)))
      parts[p].add(mesh.points[v]);
  });
  Box box;
  for (const Box& part : parts) box.add(part);  // in order: 0 and -0 stay what they were
  return box;
}

Box boxOf(const PolygonMesh& mesh, std::span<const Index> faces) {
  Box box;
  for (const Index f : faces)
    for (const Index v : mesh.face(f)) box.add(mesh.points[v]);
  return box;
}

Turn turnFor(std::optional<UpAxis> up, Target target) {
  const UpAxis targetUp = target == Target::kHoudini ? UpAxis::kY : UpAxis::kZ;
  if (up.value_or(targetUp) == targetUp) return Turn::kNoTurn;
  return targetUp == UpAxis::kZ ? Turn::kYToZ : Turn::kZToY;
}

GridTransform transformForDim(const Box& box, int dim) {
  if (dim < 1) throw UsageError("--dim must be at least 1, not " + std::to_string(dim));
  const double side = box.longestSide();
  if (!(side > 0))
    throw InputError("all vertices coincide, so --dim cannot set a voxel size; use --voxel-size");
  return transformForVoxelSize(side / dim);
}

GridTransform transformForVoxelSize(double voxelSize) {
  if (!(voxelSize > 0) || !std::isfinite(voxelSize))
    throw UsageError("--voxel-size must be a positive number, not " + str(voxelSize));
  if (voxelSize < kMinVoxelSize || voxelSize > kMaxVoxelSize) {
    const bool small = voxelSize < kMinVoxelSize;
    const double limit = small ? kMinVoxelSize : kMaxVoxelSize;
    const double power = std::log10(limit / voxelSize);
    const double scale = std::pow(10.0, small ? std::ceil(power) : std::floor(power));
    throw LimitError("a voxel size of " + str(voxelSize) + " is out of OpenVDB's range, " +
                     str(kMinVoxelSize) + " to " + str(kMaxVoxelSize) + "; make the model " +
                     str(scale) + " times as large with --scale, or use " +
                     (small ? "larger" : "smaller") + " voxels");
  }
  return {.voxelSize = voxelSize};
}

void requireInRange(const Box& boxWorld, const GridTransform& transform, const std::string& what) {
  if (boxWorld.empty()) return;
  const auto farthest = [&](const Vec3d& p) {
    return (turned(p, transform.turn) - transform.origin).cwiseAbs().maxCoeff();
  };
  const double reach = std::max(farthest(boxWorld.low), farthest(boxWorld.high));
  if (reach / transform.voxelSize < kMaxIndex) return;
  if (!transform.origin.isZero(0))
    throw LimitError(what + " reaches " + str(reach) +
                     " world units from voxel (0, 0, 0) of the lattice, more than 2^30 voxels of "
                     "size " +
                     str(transform.voxelSize) + "; take the lattice of a file nearer to it");
  throw LimitError(what + " reaches " + str(reach) +
                   " world units from the origin, more than 2^30" + " voxels of size " +
                   str(transform.voxelSize) + "; use a voxel size of at least " +
                   str(reach / kMaxIndex * 1.001) + " or move the input nearer to the origin");
}

}  // namespace vox
