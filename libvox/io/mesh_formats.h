#pragma once

#include "libvox/io/read_report.h"
#include "libvox/mesh/polygon_mesh.h"

#include <cstddef>
#include <string_view>
#include <vector>

namespace vox {

/// What a parser tells besides the mesh.
struct ReadLog {
  struct PointLine {
    Index point;
    std::size_t line;
  };
  ReadReport report;                   ///< has the name of the file
  std::vector<PointLine> undefined{};  ///< lines of the points that are not finite; text only
};

// One parser per format, for read_mesh.cpp. Each gets the content of a file, and its name for
// messages. All parsers have in common:
//   - they throw InputError: "FILE:LINE: ..." for text; "FILE: ..." with the element for binary;
//   - memory is proportional to the content: counts in the file are not trusted;
//   - time is linear in the content;
//   - elements in messages are numbered from 0, as in PLY, OFF and OM files.
// Points may be NaN or infinite: readMesh checks whether a face uses them. Parsers of binary
// formats leave some checks to readMesh (index out of range), if they could not give a better
// message.

PolygonMesh parseObj(std::string_view text, ReadLog& log);
PolygonMesh parsePly(std::string_view data, ReadLog& log);
PolygonMesh parseOff(std::string_view text, ReadLog& log);
PolygonMesh parseStl(std::string_view data, ReadLog& log);
PolygonMesh parseOm(std::string_view data, ReadLog& log);
PolygonMesh parseGltf(std::string_view data, ReadLog& log);  ///< reads the files of its buffers

// Large files are read in blocks, in parallel. The result is the same for every size of the blocks,
// which tests choose; it is at least 1.

PolygonMesh parseObjInBlocks(std::string_view text, std::size_t bytesPerBlock, ReadLog& log);
PolygonMesh parsePlyInBlocks(std::string_view data, std::size_t bytesPerBlock, ReadLog& log);
PolygonMesh parseStlInBlocks(std::string_view data, std::uint64_t facetsPerBlock, ReadLog& log);

}  // namespace vox
