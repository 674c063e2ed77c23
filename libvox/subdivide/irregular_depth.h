#pragma once

#include "libvox/subdivide/criterion.h"
#include "libvox/subdivide/level_one_vertex.h"

namespace vox {

/// Least depth at which all descendants of an irregular level-1 vertex meet a criterion; at most
/// `most`. Around an extraordinary face, these are the regular vertices of each level, and the
/// corner of the face at the last level.
/// @throws LimitError  as Descent
int irregularDepth(const Criterion& criterion, const LevelOneVertex& vertex,
                   const VertexFaces& faces, int most);

}  // namespace vox
