#pragma once

#include "libvox/io/text_scanner.h"

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vox {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// Size in bytes.
std::size_t sizeOf(PlyType type);

/// The largest integer of a type; 0 of floats.
double largestOf(PlyType type);

/// Calls body with a zero of a type, and returns its result.
template <typename Body>
auto withType(PlyType type, Body&& body) {
  switch (type) {
    case PlyType::kInt8:
      return body(std::int8_t{});
    case PlyType::kUint8:
      return body(std::uint8_t{});
    case PlyType::kInt16:
      return body(std::int16_t{});
    case PlyType::kUint16:
      return body(std::uint16_t{});
    case PlyType::kInt32:
      return body(std::int32_t{});
    case PlyType::kUint32:
      return body(std::uint32_t{});
    case PlyType::kFloat32:
      return body(float{});
    case PlyType::kFloat64:
      break;
  }
  return body(double{});
}

/// Meaning of a property for the reader.
enum class PlyRole {
  kIgnored,
  kX,
  kY,
  kZ,
  kRed,
  kGreen,
  kBlue,
  kFace,
  kStrips,
  kTexcoords,
  kTexnumber,
  kU,
  kV
};

struct PlyProperty {
  std::string name;
  PlyType type;  ///< of the value, or of each item of a list
  bool isList = false;
  PlyType countType = PlyType::kUint8;
  PlyRole role = PlyRole::kIgnored;
  int nameRank = 0;  ///< of a colour or texture coordinate; 0: the usual name
};

struct PlyElement {
  std::string name;  ///< printable characters only
  std::uint64_t count = 0;
  bool isVertex = false;
  bool isFace = false;
  bool hasColor = false;      ///< has red, green and blue
  bool hasTexcoord = false;   ///< of vertices: has u and v
  std::size_t colorLine = 0;  ///< of the header, if their names or types are unusual
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  std::optional<std::endian> binaryOrder;  ///< of a binary body; nothing: text
  std::vector<PlyElement> elements;
  std::uint64_t vertexCount = 0;
  std::vector<std::string> textureFiles;  ///< as comments name them: "comment TextureFile a.png"
};

/// Reads a header up to and including the line end_header, and checks that it describes positions
/// and faces. The scanner then stands at the start of the body. Counts are not checked against the
/// body.
/// @throws InputError  the header is malformed
PlyHeader parsePlyHeader(TextScanner& scan);

}  // namespace vox
