// The elements of a PLY file, text and binary.
//
// Source: G. Turk, "The PLY Polygon File Format", 1994; tristrips as in the Stanford scanning
// repository: one list of vertices, -1 starts a new strip; texture coordinates as MeshLab writes
// them: two numbers for each corner of a face.

#include "libvox/io/ply_body.h"

#include "libvox/core/error.h"
#include "libvox/io/byte_order.h"
#include "libvox/io/read_mesh.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace vox {

namespace {

const Vec2f kNoCornerTexcoord = Vec2f::Constant(std::numeric_limits<float>::quiet_NaN());

// The element that is being read, for messages.
struct Place {
  const PlyElement* element = nullptr;
  std::uint64_t index = 0;

  std::string name() const { return element->name + " " + std::to_string(index); }
  std::string truncated() const {
    return "truncated: ends within " + name() + " of " + std::to_string(element->count);
  }
};

// Numbers of a text body. An element may run over several lines, but must start on a new one; so a
// missing or additional number does not shift all later elements.
class TextNumbers {
 public:
  TextNumbers(TextScanner& scan, const Place& place) : scan_(scan), place_(place) {}

  double next(PlyType) { return scan_.number(nextToken()); }
  /// May be NaN or infinite.
  double nextCoordinate(PlyType) { return scan_.coordinate(nextToken()); }
  double nextNumberOrNan(PlyType) { return scan_.numberOrNan(nextToken()); }
  void skip(PlyType, std::uint64_t count) {
    for (; count > 0; --count) nextToken();
  }
  void endElement() {
    if (const auto extra = scan_.token(); !extra.empty())
      fail("unexpected " + quote(extra) + " after the last value of " + place_.name());
    scan_.nextLine();
  }
  [[noreturn]] void fail(const std::string& what) const { scan_.fail(what); }
  std::size_t line() const { return scan_.line(); }

 private:
  std::string_view nextToken() {
    const std::string_view token = scan_.tokenOnAnyLine();
    if (token.empty()) fail(place_.truncated());
    return token;
  }

  TextScanner& scan_;
  const Place& place_;
};

// Numbers of a binary body.
class BinaryNumbers {
 public:
  BinaryNumbers(std::string_view data, std::endian order, const std::string& fileName,
                const Place& place)
      : data_(data), order_(order), fileName_(fileName), place_(place) {}

  double next(PlyType type) {
    const char* const at = data_.data();
    skip(type, 1);
    return withType(type, [&](auto zero) {
      return static_cast<double>(loadNumber<decltype(zero)>(at, order_));
    });
  }
  double nextCoordinate(PlyType type) { return next(type); }
  double nextNumberOrNan(PlyType type) { return next(type); }
  void skip(PlyType type, std::uint64_t count) {
    const std::size_t size = sizeOf(type);
    if (count > data_.size() / size) fail(place_.truncated());
    data_.remove_prefix(size * count);
  }
  void endElement() {}
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fileName_ + ": " + what);
  }
  std::size_t line() const { return 0; }

 private:
  std::string_view data_;
  std::endian order_;
  const std::string& fileName_;
  const Place& place_;
};

// Reads elements from a source of numbers.
template <typename Numbers>
class BodyParser {
 public:
  BodyParser(Numbers numbers, const PlyHeader& header, Place& place)
      : numbers_(numbers), header_(header), place_(place) {}

  PlyPart parse(std::uint64_t first, std::uint64_t end) {
    forEachKind(header_, first, end,
                [&](const PlyElement& element, std::uint64_t from, std::uint64_t to) {
                  place_ = {&element, from};
                  prepareColors(element);
                  for (; place_.index < to; ++place_.index) {
                    readElement(element);
                    numbers_.endElement();
                  }
                });
    return std::move(part_);
  }

 private:
  void prepareColors(const PlyElement& element);
  void readElement(const PlyElement& element);
  double readColor(PlyType type);
  std::uint64_t readCount(PlyType type);
  std::int64_t readInteger(PlyType type);
  Index pointOf(std::int64_t index);
  void readFace(const PlyProperty& list);
  void readStrips(const PlyProperty& list);
  void readTexcoords(const PlyProperty& list);
  void setTexcoords();
  Vec2f finiteTexcoord(const Vec2d& texcoord);

