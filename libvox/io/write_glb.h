#pragma once

#include "libvox/mesh/shaded_mesh.h"

#include <cstdint>
#include <ostream>

namespace vox {

/// Bytes of the .glb file of a scene.
std::uint64_t glbBytes(const ShadedScene& scene);

/// Writes a scene as binary glTF 2.0: a node with a mesh for each object that has parts, and a set
/// of triangles for each part. All numbers are 32 bits wide. Images are embedded. Equal scenes give
/// equal bytes.
/// @throws LimitError  the file would have 4 GiB or more, which the format cannot hold
/// @throws IoError     the stream fails
/// Source: Khronos Group, "glTF 2.0 Specification", 2021.
void writeGlb(std::ostream& out, const ShadedScene& scene);

}  // namespace vox
