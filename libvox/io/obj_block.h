#pragma once

#include "libvox/io/file_colors.h"
#include "libvox/io/mesh_formats.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vox {

/// A line that names something for the faces that follow it.
struct FaceStatement {
  enum Kind { kObject, kGroup, kMaterial, kSmoothing };
  Kind kind;
  Index face;                   ///< number of the next one
  std::string_view name;        ///< not of kSmoothing
  std::uint32_t smoothing = 0;  ///< group, only of kSmoothing
};

/// What a block of lines holds. Faces, lines and vertex colours are numbered from the start of the
/// block. Relative indices count from there, too, modulo 2^32: those that reach before it lack the
/// number of elements of the blocks before.
struct ObjBlock {
  PolygonMesh mesh;                    ///< points and faces
  std::vector<Vec2f> texcoords;        ///< of its vt lines
  std::vector<Index> cornerTexcoords;  ///< per corner so far, or fewer: the others have none
  std::vector<Index> relativeCorners;  ///< corners whose point is relative
  std::vector<Index> relativeCornerTexcoords;  ///< corners whose texture coordinate is relative
  std::int64_t lowestPoint = 0;                ///< the least of the relative ones
  std::int64_t lowestTexcoord = 0;
  std::int64_t highestPoint = -1;  ///< of the others, from 0
  std::int64_t highestTexcoord = -1;
  std::vector<FaceStatement> statements;
  FileColors colors;
  FileColors commentColors;
  Index commentColorCount = 0;
  ReadLog log;
  std::size_t lineCount = 0;
  std::uint64_t gluedComments = 0;
  std::size_t lineOfGluedComment = 0;
  std::uint64_t polylines = 0;
  bool isSettled = true;  ///< its log does not depend on the blocks before
};

/// Where a block of lines stands in its text.
enum class ObjPlace { kStart, kLater, kWhole };

/// Reads the lines of a block. Only the whole text can tell what is wrong with it: a block of
/// another place refuses errors without saying where, and accepts indices that may lead nowhere.
/// @throws InputError  "FILE:LINE: ..."; the line is right only for the whole
ObjBlock readObjBlock(std::string_view lines, const std::string& fileName, ObjPlace place);

}  // namespace vox
