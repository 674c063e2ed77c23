#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <filesystem>
#include <ostream>

namespace vox {

enum class MeshFormat { kObj, kPly, kOff };

/// Format that belongs to the extension of a file name: .obj, .ply or .off (case does not matter).
/// @throws UsageError  another extension
MeshFormat meshFormatFor(const std::filesystem::path& file);

/// Writes a mesh. Text formats print 17 significant digits, PLY stores binary little-endian
/// doubles, so reading back gives the same bits. Equal meshes give equal bytes.
/// @throws IoError  the stream fails
void writeMesh(std::ostream& out, const PolygonMesh& mesh, MeshFormat format);

}  // namespace vox
