#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/render/camera.h"
#include "libvox/render/visible.h"
#include "libvox/report/difference_look.h"
#include "libvox/report/picture.h"

#include <optional>
#include <span>
#include <vector>

namespace vox {

/// Which axis is up in all pictures of reports.
inline constexpr UpAxis kReportUp = UpAxis::kZ;

/// A grid as vox render shows it; grids that have no surface by themselves, such as colours, as
/// their active voxels. Empty if it has no active voxels or no linear transform.
std::optional<VisibleGrids> lookOf(const openvdb::GridBase::Ptr& grid);

/// A picture of the grid of one file alone, from above a corner.
/// @param name  of the file
Picture pictureOf(const VisibleGrids& visible, const std::string& name);

/// A and B side by side from the first view, what differs from all views, and a close-up of its
/// largest cluster. What differs shines through what hides it.
std::vector<Picture> differencePictures(const openvdb::GridBase::Ptr& a,
                                        const openvdb::GridBase::Ptr& b, const DifferenceLook& look,
                                        std::span<const View> views);

/// A and B over each other in world space, and closely where they lie farthest apart: for
/// transforms that differ.
std::vector<Picture> overlayPictures(const openvdb::GridBase& a, const openvdb::GridBase& b,
                                     const VisibleGrids& visibleA, const VisibleGrids& visibleB);

/// Pictures of the voxels of a grid from two sides, with some of them marked.
std::vector<Picture> markedPictures(const VisibleGrids& visible,
                                    std::span<const openvdb::Coord> marked);

}  // namespace vox
