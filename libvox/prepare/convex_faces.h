#pragma once

#include "libvox/core/types.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace vox {

/// Faces of one kind that were split into convex faces.
struct FaceSplit {
  std::size_t faces = 0;  ///< of the input
  std::size_t parts = 0;  ///< faces that they became
  Index first = kNone;    ///< the first of `faces`
};

/// Faces that were split although nothing is wrong with them.
struct FaceSplitReport {
  FaceSplit keyholes;  ///< faces with holes
  FaceSplit concave;   ///< faces that are not star-shaped (star_shaped.h)
};

/// Summary in one line: "split 1 face with holes into 8, split 2 concave faces into 7"; empty if
/// nothing was split.
std::string summary(const FaceSplitReport& report);

/// Cuts a face into convex faces (convex_parts.h). Each loop that lies in an odd number of the
/// other loops is a hole, whichever way it runs; the others are outlines. Where loops are written
/// as one face, with bridges between them (a keyhole), LoopCutter gives the loops without bridges;
/// loops without area are dropped here.
///
/// @param loops  cycles of vertices; those of one loop are distinct, and equal positions are equal
///               vertices
/// @param parts  replaced by the convex faces, wound like the face. They depend neither on the
///               winding of loops nor on their order and first vertices, except for the winding.
/// @return  false if there are several loops but no holes, if loops cross, or if the one loop is
///   convex, or if l n is larger than 2 10^9; `parts` is then undefined
/// Cost: that of convexParts, and O(l n) for l loops with n corners.
bool convexFaces(std::span<const Vec3d> points, std::span<const std::vector<Index>> loops,
                 std::vector<std::vector<Index>>& parts);

}  // namespace vox
