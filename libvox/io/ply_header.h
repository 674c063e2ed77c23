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

/// What full brightness is in a colour of this type: the largest integer, or 1.
double brightest(PlyType type);

/// What a property means to us.
enum class PlyRole { kIgnored, kX, kY, kZ, kRed, kGreen, kBlue, kFace, kStrips };

struct PlyProperty {
  std::string name;
  PlyType type;  ///< of the value, or of each item of a list
  bool isList = false;
  PlyType countType = PlyType::kUint8;
  PlyRole role = PlyRole::kIgnored;
};

struct PlyElement {
  std::string name;  ///< printable
  std::uint64_t count = 0;
  bool isVertex = false;
  bool isFace = false;
  bool hasColor = false;  ///< red, green and blue
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  std::optional<std::endian> binaryOrder;  ///< none: text
  std::vector<PlyElement> elements;
  std::uint64_t vertexCount = 0;
};

/// Reads a header up to and including the line end_header, checks that it describes positions and
/// faces, and leaves the scanner at the start of the body. Counts are not checked against the body.
PlyHeader parsePlyHeader(TextScanner& scan);

}  // namespace vox
