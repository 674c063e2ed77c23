// STL, text and binary. Both store triangles without shared points; equal positions become one
// point.
//
// Source: 3D Systems, "StereoLithography Interface Specification", 1989. Colours in the attribute
// of a binary facet, 5 bits each, as two programs write them:
//   Magics: the header has COLOR=rgba, the colour of the whole; a facet has its own if bit 15 is 0,
//           red in the lowest bits
//   VisCAM, SolidView: a facet has a colour if bit 15 is 1, blue in the lowest bits

#include "libvox/core/error.h"
#include "libvox/io/byte_order.h"
#include "libvox/io/file_colors.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/text_scanner.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace vox {

namespace {

constexpr std::size_t kStlHeaderBytes = 84;  // 80 of comment, 4 of triangle count
constexpr std::size_t kFacetBytes = 50;      // normal, 3 positions, 2 of attribute

// Finds the point with a position; adds it if there is none. An open-addressing hash table of point
// indices, at most half full. -0 equals +0.
class PointWelder {
 public:
  explicit PointWelder(std::vector<Vec3d>& points) : points_(points), slots_(64, kNone) {}

  Index indexOf(const Vec3d& position) {
    std::size_t slot = slotOf(position);
    if (slots_[slot] != kNone) return slots_[slot];
    if (2 * (points_.size() + 1) > slots_.size()) {
      grow();
      slot = slotOf(position);
    }
    slots_[slot] = static_cast<Index>(points_.size());
    points_.push_back(position);
    return slots_[slot];
  }

 private:
  static std::size_t hash(const Vec3d& position) {
    std::uint64_t h = 0;
    for (const double x : position) {
      h ^= std::bit_cast<std::uint64_t>(x + 0.0);  // + 0.0 turns -0 into +0
      h *= 0x9e3779b97f4a7c15U;
      h ^= h >> 29;
    }
    h *= 0xbf58476d1ce4e5b9U;
    return h ^ (h >> 32);
  }

  // The slot of this position, or the free slot where it is to be put.
  std::size_t slotOf(const Vec3d& position) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash(position) & mask;
    while (slots_[slot] != kNone && points_[slots_[slot]] != position) slot = (slot + 1) & mask;
    return slot;
  }

  void grow() {
    slots_.assign(2 * slots_.size(), kNone);
    for (std::size_t v = 0; v < points_.size(); ++v)
      slots_[slotOf(points_[v])] = static_cast<Index>(v);
  }

  std::vector<Vec3d>& points_;
  std::vector<Index> slots_;
};

std::uint64_t binaryTriangleCount(std::string_view data) {
  return loadNumber<std::uint32_t>(data.data() + kStlHeaderBytes - 4, std::endian::little);
}

// Whether the content has the size that a binary header gives, or more. (The first word decides
// nothing: many binary files start with "solid". Of a text, the size would be that of more than
// 500 million facets.)
bool isBinary(std::string_view data) {
  if (data.size() < kStlHeaderBytes) return false;
  const std::uint64_t count = binaryTriangleCount(data);
  const std::uint64_t size = kStlHeaderBytes + kFacetBytes * count;
  return data.size() == size || (count > 0 && data.size() > size);
}

// The colours of the facets of a binary file.
class FacetColors {
 public:
  explicit FacetColors(std::string_view header) {
    constexpr std::string_view kKey = "COLOR=";
    const std::size_t key = header.find(kKey);
    if (key == header.npos || key + kKey.size() + 3 > header.size()) return;
    isMagics_ = true;
    for (std::size_t i = 0; i < 3; ++i)
      whole_[static_cast<int>(i)] =
          static_cast<double>(static_cast<unsigned char>(header[key + kKey.size() + i])) / 255;
  }

  void set(Index face, std::uint16_t attribute) {
    const bool high = (attribute & 0x8000U) != 0;
    const Vec3d fromLowest(attribute & 31U, attribute >> 5U & 31U, attribute >> 10U & 31U);
    if (isMagics_) {
      colors_.set(face, high ? whole_ : Vec3d(fromLowest / 31));
    } else if (high) {
      colors_.set(face, fromLowest.reverse() / 31);
    }
  }

  std::vector<Vec3f> take(Index faceCount, ReadReport& report) {
    if (!colors_.empty()) report.add(Oddity::kForeignColor, 0);
    return colors_.takeLinear(faceCount, report);
  }

 private:
  bool isMagics_ = false;
  Vec3d whole_ = Vec3d::Ones();
  FileColors colors_;
};

PolygonMesh parseBinary(std::string_view data, ReadReport& report) {
  PolygonMesh mesh;
  PointWelder welder(mesh.points);
  FacetColors colors(data.substr(0, kStlHeaderBytes - 4));
  const std::uint64_t count = binaryTriangleCount(data);
  for (std::uint64_t f = 0; f < count; ++f) {
    const char* at = data.data() + kStlHeaderBytes + kFacetBytes * f + 12;  // skips the normal
    std::array<Vec3d, 3> positions;
    bool isFinite = true;  // nan, unequal to itself, could not be welded
    for (Vec3d& position : positions) {
      for (int axis = 0; axis < 3; ++axis, at += 4)
        position[axis] = static_cast<double>(loadNumber<float>(at, std::endian::little));
      isFinite = isFinite && position.allFinite();
    }
    if (!isFinite) {
      report.add(Oddity::kUndefinedFacet, 0, f);
      continue;
    }
    colors.set(mesh.faceCount(), loadNumber<std::uint16_t>(at, std::endian::little));
    for (const Vec3d& position : positions) mesh.faceVertices.push_back(welder.indexOf(position));
    mesh.faceOffsets.push_back(mesh.cornerCount());
  }
  mesh.faceColors = colors.take(mesh.faceCount(), report);
  if (const std::size_t rest = data.size() - kStlHeaderBytes - kFacetBytes * count; rest > 0)
    report.add(Oddity::kTrailingBytes, 0, ReadReport::kNoElement, rest);
  return mesh;
}