  Numbers numbers_;
  const PlyHeader& header_;
  Place& place_;
  PlyPart part_;
  PolygonMesh& mesh_ = part_.mesh;
  ReadLog& log_ = part_.log;
  bool keepsType_ = true;              // colours of the element have one type: their range
  std::vector<double> faceTexcoords_;  // of the face that is being read
};

template <typename Numbers>
void BodyParser<Numbers>::prepareColors(const PlyElement& element) {
  if (!element.hasColor) return;
  std::vector<double> largest;
  for (const PlyProperty& property : element.properties)
    if (property.role >= PlyRole::kRed && property.role <= PlyRole::kBlue)
      largest.push_back(largestOf(property.type));
  keepsType_ = largest[0] == largest[1] && largest[0] == largest[2];
  if (!keepsType_) return;
  if (element.isVertex) part_.pointColors.setIntegers(largest[0]);
  if (element.isFace) part_.faceColors.setIntegers(largest[0]);
}

// A colour value in the range of its type, or from 0 to 1 if the three types differ.
template <typename Numbers>
double BodyParser<Numbers>::readColor(PlyType type) {
  const double value = numbers_.next(type);
  const double largest = largestOf(type);
  if (!keepsType_) return largest > 0 ? value / largest : value;
  constexpr double kTurn = 256;  // a signed byte stands for an unsigned one
  return type == PlyType::kInt8 && value < 0 ? value + kTurn : value;
}

template <typename Numbers>
void BodyParser<Numbers>::readElement(const PlyElement& element) {
  const Index facesBefore = mesh_.faceCount();
  Vec3d point = Vec3d::Zero();
  Vec3d color = Vec3d::Zero();
  Vec2d texcoord = Vec2d::Zero();
  std::optional<std::int64_t> texnumber;
  faceTexcoords_.clear();
  for (const PlyProperty& property : element.properties) {
    switch (property.role) {
      case PlyRole::kIgnored:
        numbers_.skip(property.type, property.isList ? readCount(property.countType) : 1);
        break;
      case PlyRole::kFace:
        readFace(property);
        break;
      case PlyRole::kStrips:
        readStrips(property);
        break;
      case PlyRole::kTexcoords:
        readTexcoords(property);
        break;
      case PlyRole::kTexnumber:
        texnumber = readInteger(property.type);
        break;
      case PlyRole::kU:
        texcoord[0] = numbers_.nextNumberOrNan(property.type);
        break;
      case PlyRole::kV:
        texcoord[1] = numbers_.nextNumberOrNan(property.type);
        break;
      case PlyRole::kRed:
      case PlyRole::kGreen:
      case PlyRole::kBlue:
        color[static_cast<int>(property.role) - static_cast<int>(PlyRole::kRed)] =
            readColor(property.type);
        break;
      case PlyRole::kX:
      case PlyRole::kY:
      case PlyRole::kZ: {
        const double value = numbers_.nextCoordinate(property.type);
        if (std::isfinite(value) && std::abs(value) > kMaxCoordinate)
          numbers_.fail(place_.name() + ": coordinate " + property.name +
                        " is larger than 1e15; scale the model down");
        point[static_cast<int>(property.role) - static_cast<int>(PlyRole::kX)] = value;
      }
    }
  }
  if (element.hasColor && element.isVertex)
    part_.pointColors.set(mesh_.pointCount(), color, numbers_.line());
  if (element.isVertex && !point.allFinite() && numbers_.line() > 0)
    log_.undefined.push_back({mesh_.pointCount(), numbers_.line()});
  if (element.hasTexcoord) part_.pointTexcoords.push_back(finiteTexcoord(texcoord));
  if (element.isVertex) mesh_.points.push_back(point);
  if (element.hasColor && element.isFace && mesh_.faceCount() > facesBefore)
    part_.faceColors.set(mesh_.faceCount() - 1, color, numbers_.line());
  if (!element.isFace || mesh_.faceCount() == facesBefore) return;
  if (!faceTexcoords_.empty()) setTexcoords();
  if (texnumber) {
    part_.texnumbers.resize(facesBefore, 0);
    part_.texnumbers.push_back(*texnumber);
  }
}

template <typename Numbers>
void BodyParser<Numbers>::readTexcoords(const PlyProperty& list) {
  for (std::uint64_t rest = readCount(list.countType); rest > 0; --rest)
    faceTexcoords_.push_back(numbers_.nextNumberOrNan(list.type));
}

