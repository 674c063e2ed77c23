#pragma once

#include "libvox/core/names.h"

namespace vox {

/// Which normals are shaded. A level set always shows those of its isosurface.
enum class Shading {
  kCongradient,  ///< estimated from the voxels around
  kNormals,      ///< the stored ones; congradient where there is none
  kFlat,         ///< the sides of voxels, to see them
};
inline constexpr NameTable<Shading, 3> kShadingNames = {{{Shading::kCongradient, "congradient"},
                                                         {Shading::kNormals, "normals"},
                                                         {Shading::kFlat, "flat"}}};

struct ShadingOptions {
  Shading shading = Shading::kNormals;
  int occlusionRays = 0;  ///< per sample, for ambient occlusion; 0: none
};

}  // namespace vox