bool sameWord(std::string_view token, std::string_view lowerCase) {
  const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; };
  return std::equal(token.begin(), token.end(), lowerCase.begin(), lowerCase.end(), same);
}

class TextParser {
 public:
  TextParser(std::string_view text, ReadReport& report)
      : scan_(text, report.file, {}), report_(report) {}

  bool startsWithSolid() { return sameWord(scan_.tokenOnAnyLine(), "solid"); }

  // Precondition: the first "solid" has been read.
  PolygonMesh parse() {
    readSolid();
    for (auto token = scan_.tokenOnAnyLine(); !token.empty(); token = scan_.tokenOnAnyLine()) {
      if (!sameWord(token, "solid")) {
        report_.add(Oddity::kTrailingBytes, scan_.line(), ReadReport::kNoElement,
                    token.size() + scan_.rest().size());
        break;
      }
      readSolid();
    }
    return std::move(mesh_);
  }

 private:
  void readSolid();
  void readFacet();
  void readVertex();
  std::string_view next(std::string_view expected);
  void expect(std::string_view keyword);
  [[noreturn]] void failExpected(std::string_view keyword, std::string_view token) const;

  TextScanner scan_;
  ReadReport& report_;
  PolygonMesh mesh_;
  PointWelder welder_{mesh_.points};
  std::vector<Vec3d> facet_;  // positions of the facet that is being read
};

void TextParser::readSolid() {
  scan_.nextLine();  // the name may be anything
  for (;;) {
    const std::string_view token = next("facet or endsolid");
    if (sameWord(token, "endsolid")) break;
    if (!sameWord(token, "facet")) failExpected("facet or endsolid", token);
    readFacet();
  }
  scan_.nextLine();
}

// The rest of "facet normal nx ny nz outer loop vertex x y z ... endloop endfacet". Normals are not
// used; they are often nan.
void TextParser::readFacet() {
  const std::size_t line = scan_.line();
  facet_.clear();
  expect("normal");
  for (int axis = 0; axis < 3; ++axis) next("a normal");
  expect("outer");
  expect("loop");
  for (auto token = next("vertex"); !sameWord(token, "endloop");
       token = next("vertex or endloop")) {
    if (!sameWord(token, "vertex")) failExpected("vertex or endloop", token);
    readVertex();
  }
  expect("endfacet");

  const auto isFinite = [](const Vec3d& position) { return position.allFinite(); };
  if (!std::all_of(facet_.begin(), facet_.end(), isFinite))
    return report_.add(Oddity::kUndefinedFacet, line);
  if (facet_.size() < 3) return report_.add(Oddity::kShortFace, line);
  for (const Vec3d& position : facet_) mesh_.faceVertices.push_back(welder_.indexOf(position));
  mesh_.faceOffsets.push_back(mesh_.cornerCount());
}

void TextParser::readVertex() {
  Vec3d position;
  for (int axis = 0; axis < 3; ++axis) position[axis] = scan_.coordinate(next("a coordinate"));
  facet_.push_back(position);
}

// The next token. Fails if the text ends before it.
std::string_view TextParser::next(std::string_view expected) {
  const std::string_view token = scan_.tokenOnAnyLine();
  if (token.empty())
    scan_.fail("truncated: ends where " + std::string(expected) + " is expected, after " +
               std::to_string(mesh_.faceCount()) + " facets");
  return token;
}

void TextParser::expect(std::string_view keyword) {
  const std::string_view token = next(keyword);
  if (!sameWord(token, keyword)) failExpected(keyword, token);
}

void TextParser::failExpected(std::string_view keyword, std::string_view token) const {
  scan_.fail("expected " + std::string(keyword) + ", found " + quote(token));
}

[[noreturn]] void failNeither(std::string_view data, const std::string& fileName) {
  if (data.size() < kStlHeaderBytes)
    throw InputError(fileName + ": no STL file: neither \"solid\" nor a header of 84 bytes");
  const std::uint64_t count = binaryTriangleCount(data);
  throw InputError(fileName + ": no STL file, or damaged: " + std::to_string(count) +
                   " triangles in the header take " +
                   std::to_string(kStlHeaderBytes + kFacetBytes * count) + " bytes, the file has " +
                   std::to_string(data.size()));
}

}  // namespace

PolygonMesh parseStl(std::string_view data, ReadLog& log) {
  if (isBinary(data)) return parseBinary(data, log.report);
  TextParser text(data, log.report);
  // Else a damaged binary file. After the facets of a text anything may follow.
  const std::size_t nul = data.find('\0');
  const std::string_view start = data.substr(0, nul);
  const bool isText =
      nul == data.npos || start.find("facet") != start.npos || start.find("FACET") != start.npos;
  if (!isText || !text.startsWithSolid()) failNeither(data, log.report.file);
  return text.parse();
}

}  // namespace vox
