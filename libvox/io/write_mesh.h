#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <filesystem>
#include <ostream>

namespace vox {

enum class MeshFormat { kObj, kPly, kOff };

/// Format for the extension of a file name: .obj, .ply or .off (case does not matter). For .glb see
/// write_glb.h.
/// @throws UsageError  another extension
MeshFormat meshFormatFor(const std::filesystem::path& file);

/// Writes the points and faces of a mesh, and their colours as sRGB: those of points behind the
/// coordinates (OBJ, COFF: 0 to 1; PLY: uchar), those of faces in OFF and PLY. OBJ has no colours
/// of faces: they are left out. Text formats have 17 significant digits, PLY has binary
/// little-endian doubles, or floats if all coordinates are floats, so that reading the file gives
/// the same bits. Equal meshes give equal bytes.
/// @throws IoError  the stream fails
void writeMesh(std::ostream& out, const PolygonMesh& mesh, MeshFormat format);

}  // namespace vox
