// STL, text and binary. Both store triangles without shared points; equal positions become one
// point.
//
// Source: 3D Systems, "StereoLithography Interface Specification", 1989.

#include "libvox/core/error.h"
#include "libvox/io/binary_stl.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/point_welder.h"
#include "libvox/io/text_scanner.h"

#include <algorithm>
#include <utility>

namespace vox {

namespace {

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
  PointWelder<double> welder_{mesh_.points, 64};
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
  constexpr std::uint64_t kFacetsPerBlock = 1 << 13;
  return parseStlInBlocks(data, kFacetsPerBlock, log);
}

PolygonMesh parseStlInBlocks(std::string_view data, std::uint64_t facetsPerBlock, ReadLog& log) {
  if (isBinaryStl(data)) return parseBinaryStl(data, facetsPerBlock, log.report);
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
