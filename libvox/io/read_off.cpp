// Object File Format, text.
//
// Source: Geomview manual, "OFF Files". Accepted besides: counts on the line of the keyword; no
// edge count.

#include "libvox/core/error.h"
#include "libvox/io/file_colors.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/text_scanner.h"

#include <array>
#include <utility>

namespace vox {

namespace {

class OffParser {
 public:
  OffParser(std::string_view text, const std::string& fileName)
      : scan_(text, fileName, {.hashComments = true}) {}

  PolygonMesh parse() {
    readHeader();
    for (std::int64_t v = 0; v < pointCount_; ++v) readPoint(v);
    for (std::int64_t f = 0; f < faceCount_; ++f) readFace(f);
    if (const auto token = scan_.tokenOnAnyLine(); !token.empty())
      scan_.fail("unexpected " + quote(token) + " after the last of " + std::to_string(faceCount_) +
                 " faces; correct the counts");
    mesh_.pointColors = pointColors_.takeLinear(mesh_.pointCount());
    mesh_.faceColors = faceColors_.takeLinear(mesh_.faceCount());
    return std::move(mesh_);
  }

 private:
  void readHeader();
  bool readKeyword(std::string_view token);
  std::int64_t readCount(std::string_view token, const char* what) const;
  std::string_view tokenInside(const char* element, std::int64_t index, std::int64_t count);
  [[noreturn]] void failTruncated(const char* element, std::int64_t index,
                                  std::int64_t count) const;
  void readPoint(std::int64_t v);
  void readFace(std::int64_t f);
  void readFaceColor();

  TextScanner scan_;
  PolygonMesh mesh_;
  FileColors pointColors_;
  FileColors faceColors_;
  std::int64_t pointCount_ = 0;
  std::int64_t faceCount_ = 0;
  int attributeCount_ = 0;  // numbers that must follow the position of each vertex
  bool hasNormals_ = false;
  bool hasColors_ = false;
};

void OffParser::readHeader() {
  std::string_view token = scan_.tokenOnAnyLine();
  if (readKeyword(token)) token = scan_.tokenOnAnyLine();
  if (token == "BINARY") scan_.fail("binary OFF is not supported; save the file as text");
  pointCount_ = readCount(token, "the number of vertices");
  faceCount_ = readCount(scan_.tokenOnAnyLine(), "the number of faces");
  if (const auto edges = scan_.token(); !edges.empty()) scan_.integer(edges);
  if (const auto extra = scan_.token(); !extra.empty())
    scan_.fail("unexpected " + quote(extra) + " after the counts");
}

// Reads the keyword [ST][C][N][4][n]OFF, the first three in any order. False if the token is no
// keyword.
bool OffParser::readKeyword(std::string_view token) {
  if (!token.ends_with("OFF")) return false;
  std::string_view flags = token.substr(0, token.size() - 3);
  while (!flags.empty()) {
    const bool texture = flags.starts_with("ST");
    if (flags[0] == '4' || flags[0] == 'n')
      scan_.fail(quote(token) + ": vertices that are not 3-dimensional are not supported");
    if (!texture && flags[0] != 'C' && flags[0] != 'N')
      scan_.fail("unknown keyword " + quote(token) + "; expected OFF, COFF, NOFF or STOFF");
    attributeCount_ += texture ? 2 : 3;
    hasNormals_ |= flags[0] == 'N';
    hasColors_ |= flags[0] == 'C';
    flags.remove_prefix(texture ? 2 : 1);
  }
  return true;
}

std::int64_t OffParser::readCount(std::string_view token, const char* what) const {
  if (token.empty()) scan_.fail(std::string("truncated: ends before ") + what);
  const std::int64_t count = scan_.integer(token);
  if (count < 0 || count >= std::int64_t{kNone})
    scan_.fail(std::string(what) + " is " + quote(token) + "; it must be 0 to 2^32 - 2");
  return count;
}

// The first token of an element. Fails if the text ends before it.
std::string_view OffParser::tokenInside(const char* element, std::int64_t index,
                                        std::int64_t count) {
  const std::string_view token = scan_.tokenOnAnyLine();
  if (token.empty()) failTruncated(element, index, count);
  return token;
}

void OffParser::failTruncated(const char* element, std::int64_t index, std::int64_t count) const {
  scan_.fail(std::string("truncated: ends within ") + element + " " + std::to_string(index) +
             " of " + std::to_string(count));
}

void OffParser::readPoint(std::int64_t v) {
  Vec3d point;
  for (int axis = 0; axis < 3; ++axis)
    point[axis] = scan_.coordinate(tokenInside("vertex", v, pointCount_));
  // The normal comes before the colour, also if the keyword has them the other way round.
  const int firstOfColor = hasNormals_ ? 3 : 0;
  Vec3d color = Vec3d::Zero();
  int extra = 0;
  for (auto token = scan_.token(); !token.empty(); token = scan_.token(), ++extra) {
    const double number = scan_.number(token);
    if (extra >= firstOfColor && extra < firstOfColor + 3) color[extra - firstOfColor] = number;
  }
  if (extra < attributeCount_)
    scan_.fail("vertex " + std::to_string(v) + " has " + std::to_string(3 + extra) +
               " numbers; the keyword promises " + std::to_string(3 + attributeCount_));
  if (hasColors_) pointColors_.set(mesh_.pointCount(), color);
  mesh_.points.push_back(point);
}

void OffParser::readFace(std::int64_t f) {
  const auto name = [&] { return "face " + std::to_string(f); };
  const std::int64_t corners = scan_.integer(tokenInside("face", f, faceCount_));
  if (corners < 3)
    scan_.fail(name() + " has " + std::to_string(corners) + " corners; it needs at least 3");

  for (std::int64_t i = 0; i < corners; ++i) {
    const std::string_view token = scan_.token();
    if (token.empty() && scan_.rest().empty()) failTruncated("face", f, faceCount_);
    if (token.empty())
      scan_.fail(name() + " has " + std::to_string(i) + " of " + std::to_string(corners) +
                 " indices on its line");
    const std::int64_t index = scan_.integer(token);
    if (index < 0 || index >= pointCount_)
      scan_.fail(name() + " refers to vertex " + std::to_string(index) + " of " +
                 std::to_string(pointCount_) + " (numbered from 0)");
    mesh_.faceVertices.push_back(static_cast<Index>(index));
  }
  mesh_.faceOffsets.push_back(mesh_.cornerCount());
  readFaceColor();
  scan_.nextLine();
}

// Three numbers, or four with alpha. A single number is an index into a table of colours outside
// the file; it is ignored.
void OffParser::readFaceColor() {
  std::array<std::string_view, 4> tokens;
  std::size_t count = 0;
  for (auto token = scan_.token(); !token.empty(); token = scan_.token(), ++count)
    if (count < tokens.size()) tokens[count] = token;
  if (count != 3 && count != 4) return;
  faceColors_.set(mesh_.faceCount() - 1,
                  {scan_.number(tokens[0]), scan_.number(tokens[1]), scan_.number(tokens[2])});
}

}  // namespace

PolygonMesh parseOff(std::string_view text, const std::string& fileName) {
  return OffParser(text, fileName).parse();
}

}  // namespace vox
