#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <string>
#include <string_view>

namespace vox {

// One parser per format, for read_mesh.cpp. Each gets the content of a file, and its name for
// messages. All parsers have in common:
//   - they throw InputError: "FILE:LINE: ..." for text; "FILE: ..." with the element for binary;
//   - memory is proportional to the content: counts in the file are not trusted;
//   - time is linear in the content;
//   - elements in messages are numbered from 0, as in PLY, OFF and OM files.
// Parsers of binary formats leave some checks to readMesh (index out of range, nan), if they could
// not give a better message.

PolygonMesh parseObj(std::string_view text, const std::string& fileName);
PolygonMesh parsePly(std::string_view data, const std::string& fileName);
PolygonMesh parseOff(std::string_view text, const std::string& fileName);
PolygonMesh parseStl(std::string_view data, const std::string& fileName);
PolygonMesh parseOm(std::string_view data, const std::string& fileName);

}  // namespace vox
