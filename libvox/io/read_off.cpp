// Object File Format, text.
//
// Source: Geomview manual, "OFF Files". Accepted besides: counts on the line of the keyword, even
// without a blank; the number of edges on a line of its own, or none; a face over several lines.

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
  OffParser(std::string_view text, ReadLog& log)
      : scan_(text, log.report.file, {.hashComments = true}), log_(log) {}

  PolygonMesh parse() {
    readHeader();
    for (std::int64_t v = 0; v < pointCount_; ++v) readPoint(v);
    for (std::int64_t f = 0; f < faceCount_; ++f) readFace(f);
    if (const auto token = scan_.tokenOnAnyLine(); !token.empty())
      log_.report.add(Oddity::kTrailingBytes, scan_.line(), ReadReport::kNoElement,
                      token.size() + scan_.rest().size());
    if (scan_.gluedComments() > 0)
      log_.report.add(Oddity::kGluedComment, scan_.lineOfGluedComment(), ReadReport::kNoElement,
                      scan_.gluedComments());
    mesh_.pointColors = pointColors_.takeLinear(mesh_.pointCount(), log_.report);
    mesh_.faceColors = faceColors_.takeLinear(mesh_.faceCount(), log_.report);
    return std::move(mesh_);
  }

 private:
  void readHeader();
  std::string_view afterKeyword(std::string_view token);
  void readFlags(std::string_view keyword);
  void skipEdgeCount();
  std::int64_t readCount(std::string_view token, const char* what) const;
  std::string_view tokenInside(const char* element, std::int64_t index, std::int64_t count);
  [[noreturn]] void failTruncated(const char* element, std::int64_t index,
                                  std::int64_t count) const;
  void readPoint(std::int64_t v);
  void readFace(std::int64_t f);
  std::string_view nextIndexOnLine(std::int64_t f, std::int64_t read, std::int64_t corners);
  void addIndex(std::int64_t f, std::string_view token);
  void readFaceColor(bool keep);

  TextScanner scan_;
  ReadLog& log_;
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
  std::string_view token = afterKeyword(scan_.tokenOnAnyLine());
  if (token.empty()) token = scan_.tokenOnAnyLine();
  if (token == "BINARY") scan_.fail("binary OFF is not supported; save the file as text");
  pointCount_ = readCount(token, "the number of vertices");
  faceCount_ = readCount(scan_.tokenOnAnyLine(), "the number of faces");
  skipEdgeCount();
  if (const auto extra = scan_.token(); !extra.empty())
    scan_.fail("unexpected " + quote(extra) + " after the counts");
}

// The number of edges is on the line of the other counts, alone on the next, or missing.
void OffParser::skipEdgeCount() {
  if (const auto edges = scan_.token(); !edges.empty()) {
    scan_.integer(edges);
    return;
  }
  TextScanner ahead = scan_;
  const auto edges = ahead.tokenOnAnyLine();
  const bool isWhole = edges.find_first_not_of("0123456789") == edges.npos;
  if (!edges.empty() && isWhole && ahead.token().empty()) scan_ = ahead;
}

// Reads the keyword at the start of the token, if there is one, and returns what follows it. Some
// programs write it in lower case.
std::string_view OffParser::afterKeyword(std::string_view token) {
  constexpr std::string_view kOff = "OFF";
  const std::size_t off = token.starts_with("off") ? 0 : token.find(kOff);
  if (off == token.npos) return token;
  const std::size_t end = off + kOff.size();
  const std::string_view glued = token.substr(end);
  if (!glued.empty() && glued.find_first_not_of("0123456789") != glued.npos) return token;
  if (!glued.empty()) log_.report.add(Oddity::kGluedKeyword, scan_.line());
  readFlags(token.substr(0, end));
  return glued;
}

// Reads the keyword [ST][C][N][4][n]OFF, the first three in any order.
void OffParser::readFlags(std::string_view token) {
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
  if (hasColors_) pointColors_.set(mesh_.pointCount(), color, scan_.line());
  if (!point.allFinite()) log_.undefined.push_back({mesh_.pointCount(), scan_.line()});
  mesh_.points.push_back(point);
}

// A face of fewer than 3 corners is dropped.
void OffParser::readFace(std::int64_t f) {
  const std::int64_t corners = scan_.integer(tokenInside("face", f, faceCount_));
  const std::size_t line = scan_.line();
  if (corners < 0)
    scan_.fail("face " + std::to_string(f) + " has " + std::to_string(corners) + " corners");
  const std::size_t first = mesh_.faceVertices.size();
  for (std::int64_t i = 0; i < corners; ++i) addIndex(f, nextIndexOnLine(f, i, corners));
  if (scan_.line() != line) log_.report.add(Oddity::kBrokenFace, line);
  const bool keep = corners >= 3;
  if (keep) {
    mesh_.faceOffsets.push_back(mesh_.cornerCount());
  } else {
    mesh_.faceVertices.resize(first);
    log_.report.add(Oddity::kShortFace, line);
  }
  readFaceColor(keep);
  scan_.nextLine();
}

void OffParser::addIndex(std::int64_t f, std::string_view token) {
  const std::int64_t index = scan_.integer(token);
  if (index < 0 || index >= pointCount_)
    scan_.fail("face " + std::to_string(f) + " refers to vertex " + std::to_string(index) + " of " +
               std::to_string(pointCount_) + " (numbered from 0)");
  mesh_.faceVertices.push_back(static_cast<Index>(index));
}

// The next index of a face, on this line or the next. The next line is not taken if it looks like a
// face of its own: then an index is missing.
std::string_view OffParser::nextIndexOnLine(std::int64_t f, std::int64_t read,
                                            std::int64_t corners) {
  if (const std::string_view token = scan_.token(); !token.empty()) return token;
  const std::size_t line = scan_.line();
  TextScanner next = scan_;
  std::string_view token = next.tokenOnAnyLine();
  if (token.empty()) failTruncated("face", f, faceCount_);
  const TextScanner afterFirst = next;
  std::int64_t count = 1;
  std::int64_t whole = 0;  // whole numbers after the first token, before any other
  for (std::string_view more = next.token(); !more.empty(); more = next.token(), ++count)
    if (whole == count - 1 && more.find_first_not_of("0123456789") == more.npos) ++whole;
  const bool fits = count <= corners - read;
  const std::int64_t ownCorners = fits ? 0 : scan_.integer(token);
  const std::int64_t extra = count - 1 - ownCorners;
  const bool hasColor = extra == 1 || extra == 3 || extra == 4;
  if (ownCorners >= 3 && whole >= ownCorners && (extra == 0 || hasColor))
    scan_.failAt(line, "face " + std::to_string(f) + " has " + std::to_string(read) + " of " +
                           std::to_string(corners) + " indices on its line");
  scan_ = afterFirst;
  return token;
}

// Three numbers, or four with alpha. A single number is an index into a table of colours outside
// the file; it is ignored.
void OffParser::readFaceColor(bool keep) {
  std::array<std::string_view, 4> tokens;
  std::size_t count = 0;
  for (auto token = scan_.token(); !token.empty(); token = scan_.token(), ++count)
    if (count < tokens.size()) tokens[count] = token;
  if (!keep || (count != 3 && count != 4)) return;
  faceColors_.set(mesh_.faceCount() - 1,
                  {scan_.number(tokens[0]), scan_.number(tokens[1]), scan_.number(tokens[2])},
                  scan_.line());
}

}  // namespace

PolygonMesh parseOff(std::string_view text, ReadLog& log) {
  return OffParser(text, log).parse();
}

}  // namespace vox
