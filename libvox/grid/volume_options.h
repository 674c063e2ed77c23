#pragma once

#include "libvox/core/names.h"

#include <optional>

namespace vox {

/// What of an object `density` holds.
enum class Fill {
  kSurface,  ///< the black voxels
  kSolid,    ///< and what they enclose
};
inline constexpr NameTable<Fill, 2> kFillNames = {
    {{Fill::kSurface, "surface"}, {Fill::kSolid, "solid"}}};

/// What a component that has no inside (one with boundary, or one-sided) is to a volume.
enum class OpenMesh {
  kError,    ///< a reason to refuse the object
  kSurface,  ///< a surface: `density` has its voxels
};
inline constexpr NameTable<OpenMesh, 2> kOpenMeshNames = {
    {{OpenMesh::kError, "error"}, {OpenMesh::kSurface, "surface"}}};

/// How to make volumes, as far as somebody said.
struct VolumeOptions {
  std::optional<Fill> fill;          ///< default: kSurface
  std::optional<double> gain;        ///< value of `density` at its voxels; default 1
  std::optional<OpenMesh> openMesh;  ///< default: kSurface
};

/// What `first` says, and `second` where it is silent.
VolumeOptions overriding(const VolumeOptions& first, const VolumeOptions& second);

/// @throws UsageError  gain is not a positive number that a float holds
void requireValid(const VolumeOptions& options);

}  // namespace vox
