#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/stop.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace vox {

/// A regular vertex whose descendants crowd: a patch much longer than wide, or one whose rows and
/// columns run nearly the same way, as around a face of thousands of sides. Of the N x N vertices
/// it becomes, N = 2^levels, the outermost and some whole rows do for all of them: the strips
/// between these rows can be filled from around with faces as small as vertex conversion needs
/// (patch_strips.h), and what lies around the patch sees the outermost of all N x N vertices, as it
/// would of a whole one (mixed depths, DESIGN section 9).
struct ThinPatch {
  Patch patch;  ///< seen from one of its four sides: rows run along v
  int levels;   ///< of its N vertices along u and v; one more than the patch needs, or as many
  std::vector<std::int64_t> rows;              ///< ascending; 0 and N - 1 among them
  static constexpr std::int64_t kColumns = 2;  ///< the first and the last
  std::int64_t vertices() const {
    return (static_cast<std::int64_t>(rows.size()) + kColumns) << levels;
  }
};

/// If the vertex is one and it pays.
/// @param patch   of finite points
/// @param levels  that the patch needs (patchDepth)
std::optional<ThinPatch> thinPatch(const Patch& patch, int levels);

/// A regular vertex, as deep as it needs, and thin if it is.
struct PatchPart {
  explicit PatchPart(const Patch& vertex)
      : patch(vertex), levels(patchDepth(vertex)), thin(thinPatch(vertex, levels)) {}
  Patch patch;
  int levels;
  std::optional<ThinPatch> thin;
};

/// The four children, if these have far fewer vertices: where part of a patch turns back on itself,
/// or is wide.
std::optional<std::array<PatchPart, 4>> cheaperChildren(const ThinPatch& thin);

/// Calls thin(ThinPatch, level) or whole(patch, levels, level) for the parts that together are what
/// becomes of a regular vertex of `level`: for itself, or for descendants of it.
template <class Thin, class Whole>
void forEachPatchPart(const PatchPart& part, int level, Thin&& thin, Whole&& whole) {
  if (!part.thin) return whole(part.patch, part.levels, level);
  const auto children = cheaperChildren(*part.thin);
  if (!children) return thin(*part.thin, level);
  for (const PatchPart& child : *children) forEachPatchPart(child, level + 1, thin, whole);
}

}  // namespace vox
