#pragma once

#include "libvox/subdivide/criterion.h"
#include "libvox/subdivide/vertex_array.h"

namespace vox {

/// Levels at which all that becomes of an irregular vertex keeps a criterion; at most `most`.
/// Around an extraordinary face: the regular vertices of its levels, and where the levels end its
/// own surroundings.
/// @throws LimitError  as ExtraordinaryLevels
int irregularDepth(const Criterion& criterion, const LevelOneVertex& vertex,
                   const VertexFaces& faces, int most);

}  // namespace vox
