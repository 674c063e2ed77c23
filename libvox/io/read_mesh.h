#pragma once

#include "libvox/io/read_report.h"
#include "libvox/mesh/polygon_mesh.h"

#include <filesystem>
#include <string_view>

namespace vox {

/// Largest absolute coordinate accepted from a file. Above it, doubles are more than 1/8 apart.
inline constexpr double kMaxCoordinate = 1e15;

/// Reads a polygon mesh; the format follows from the extension (case does not matter):
/// .obj .ply (ascii, binary little and big endian) .off (OFF, COFF, NOFF, STOFF) .stl (ascii,
/// binary; equal positions welded) .om (OpenMesh) .gltf .glb (glTF 2.0).
///
/// Polygons are not changed: they may have any size and repeated corners, and need not form a
/// manifold. Positions are doubles. Faces of fewer than 3 corners are dropped; for this and all
/// else that is read though the format does not have it, see Oddity. A vertex at NaN or infinity is
/// an error only if a face uses it. The result has at least one face; each face has at least 3
/// corners; every index is in range; every coordinate is finite and at most kMaxCoordinate in size.
///
/// The materials of an OBJ file are read from the files that it names (readMaterials). Images are
/// not read. The buffers of a glTF file are.
///
/// @throws InputError  the file is missing, a directory, unreadable, of unknown extension, or its
///   text is malformed. The message starts with "FILE:LINE: " (text) or "FILE: " (binary).
/// @param report  gets the oddities of the file
PolygonMesh readMesh(const std::filesystem::path& file, ReadReport& report);
PolygonMesh readMesh(const std::filesystem::path& file);

/// Reads a polygon mesh from the content of a file, without its material files, but with the
/// buffers of glTF.
/// @param file  gives the format by its extension, and is named in messages
/// @throws InputError  as readMesh
PolygonMesh parseMesh(const std::filesystem::path& file, std::string_view content,
                      ReadReport& report);
PolygonMesh parseMesh(const std::filesystem::path& file, std::string_view content);

/// Checks the extension of a file name.
/// @throws InputError  no mesh format has it
void requireMeshExtension(const std::filesystem::path& file);

}  // namespace vox
