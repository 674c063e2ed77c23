#pragma once

#include "libvox/core/types.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vox {

/// Level-1 vertices between four interior faces, of which neither F nor the V-face is a quad, and
/// their surroundings: the words are those of vertex_split.h. Points are stored coordinate by
/// coordinate, a vertex per lane.
struct alignas(64) SplitBatch {
  static constexpr std::size_t kLanes = 32;
  using Lanes = std::array<double, kLanes>;

  enum Point : std::size_t {
    kAt,
    kNext,      // F(i+1)
    kPrevious,  // F(i-1)
    kRight,     // the neighbour in R and the V-face
    kRightFar,  // opposite in R
    kLeft,
    kLeftFar,
    kInF,  // images of level 2 in F: of the vertex, of the next and of the previous corner
    kNextInF,
    kPreviousInF,
    kInVFace,  // the same in the V-face: of the vertex and of its neighbours in R and L
    kRightInVFace,
    kLeftInVFace,
    kDeepInF,      // image of kInF
    kDeepInVFace,  // image of kInVFace
    kPoints,
  };
  std::array<std::array<Lanes, 3>, kPoints> points;
  Lanes sizeOfF, sizeOfVFace;                ///< diameters of the faces of level 2
  Lanes contractionInF, contractionInVFace;  ///< largest C(n) around the child in F, in the V-face

  void set(std::size_t lane, Point point, const Vec3d& position) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      points[point][axis][lane] = position[static_cast<Eigen::Index>(axis)];
  }
};

/// What the vertices of a batch become.
struct SplitVertices {
  static constexpr std::size_t kMostAtOnce = 8;          ///< lanes of a vector
  std::array<Vec3d, 4 * SplitBatch::kLanes + 1> level2;  // and one that the next may replace
  std::array<Vec3d, 16 * SplitBatch::kLanes + 1> level3;
  std::size_t count2, count3;
  std::uint64_t deeper;  ///< bit per lane: it needs more levels, and none of its vertices are given
};

/// Gives the descendants of the first `count` vertices that are fine enough at level 2 or 3, with
/// the bits and by the rules of Descent and LocalSurface. Many lanes at a time, on the best vector
/// unit of the processor.
void splitAll(const SplitBatch& batch, std::size_t count, SplitVertices& vertices);

}  // namespace vox
