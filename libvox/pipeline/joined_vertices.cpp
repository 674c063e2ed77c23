// One piece or height in place of the pieces of all corners at a vertex.

#include "libvox/pipeline/joined_vertices.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace vox {
namespace {

/// Larger pieces among quads turn more: joining them would save less than it costs.
constexpr double kLongestJoined = 1.5;  // voxels, a side of a joined piece

constexpr double kLongestHeight = 6;  // voxels, a side of the rectangle

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

JoinedVertices::JoinedVertices(const SubdivisionLevel& base) : base_(base) {
  // A surface that is not extended ends next to boundary vertices.
  if (base.boundary != BoundaryStage::kExtend) isBoundary_ = boundaryVertices(base);
}

bool JoinedVertices::setCorners(Index corner, std::vector<Index>& corners) const {
  corners.clear();
  const Index size = sizeAt(corner);
  if (size > 4) return false;
  Index at = corner;
  do {
    if (at == kNone || at < corner || sizeAt(at) != size || corners.size() == kMostOfStar)
      return false;
    corners.push_back(at);
    at = nextAroundVertex(base_.mesh, base_.adjacency, at);
  } while (at != corner);
  return isBoundary_.empty() || std::none_of(corners.begin(), corners.end(), [&](Index c) {
           return isBoundary_[base_.mesh
                                  .faceVertices[nextCorner(base_.mesh, base_.adjacency, c)]] != 0;
         });
}

Box JoinedVertices::boxAround(std::span<const Index> corners) const {
  Box box;
  for (const Index c : corners) {
    const Index f = base_.adjacency.cornerFace[c];
    for (const Index v : base_.mesh.face(f)) box.add(base_.mesh.points[v]);
  }
  return box;
}

std::optional<LimitPiece> JoinedVertices::pieceAt(std::span<const Index> corners) const {
  if (sizeAt(corners[0]) != 4 || corners.size() != 4) return {};
  const Vec3d& centre = pointOf(corners[0]);
  std::array<Vec3d, 4> next, opposite;
  for (std::size_t i = 0; i < 4; ++i) {
    const Index n = nextCorner(base_.mesh, base_.adjacency, corners[i]);
    next[i] = pointOf(n);
    opposite[i] = pointOf(nextCorner(base_.mesh, base_.adjacency, n));
    if (!((next[i] - centre).squaredNorm() <= kLongestJoined * kLongestJoined)) return {};
  }
  return LimitPiece{{{{opposite[2], next[2], opposite[1]},
                      {next[3], centre, next[1]},
                      {opposite[3], next[0], opposite[0]}}},
                    0,
                    {corners[0]}};
}

std::optional<HeightPatch> JoinedVertices::heightAt(std::span<const Index> corners,
                                                    double tolerance) const {
  const std::size_t count = corners.size();
  if (sizeAt(corners[0]) != 3 || count < kLeastOfStar) return {};
  std::array<Vec3d, kMostOfStar> ring, outer;
  for (std::size_t k = 0; k < count; ++k) {
    const Index next = nextCorner(base_.mesh, base_.adjacency, corners[k]);
    const Index beyond = base_.adjacency.twin[next];
    if (beyond == kNone || sizeAt(beyond) != 3) return {};
    ring[k] = pointOf(next);
    outer[k] = pointOf(previousCorner(base_.mesh, base_.adjacency, beyond));
  }
  return fitStar({pointOf(corners[0]), {ring.data(), count}, {outer.data(), count}}, kLongestHeight,
                 tolerance);
}

}  // namespace vox
