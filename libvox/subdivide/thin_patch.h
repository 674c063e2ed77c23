#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/stop.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace vox {

/// A regular vertex whose N x N descendants (N = 2^levels) are much denser than needed: a patch
/// much longer than wide, or one whose rows and columns run nearly the same way, as around a face
/// of thousands of sides. Some whole rows and the two outermost columns are enough. The strips
/// between these rows can be filled with faces as small as vertex conversion needs
/// (patch_strips.h). All outermost vertices are there, so the neighbours of the patch fit to it as
/// to a whole patch (mixed depths, DESIGN section 9).
struct ThinPatch {
  Patch patch;                     ///< turned by quarter turns so that the rows run along v
  int levels;                      ///< N = 2^levels; as many levels as the patch needs, or one more
  std::vector<std::int64_t> rows;  ///< rows to emit: ascending, with 0 and N - 1
  static constexpr std::int64_t kColumns = 2;  ///< columns to emit: the first and the last
  /// Number of vertices to emit.
  std::int64_t vertices() const {
    return (static_cast<std::int64_t>(rows.size()) + kColumns) << levels;
  }
};

/// The thin patch of a regular vertex; nothing if the vertex is not thin or if that saves little.
/// @param patch   with finite points
/// @param levels  patchDepth(patch)
std::optional<ThinPatch> thinPatch(const Patch& patch, int levels);

/// A regular vertex with its depth and, if it is thin, its thin patch.
struct PatchPart {
  explicit PatchPart(const Patch& vertex) : PatchPart(vertex, patchDepth(vertex)) {}
  /// @param depth  patchDepth(vertex)
  PatchPart(const Patch& vertex, int depth)
      : patch(vertex), levels(depth), thin(thinPatch(vertex, depth)) {}
  Patch patch;
  int levels;
  std::optional<ThinPatch> thin;
};

/// The four children of a thin patch, if together they need far fewer vertices; else nothing. This
/// happens if a part of the patch turns back on itself, or is wide.
std::optional<std::array<PatchPart, 4>> cheaperChildren(const ThinPatch& thin);

/// Splits a regular vertex of `level` into parts: the vertex itself or, where it is cheaper, its
/// children, theirs, and so on. Calls thin(ThinPatch, level) for each thin part and
/// whole(patch, levels, level) for each other part, with the level of the part and its depth. The
/// parts together have all descendants of the vertex. Serial.
template <class Thin, class Whole>
void forEachPatchPart(const PatchPart& part, int level, Thin&& thin, Whole&& whole) {
  if (!part.thin) return whole(part.patch, part.levels, level);
  const auto children = cheaperChildren(*part.thin);
  if (!children) return thin(*part.thin, level);
  for (const PatchPart& child : *children) forEachPatchPart(child, level + 1, thin, whole);
}

/// Gives the sink the descendants of a regular vertex of `level`: as a point, as a patch or, for
/// thin parts of it, as some rows and the two outermost columns.
void emitRegular(const PatchPart& part, int level, SurfaceSink& sink);

}  // namespace vox
