// Voxel size and place of the voxels of another file.

#include "libvox/io/read_lattice.h"

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/read_vdb.h"

#include <cmath>
#include <filesystem>
#include <sstream>
#include <system_error>
#include <utility>

namespace vox {
namespace {

struct GridName {
  std::filesystem::path file;
  std::string grid;  // "": the first one
};

/// Names of files and of grids may have colons: the longest name of a file wins.
GridName gridNameIn(const std::string& reference) {
  std::error_code unused;
  if (std::filesystem::exists(reference, unused)) return {reference, ""};
  for (std::size_t colon = reference.rfind(':'); colon != std::string::npos && colon > 0;
       colon = reference.rfind(':', colon - 1)) {
    const std::string file = reference.substr(0, colon);
    if (std::filesystem::exists(file, unused)) return {file, reference.substr(colon + 1)};
  }
  return {reference, ""};
}

using Matrix = openvdb::math::Mat4d;  // of row vectors: p' = p M

bool isFinite(const Matrix& m) {
  for (unsigned i = 0; i < Matrix::numElements(); ++i)
    if (!std::isfinite(m.asPointer()[i])) return false;
  return true;
}

/// Why a transform is no lattice of cubes along the axes: "is rotated". Empty if it is one.
std::string faultOf(const openvdb::math::Transform& transform) {
  if (!transform.isLinear()) return "is a frustum";
  const Matrix m = transform.baseMap()->getAffineMap()->getMat4();
  if (!isFinite(m)) return "is not finite";
  double offDiagonal = 0;
  double skew = 0;  // 0: the axes are perpendicular
  double size = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      double product = 0;
      for (int k = 0; k < 3; ++k) product += m(i, k) * m(j, k);
      (i == j ? size : skew) += std::abs(product);
      if (i != j) offDiagonal += std::abs(m(i, j));
    }
  constexpr double kRounding = 1e-9;
  if (offDiagonal != 0) return skew > kRounding * size ? "is sheared" : "is rotated";
  if (!(m(0, 0) > 0 && m(1, 1) > 0 && m(2, 2) > 0)) return "is mirrored or flat";
  constexpr double kRoundingOfCopies = 1e-12;  // OpenVDB rounds when it copies some transforms
  const auto isCubic = [&](int axis) {
    return std::abs(m(axis, axis) - m(0, 0)) <= kRoundingOfCopies * m(0, 0);
  };
  if (isCubic(1) && isCubic(2)) return {};
  std::ostringstream text;
  text << "has voxels of " << m(0, 0) << " x " << m(1, 1) << " x " << m(2, 2);
  return text.str();
}

FileLattice latticeOf(const NamedGrid& named, const std::string& file, bool withBox) {
  const std::string subject = file + ": grid '" + named.name + "' ";
  const std::string fault = faultOf(named.grid->transform());
  if (!fault.empty())
    throw InputError(
        subject + fault +
        ", but vox makes cubes along the axes; resample that grid, or use --voxel-size");
  const Matrix m = named.grid->transform().baseMap()->getAffineMap()->getMat4();
  FileLattice lattice{m(0, 0), {m(3, 0), m(3, 1), m(3, 2)}, {}};
  if (!withBox) return lattice;
  const openvdb::CoordBBox box = named.grid->evalActiveVoxelBoundingBox();
  if (box.empty()) throw InputError(subject + "has no active voxel that --clip could clip to");
  lattice.activeBox = {box.min().x(), box.min().y(), box.min().z(),
                       box.max().x(), box.max().y(), box.max().z()};
  return lattice;
}

}  // namespace

FileLattice readLattice(const std::string& reference, bool withBox) {
  const GridName wanted = gridNameIn(reference);
  const std::string file = wanted.file.string();
  std::optional<FileLattice> lattice;
  std::string names;
  forEachGrid(wanted.file, [&](const NamedGrid& grid) {
    names += (names.empty() ? "" : ", ") + grid.name;
    if (!lattice && (wanted.grid.empty() || grid.name == wanted.grid))
      lattice = latticeOf(grid, file, withBox);
  });
  if (lattice) return *lattice;
  if (names.empty()) throw InputError(file + ": holds no grid");
  throw InputError(file + ": has no grid '" + wanted.grid + "'; it has " + names);
}

}  // namespace vox
