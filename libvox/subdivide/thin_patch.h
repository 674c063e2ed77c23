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
/// it becomes, N = 2^levels, the outermost and some whole rows do for all of them: the strips
/// between these rows can be filled from around with faces as small as vertex conversion needs
/// (patch_strips.h), and what lies around the patch sees the outermost of all N x N vertices, as it
/// would of a whole one (mixed depths, DESIGN section 6).
struct ThinPatch {
  Patch patch;  ///< seen from one of its four sides: rows run along v
  int levels;   ///< of its N vertices along u and v; one more than the patch needs, or as many
  std::vector<std::int64_t> rows;  ///< ascending; 0 and N - 1 among them
  /// With the two columns.
  std::int64_t vertices() const { return (static_cast<std::int64_t>(rows.size()) + 2) << levels; }
};

/// If the vertex is one and it pays.
/// @param patch   of finite points
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
