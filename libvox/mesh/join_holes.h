#pragma once

#include "libvox/mesh/flat_polygon.h"

#include <optional>
#include <span>
#include <vector>

namespace vox {

/// Joins an outline and the holes in it to one weakly simple polygon, by a double bridge for each
/// hole. A bridge runs from the leftmost corner of a hole to the nearest corner that it can see, of
/// the outline or of a hole joined before. A hole that touches there needs no bridge.
///
/// @param flat   positions of all corners
/// @param loops  the outline, counter-clockwise, then holes, clockwise; each a list of corners
/// @return       corners, counter-clockwise; those at bridges occur twice. Nothing if some hole
///               finds no bridge: the loops cross.
/// Exact and deterministic. Cost O(h n) for h holes, as long as near corners can be seen.
std::optional<std::vector<Index>> joinHoles(std::span<const FlatPoint> flat,
                                            std::span<const std::vector<Index>> loops);

}  // namespace vox
