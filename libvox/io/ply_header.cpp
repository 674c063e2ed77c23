// The header of a PLY file: elements, properties, format.
// Source: G. Turk, The PLY polygon file format, 1994.

#include "libvox/io/ply_header.h"

#include "libvox/core/types.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace vox {

namespace {

struct TypeName {
  std::string_view name;
  PlyType type;
};

constexpr std::array<TypeName, 16> kTypeNames = {{
    {"char", PlyType::kInt8},
    {"int8", PlyType::kInt8},
    {"uchar", PlyType::kUint8},
    {"uint8", PlyType::kUint8},
    {"short", PlyType::kInt16},
    {"int16", PlyType::kInt16},
    {"ushort", PlyType::kUint16},
    {"uint16", PlyType::kUint16},
    {"int", PlyType::kInt32},
    {"int32", PlyType::kInt32},
    {"uint", PlyType::kUint32},
    {"uint32", PlyType::kUint32},
    {"float", PlyType::kFloat32},
    {"float32", PlyType::kFloat32},
    {"double", PlyType::kFloat64},
    {"float64", PlyType::kFloat64},
}};

/// Names of a role. Of several in one element the lowest rank counts.
struct RoleName {
  std::string_view name;
  PlyRole role;
  int rank;
};

constexpr std::array<RoleName, 12> kColorNames = {{
    {"red", PlyRole::kRed, 0},
    {"green", PlyRole::kGreen, 0},
    {"blue", PlyRole::kBlue, 0},
    {"r", PlyRole::kRed, 1},
    {"g", PlyRole::kGreen, 1},
    {"b", PlyRole::kBlue, 1},
    {"diffuse_red", PlyRole::kRed, 2},
    {"diffuse_green", PlyRole::kGreen, 2},
    {"diffuse_blue", PlyRole::kBlue, 2},
    {"diffuse_r", PlyRole::kRed, 3},
    {"diffuse_g", PlyRole::kGreen, 3},
    {"diffuse_b", PlyRole::kBlue, 3},
}};

constexpr std::array<RoleName, 6> kTexcoordNames = {{
    {"s", PlyRole::kU, 0},
    {"t", PlyRole::kV, 0},
    {"u", PlyRole::kU, 1},
    {"v", PlyRole::kV, 1},
    {"texture_u", PlyRole::kU, 2},
    {"texture_v", PlyRole::kV, 2},
}};

std::string lowerCase(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

class HeaderParser {
 public:
  explicit HeaderParser(TextScanner& scan) : scan_(scan) {}

  PlyHeader parse() {
    if (scan_.token() != "ply") scan_.fail("no PLY file: the first line must be \"ply\"");
    endLine();
    while (readLine()) {
    }
    checkIsMesh();
    scan_.nextLine();
    return std::move(header_);
  }

 private:
  bool readLine();
  void readFormat();
  void readElement();
  void readProperty();
  void readComment();
  void setRole(PlyProperty& property) const;
  void addProperty(PlyProperty property);
  void noteRoles(PlyElement& element) const;
  PlyType typeNamed(std::string_view name) const;
  std::string_view word(const char* what);
  void endLine();
  void checkIsMesh() const;

  TextScanner& scan_;
  PlyHeader header_;
  bool hasFormat_ = false;
  bool hasVertices_ = false;
};

// Reads one line; returns false for the line that ends the header.
bool HeaderParser::readLine() {
  const std::string_view keyword = scan_.token();
  if (keyword == "end_header") return false;
  if (keyword == "format") {
    readFormat();
  } else if (keyword == "element") {
    readElement();
  } else if (keyword == "property") {
    readProperty();
  } else if (keyword == "comment" || keyword == "obj_info") {
    readComment();
    return true;
  } else if (!keyword.empty()) {
    scan_.fail("unknown header line " + quote(keyword));
  }
  endLine();
  return true;
}

void HeaderParser::readComment() {
  constexpr std::string_view kBlanks = " \t\r";
  if (scan_.token() == "TextureFile") {
    std::string_view name = scan_.restOfLine();
    name.remove_prefix(std::min(name.find_first_not_of(kBlanks), name.size()));
    name = name.substr(0, name.find_last_not_of(kBlanks) + 1);
    if (!name.empty()) header_.textureFiles.emplace_back(name);
  }
  if (!scan_.nextLine()) scan_.fail("truncated: ends before end_header");
}

void HeaderParser::readFormat() {
  const std::string_view format = word("a format");
  if (format == "binary_little_endian") {
    header_.binaryOrder = std::endian::little;
  } else if (format == "binary_big_endian") {
    header_.binaryOrder = std::endian::big;
  } else if (format != "ascii") {
    scan_.fail("unknown format " + quote(format) +
               "; expected ascii, binary_little_endian or binary_big_endian");
  }
  if (const auto version = word("a version"); version != "1.0")
    scan_.fail("unknown format version " + quote(version) + "; expected 1.0");
  if (std::exchange(hasFormat_, true)) scan_.fail("second format line");
}

void HeaderParser::readElement() {
  PlyElement element;
  const std::string_view name = word("an element name");
  const std::string shown = quote(name);
  element.name = shown.substr(1, shown.size() - 2);
  element.isVertex = name == "vertex";
  element.isFace = name == "face";

  const std::int64_t count = scan_.integer(word("an element count"));
  if (count < 0 || count >= std::int64_t{kNone})
    scan_.fail("element " + element.name + " has count " + std::to_string(count) +
               "; it must be 0 to 2^32 - 2");
  element.count = static_cast<std::uint64_t>(count);
  if (element.isVertex && std::exchange(hasVertices_, true)) scan_.fail("second element vertex");
  if (element.isVertex) header_.vertexCount = element.count;
  header_.elements.push_back(std::move(element));
}

void HeaderParser::readProperty() {
  if (header_.elements.empty()) scan_.fail("property before the first element");
  PlyProperty property;
  if (const std::string_view type = word("a property type"); type == "list") {
    property.isList = true;
    property.countType = typeNamed(word("a type"));
    property.type = typeNamed(word("a type"));
  } else {
    property.type = typeNamed(type);
  }
  property.name = word("a property name");
  setRole(property);
  addProperty(std::move(property));
  noteRoles(header_.elements.back());
}

// Of several properties of one role the one with the most usual name keeps it.
void HeaderParser::addProperty(PlyProperty property) {
  auto& properties = header_.elements.back().properties;
  for (PlyProperty& other : properties) {
    if (property.role == PlyRole::kIgnored || other.role != property.role) continue;
    if (other.nameRank == property.nameRank) scan_.fail("second property " + quote(property.name));
    (other.nameRank < property.nameRank ? property : other).role = PlyRole::kIgnored;
  }
  properties.push_back(std::move(property));
}

void HeaderParser::noteRoles(PlyElement& element) const {
  int channels = 0;
  bool isUsual = true;
  for (const PlyProperty& property : element.properties) {
    if (property.role < PlyRole::kRed || property.role > PlyRole::kBlue) continue;
    ++channels;
    const double largest = largestOf(property.type);
    isUsual = isUsual && property.nameRank == 0 &&
              (largest == 0 || largest == largestOf(PlyType::kUint8));
  }
  const auto has = [&](PlyRole role) {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [&](const PlyProperty& property) { return property.role == role; });
  };
  element.hasTexcoord = has(PlyRole::kU) && has(PlyRole::kV);
  element.hasColor = channels == 3;
  if (element.hasColor && !isUsual && element.colorLine == 0) element.colorLine = scan_.line();
}

void HeaderParser::setRole(PlyProperty& property) const {
  const PlyElement& element = header_.elements.back();
  const std::string& name = property.name;
  if (property.isList) {
    if (element.isFace && name == "texcoord") property.role = PlyRole::kTexcoords;
    if (name != "vertex_indices" && name != "vertex_index") return;
    if (element.name == "face") property.role = PlyRole::kFace;
    if (element.name == "tristrips") property.role = PlyRole::kStrips;
    return;
  }
  if (!element.isVertex && !element.isFace) return;
  for (const RoleName& color : kColorNames)
    if (color.name == lowerCase(name)) {
      property.role = color.role;
      property.nameRank = color.rank;
    }
  if (element.isFace && name == "texnumber") property.role = PlyRole::kTexnumber;
  if (!element.isVertex) return;
  for (const RoleName& texcoord : kTexcoordNames)
    if (texcoord.name == name) {
      property.role = texcoord.role;
      property.nameRank = texcoord.rank;
    }
  if (name == "x") property.role = PlyRole::kX;
  if (name == "y") property.role = PlyRole::kY;
  if (name == "z") property.role = PlyRole::kZ;
}

PlyType HeaderParser::typeNamed(std::string_view name) const {
  const auto known = std::find_if(kTypeNames.begin(), kTypeNames.end(),
                                  [&](const TypeName& type) { return type.name == name; });
  if (known == kTypeNames.end())
    scan_.fail("unknown type " + quote(name) + "; expected char, uchar, ..., float or double");
  return known->type;
}

std::string_view HeaderParser::word(const char* what) {
  const std::string_view token = scan_.token();
  if (token.empty()) scan_.fail(std::string("the line ends where ") + what + " is expected");
  return token;
}

void HeaderParser::endLine() {
  if (const auto extra = scan_.token(); !extra.empty())
    scan_.fail("unexpected " + quote(extra) + " at the end of a header line");
  if (!scan_.nextLine()) scan_.fail("truncated: ends before end_header");
}

void HeaderParser::checkIsMesh() const {
  if (!hasFormat_) scan_.fail("the header has no format line");
  int axes = 0;
  bool hasFaces = false;
  for (const PlyElement& element : header_.elements)
    for (const PlyProperty& property : element.properties) {
      const bool isFaces = property.role == PlyRole::kFace || property.role == PlyRole::kStrips;
      hasFaces |= isFaces;
      axes += property.role >= PlyRole::kX && property.role <= PlyRole::kZ;
    }
  if (axes != 3) scan_.fail("the header has no element vertex with properties x, y and z");
  if (!hasFaces)
    scan_.fail(
        "no faces: the header has no element face with a list property vertex_indices; "
        "a cloud of points has no surface");
}

}  // namespace

std::size_t sizeOf(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      return 8;
  }
  return 1;
}

double largestOf(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
      return std::numeric_limits<std::int8_t>::max();
    case PlyType::kUint8:
      return std::numeric_limits<std::uint8_t>::max();
    case PlyType::kInt16:
      return std::numeric_limits<std::int16_t>::max();
    case PlyType::kUint16:
      return std::numeric_limits<std::uint16_t>::max();
    case PlyType::kInt32:
      return std::numeric_limits<std::int32_t>::max();
    case PlyType::kUint32:
      return std::numeric_limits<std::uint32_t>::max();
    case PlyType::kFloat32:
    case PlyType::kFloat64:
      return 0;
  }
  return 0;
}

PlyHeader parsePlyHeader(TextScanner& scan) {
  return HeaderParser(scan).parse();
}

}  // namespace vox
