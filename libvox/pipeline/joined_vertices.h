#pragma once

#include "libvox/core/types.h"
#include "libvox/foot/star_fit.h"
#include "libvox/grid/transform.h"
#include "libvox/mesh/limit_piece.h"
#include "libvox/subdivide/level.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vox {

/// The vertices of a mesh around which the limit surface is one small part: a piece within four
/// quads, nearly a height within triangles (foot/star_fit.h).
class JoinedVertices {
 public:
  /// @param base  level 0, as for LimitWalk; it must stay valid
  explicit JoinedVertices(const SubdivisionLevel& base);

  /// Sets `corners` to those at the vertex of a corner, counter-clockwise, if this is the lowest of
  /// them and the vertex may be joined: all faces there have as many corners, three or four, and
  /// the surface does not end near it.
  bool setCorners(Index corner, std::vector<Index>& corners) const;

  /// Of the control points of the faces at a vertex.
  /// @param corners  from setCorners
  Box boxAround(std::span<const Index> corners) const;

  /// The piece of a vertex within four quads, in place of those of its corners, if it is small. Its
  /// square is that of the first corner, without a place.
  std::optional<LimitPiece> pieceAt(std::span<const Index> corners) const;
  /// The height around a vertex within triangles, if it is small and precise enough.
  /// @param tolerance  voxels, as for fitStar
  std::optional<HeightPatch> heightAt(std::span<const Index> corners, double tolerance) const;

 private:
  const Vec3d& pointOf(Index corner) const {
    return base_.mesh.points[base_.mesh.faceVertices[corner]];
  }
  Index sizeAt(Index corner) const {
    return base_.mesh.faceSize(base_.adjacency.cornerFace[corner]);
  }

  const SubdivisionLevel& base_;
  std::vector<std::uint8_t> isBoundary_;  // by vertex; empty: the surface does not end near any
};

}  // namespace vox
