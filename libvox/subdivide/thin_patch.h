#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/mesh/patch_parts.h"
#include "libvox/subdivide/stop.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace vox {

/// A regular vertex whose descendants crowd: a patch much longer than wide, or one whose rows and
/// columns run nearly the same way, as around a face of thousands of sides. Of the N x N vertices
/// it becomes, N = 2^levels, the outermost and some whole rows do for all of them.
///
/// Why they do. Between two such rows the patch is a strip. Say that all of it lies within a small
/// box E of the first of its rows, each point (i.e. each walk along the strip) at some place s of
/// that row, continued beyond its ends. Then the walk around the strip, along one row, a column,
/// the other row and back, can be filled with triangles whose corners are as close in s as
/// neighbours on the walk: cut off the corner where s is largest, again and again. No side of a
/// triangle is then longer than a step along the row, plus the size of E. With sides of at most a
/// voxel the strip, so filled, is as good as all the vertices in it, and what lies around it sees
/// the outermost vertices of all the N x N, as before. Source: DESIGN section 6 for mixed depths.
struct ThinPatch {
  Patch patch;  ///< the patch or its quarterTurn: rows run along v
  int levels;   ///< of its N vertices along u and v; one more than the patch needs, or as many
  std::vector<std::int64_t> rows;  ///< ascending; 0 and N - 1 among them
  /// With the two columns.
  std::int64_t vertices() const { return (static_cast<std::int64_t>(rows.size()) + 2) << levels; }
};

/// If the vertex is one and it pays.
/// @param levels  that the patch needs (patchDepth)
std::optional<ThinPatch> thinPatch(const Patch& patch, int levels);

/// Whether its four children, each as deep as it needs and thin if it is, have far fewer vertices:
/// where part of a patch turns back on itself, or is wide.
bool childrenAreCheaper(const ThinPatch& thin);

/// Calls thin(ThinPatch, level) or whole(patch, levels, level) for the parts that together are what
/// becomes of a regular vertex of `level`: for itself, or for descendants of it.
template <class Thin, class Whole>
void forParts(const Patch& patch, int level, Thin&& thin, Whole&& whole) {
  const int levels = patchDepth(patch);
  const auto rows = thinPatch(patch, levels);
  if (!rows) {
    whole(patch, levels, level);
  } else if (!childrenAreCheaper(*rows)) {
    thin(*rows, level);
  } else {
    for (const auto& pair : childrenOf(rows->patch))
      for (const Patch& child : pair) forParts(child, level + 1, thin, whole);
  }
}

}  // namespace vox
