#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <filesystem>
#include <ostream>

namespace vox {

enum class MeshFormat { kObj, kPly, kOff };

/// Format for the extension of a file name: .obj, .ply or .off (case does not matter).
/// @throws UsageError  another extension
MeshFormat meshFormatFor(const std::filesystem::path& file);

/// Writes the points and faces of a mesh. Text formats have 17 significant digits, PLY has binary
/// little-endian doubles, so that reading the file gives the same bits. Equal meshes give equal
/// bytes.
/// @throws IoError  the stream fails
void writeMesh(std::ostream& out, const PolygonMesh& mesh, MeshFormat format);

}  // namespace vox
