// Pieces of level 0 in place of four of level 1.

#include "libvox/pipeline/whole_vertices.h"

#include "libvox/core/parallel.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

namespace vox {
namespace {

/// Larger pieces turn more: joining them would save less than it costs.
constexpr double kLongestJoined = 1.5;  // voxels, a side of a joined piece

/// The four corners at a vertex within four quads, counter-clockwise.
std::optional<std::array<Index, 4>> quadsAround(const SubdivisionLevel& base, Index corner) {
  std::array<Index, 4> corners;
  Index at = corner;
  for (Index& c : corners) {
    if (at == kNone || base.mesh.faceSize(base.adjacency.cornerFace[at]) != 4) return {};
    c = at;
    at = nextAroundVertex(base.mesh, base.adjacency, at);
  }
  if (at != corner) return {};
  return corners;
}

/// Whether the piece of the vertex of a corner within four quads has short sides.
bool isShort(const SubdivisionLevel& base, const std::array<Index, 4>& corners) {
  const auto pointAt = [&](Index c) -> const Vec3d& {
    return base.mesh.points[base.mesh.faceVertices[c]];
  };
  return std::all_of(corners.begin(), corners.end(), [&](Index c) {
    const Vec3d& next = pointAt(nextCorner(base.mesh, base.adjacency, c));
    return (next - pointAt(c)).squaredNorm() <= kLongestJoined * kLongestJoined;
  });
}

/// Whether each vertex lies at the end of a boundary edge.
std::vector<std::uint8_t> boundaryVertices(const SubdivisionLevel& base) {
  std::vector<std::uint8_t> isBoundary(base.mesh.points.size(), 0);
  for (Index c = 0; c < base.mesh.cornerCount(); ++c)
    if (base.adjacency.twin[c] == kNone)
      for (const Index end : {c, nextCorner(base.mesh, base.adjacency, c)})
        isBoundary[base.mesh.faceVertices[end]] = 1;
  return isBoundary;
}

}  // namespace

WholeVertices::WholeVertices(const SubdivisionLevel& base)
    : base_(base), isWhole_(base.mesh.cornerCount(), 0) {
  // A surface that is not extended ends next to boundary vertices.
  std::vector<std::uint8_t> isBoundary;
  if (base.boundary != BoundaryStage::kExtend) isBoundary = boundaryVertices(base);
  const auto isNearBoundary = [&](Index corner) {
    return !isBoundary.empty() &&
           isBoundary[base.mesh.faceVertices[nextCorner(base.mesh, base.adjacency, corner)]] != 0;
  };
  constexpr std::size_t kCornersPerTask = 4096;
  parallelForRanges(isWhole_.size(), kCornersPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const auto corners = quadsAround(base, static_cast<Index>(c));
      isWhole_[c] = corners && isShort(base, *corners) &&
                            std::none_of(corners->begin(), corners->end(), isNearBoundary)
                        ? 1
                        : 0;
    }
  });
}

Index WholeVertices::firstCorner(Index corner) const {
  const auto corners = *quadsAround(base_, corner);
  return *std::min_element(corners.begin(), corners.end());
}

LimitPiece WholeVertices::pieceAt(Index corner) const {
  const auto pointOf = [&](Index c) -> const Vec3d& {
    return base_.mesh.points[base_.mesh.faceVertices[c]];
  };
  const std::array<Index, 4> corners = *quadsAround(base_, corner);
  std::array<Vec3d, 4> next, opposite;
  for (std::size_t i = 0; i < 4; ++i) {
    const Index n = nextCorner(base_.mesh, base_.adjacency, corners[i]);
    next[i] = pointOf(n);
    opposite[i] = pointOf(nextCorner(base_.mesh, base_.adjacency, n));
  }
  return {{{{opposite[2], next[2], opposite[1]},
            {next[3], pointOf(corner), next[1]},
            {opposite[3], next[0], opposite[0]}}},
          0,
          {corner, -1, -1, 2, 2}};
}

void JoinedPieces::piece(const LimitPiece& piece) {
  const Index corner = piece.square.corner;
  if (!whole_.contains(corner)) return next_.piece(piece);
  if (whole_.firstCorner(corner) == corner) next_.piece(whole_.pieceAt(corner));
}

}  // namespace vox
