#pragma once

#include "libvox/inspect/camera.h"
#include "libvox/inspect/shading.h"
#include "libvox/inspect/visible.h"
#include "libvox/io/image.h"
#include "libvox/pipeline/run_options.h"

#include <vector>

namespace vox {

struct RenderOptions {
  std::vector<View> views = {*viewNamed("iso")};  ///< several make a contact sheet
  UpAxis up = UpAxis::kZ;
  Projection projection = Projection::kOrthographic;
  int width = 512;   ///< of a view, pixels
  int height = 512;  ///< the same
  int samples = 2;   ///< squared: rays per pixel
  ShadingOptions shading;
  Pixel background = {255, 255, 255, 255};  ///< its coverage is 0 or 255
  RunOptions run;
};

inline constexpr int kMostPixelsAcross = 16384;  ///< of a picture
inline constexpr int kMostSamples = 16;
inline constexpr int kMostOcclusionRays = 256;

/// Checks before the work starts what render would refuse.
/// @throws UsageError  an option is out of range
void requireRenderable(const RenderOptions& options);

/// Pictures of what there is to see: every view framed to fill its part of the image, all at one
/// scale if the projection is orthographic; row by row, as near to a square as it gets. The image
/// does not depend on the number of threads.
///
/// @throws UsageError  as requireRenderable
/// @throws LimitError  the image does not fit into memory
/// @throws Cancelled   options.run.progress says so; it is told a stage "render"
Image render(const VisibleGrids& visible, const RenderOptions& options);

}  // namespace vox
