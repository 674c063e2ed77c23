#pragma once

#include "libvox/core/image.h"
#include "libvox/grid/openvdb_fwd.h"
#include "libvox/render/camera.h"
#include "libvox/render/shading_options.h"
#include "libvox/render/visible_options.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace vox {

class Progress;
struct VisibleGrids;

struct RenderOptions {
  std::vector<View> views = {*viewNamed("iso")};  ///< several make a contact sheet
  UpAxis up = UpAxis::kZ;
  Projection projection = Projection::kOrthographic;
  int width = 512;   ///< of a view, pixels
  int height = 512;  ///< the same
  int samples = 2;   ///< squared: rays per pixel
  ShadingOptions shading;
  Pixel background = {255, 255, 255, 255};  ///< its coverage is 0 or 255
  std::uint64_t maxMemory = 0;   ///< bytes for the image; 0: three quarters of what is free
  int threads = 0;               ///< 0: all processors
  Progress* progress = nullptr;  ///< is told how far the run is; may cancel it
};

inline constexpr int kMostPixelsAcross = 16384;  ///< of a picture
inline constexpr int kMostSamples = 16;
inline constexpr int kMostOcclusionRays = 256;

/// Makes a camera show the boxes of all voxels.
void addBoxes(const VisibleGrids& visible, Framing& framing);

/// Checks the options before the work starts.
/// @throws UsageError  an option is out of range
void requireRenderable(const RenderOptions& options);

/// Pictures of grids, one for each view, in rows that make the image as near to a square as
/// possible. Every view fills its part of the image; orthographic views all have the same scale.
/// The image does not depend on the number of threads.
///
/// @throws UsageError  as requireRenderable
/// @throws LimitError  the image does not fit into memory
/// @throws Cancelled   options.progress is cancelled; its stage is "render"
Image render(const VisibleGrids& visible, const RenderOptions& options);

/// The same with a camera for each view: views, up and projection of the options do not count.
Image render(const VisibleGrids& visible, std::span<const Camera> cameras,
             const RenderOptions& options);

/// Pictures of the grids of a file: of visibleGrids(grids, what), which may throw besides.
Image render(std::span<const std::shared_ptr<openvdb::GridBase>> grids, const VisibleOptions& what,
             const RenderOptions& options);

}  // namespace vox