/// Gives the corners of the last face their texture coordinates.
template <typename Numbers>
void BodyParser<Numbers>::setTexcoords() {
  const std::size_t corners = mesh_.faceSize(mesh_.faceCount() - 1);
  if (faceTexcoords_.size() != 2 * corners)
    numbers_.fail(place_.name() + ": texcoord has " + std::to_string(faceTexcoords_.size()) +
                  " numbers; expected 2 for each of the " + std::to_string(corners) + " corners");
  part_.cornerTexcoords.resize(mesh_.faceVertices.size() - corners, kNoCornerTexcoord);
  for (std::size_t i = 0; i < corners; ++i)
    part_.cornerTexcoords.push_back(
        finiteTexcoord({faceTexcoords_[2 * i], faceTexcoords_[2 * i + 1]}));
}

/// Notes a texture coordinate that is not finite.
template <typename Numbers>
Vec2f BodyParser<Numbers>::finiteTexcoord(const Vec2d& texcoord) {
  const Vec2f single = texcoord.cast<float>();
  if (!single.allFinite())
    log_.report.add(Oddity::kUndefinedTexcoord, numbers_.line(), place_.index);
  return single;
}

template <typename Numbers>
std::int64_t BodyParser<Numbers>::readInteger(PlyType type) {
  const double value = numbers_.next(type);
  if (!(std::abs(value) < 0x1p53) || value != std::floor(value))
    numbers_.fail(place_.name() + ": a count or index is not a whole number");
  return static_cast<std::int64_t>(value);
}

template <typename Numbers>
std::uint64_t BodyParser<Numbers>::readCount(PlyType type) {
  const std::int64_t count = readInteger(type);
  if (count < 0) numbers_.fail(place_.name() + ": a list has " + std::to_string(count) + " items");
  return static_cast<std::uint64_t>(count);
}

template <typename Numbers>
Index BodyParser<Numbers>::pointOf(std::int64_t index) {
  if (index < 0 || index >= static_cast<std::int64_t>(header_.vertexCount))
    numbers_.fail(place_.name() + " refers to vertex " + std::to_string(index) + " of " +
                  std::to_string(header_.vertexCount) + " (numbered from 0)");
  return static_cast<Index>(index);
}

template <typename Numbers>
void BodyParser<Numbers>::readFace(const PlyProperty& list) {
  const std::uint64_t corners = readCount(list.countType);
  const std::size_t first = mesh_.faceVertices.size();
  for (std::uint64_t i = 0; i < corners; ++i)
    mesh_.faceVertices.push_back(pointOf(readInteger(list.type)));
  if (corners < 3) {
    mesh_.faceVertices.resize(first);
    log_.report.add(Oddity::kShortFace, numbers_.line(), place_.index);
    return;
  }
  mesh_.faceOffsets.push_back(mesh_.cornerCount());
}

// Triangle i of a strip has corners i, i + 1, i + 2; every other triangle is turned round.
// Triangles with a repeated corner only connect parts of the strip: they become no faces.
template <typename Numbers>
void BodyParser<Numbers>::readStrips(const PlyProperty& list) {
  Index a = 0, b = 0;
  std::uint64_t inStrip = 0;
  for (std::uint64_t rest = readCount(list.countType); rest > 0; --rest) {
    const std::int64_t index = readInteger(list.type);
    if (index == -1) {
      inStrip = 0;
      continue;
    }
    const Index c = pointOf(index);
    if (++inStrip >= 3 && a != b && b != c && c != a)
      mesh_.addFace(inStrip % 2 == 1 ? std::array{a, b, c} : std::array{b, a, c});
    a = std::exchange(b, c);
  }
}

}  // namespace

PlyPart readPlyBlock(const PlyHeader& header, const PlyBlock& block, const std::string& fileName) {
  Place place;
  if (!header.binaryOrder) {
    TextScanner scan(block.bytes, fileName, {}, block.line);
    return BodyParser(TextNumbers(scan, place), header, place).parse(block.first, block.end);
  }
  const BinaryNumbers numbers(block.bytes, *header.binaryOrder, fileName, place);
  return BodyParser(numbers, header, place).parse(block.first, block.end);
}

}  // namespace vox
