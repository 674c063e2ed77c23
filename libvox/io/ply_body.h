#pragma once

#include "libvox/io/file_colors.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/ply_blocks.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vox {

/// What the elements of a PlyBlock hold. Points and faces are numbered from the first of them;
/// indices, elements and lines are those of the file.
struct PlyPart {
  PolygonMesh mesh;
  FileColors pointColors;
  FileColors faceColors;
  std::vector<Vec2f> cornerTexcoords;    ///< of corners so far, or fewer: the others have none
  std::vector<Vec2f> pointTexcoords;     ///< of all points, or empty
  std::vector<std::int64_t> texnumbers;  ///< of faces so far, or fewer: the others have 0
  ReadLog log;
};

/// Reads the elements of a block, of any properties, text or binary.
/// @throws InputError  names the first element or line at fault
PlyPart readPlyBlock(const PlyHeader& header, const PlyBlock& block, const std::string& fileName);

}  // namespace vox
