#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <string>
#include <string_view>

namespace vox {

// One parser per format, for read_mesh.cpp. Each gets the whole file in memory and the file's name
// for messages. Common promises:
//   - throws InputError: "FILE:LINE: ..." for text, "FILE: ..." naming the element for binary;
//   - memory stays proportional to the text: no count is believed before the data is there;
//   - linear time;
//   - elements in messages are numbered from 0, as PLY, OFF and OM number them.
// What a binary format cannot tell better (index out of range, nan) is left to readMesh.

PolygonMesh parseObj(std::string_view text, const std::string& fileName);
PolygonMesh parsePly(std::string_view data, const std::string& fileName);
PolygonMesh parseOff(std::string_view text, const std::string& fileName);
PolygonMesh parseStl(std::string_view data, const std::string& fileName);
PolygonMesh parseOm(std::string_view data, const std::string& fileName);

}  // namespace vox
