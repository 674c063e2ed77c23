#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <filesystem>
#include <string_view>

namespace vox {

/// Largest absolute coordinate accepted from a file: beyond it a double resolves less than 1/8.
inline constexpr double kMaxCoordinate = 1e15;

/// Reads a polygon mesh; the format follows from the extension (case does not matter):
/// .obj .ply (ascii, binary little and big endian) .off (OFF, COFF, NOFF, STOFF) .stl (ascii,
/// binary; equal positions welded) .om (OpenMesh).
///
/// Polygons arrive untouched: any size, repeated corners, non-manifold. Positions are doubles.
/// Guaranteed: at least one face; each face has at least 3 corners; every index is in range; every
/// coordinate is finite and at most kMaxCoordinate in size.
///
/// @throws InputError  the file is missing, a directory, unreadable, of unknown extension, or its
///   text is malformed. The message starts with "FILE:LINE: " (text) or "FILE: " (binary).
PolygonMesh readMesh(const std::filesystem::path& file);

/// The same from the content of a file; the name gives the format and stands in messages.
PolygonMesh parseMesh(const std::filesystem::path& file, std::string_view content);

/// Checks the extension alone.
/// @throws InputError  it is none of a mesh
void requireMeshExtension(const std::filesystem::path& file);

}  // namespace vox
