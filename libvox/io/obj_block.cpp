// The lines of Wavefront OBJ files, polygons only.
//
// Source: Wavefront Advanced Visualizer manual, appendix B1 "Object files"; the vertex colours that
// many programs append to v lines; and those that ZBrush writes into comments:
//   #MRGB MMRRGGBBMMRRGGBB...   mask and colour of each vertex, from the first on, hexadecimal

#include "libvox/io/obj_block.h"

#include "libvox/core/error.h"
#include "libvox/io/read_mtl.h"
#include "libvox/io/text_scanner.h"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

namespace vox {

namespace {

constexpr std::string_view kColorComment = "#MRGB";

// Reads a block of lines. Only a block that is the whole text can tell what is wrong with it.
class ObjParser {
 public:
  ObjParser(TextScanner scan, const std::string& fileName, bool isWhole)
      : scan_(std::move(scan)), isWhole_(isWhole) {
    log_.report.file = fileName;
  }

  ObjBlock parse() {
    do readLine();
    while (scan_.nextLine());
    if (isWhole_) settle();
    block_.lineCount = scan_.line();
    block_.gluedComments = scan_.gluedComments();
    block_.lineOfGluedComment = scan_.lineOfGluedComment();
    return std::move(block_);
  }

 private:
  // An index of a point that has not been read yet; it may follow later in the file.
  struct ForwardReference {
    std::int64_t point;  // from 1, as in the file
    std::size_t line;
  };

  void readLine();
  void begin(FaceStatement::Kind kind);
  std::string_view readName();
  void readMaterialFiles();
  void readSmoothing();
  void readPoint();
  void readFace();
  void dropCornersFrom(std::size_t first);
  void readCommentColors();
  void explainNoFaces() const;
  void readTexcoord();
  Index readCorner(std::string_view corner);
  void readTextureAndNormal(std::string_view indices);
  void setTexcoord(std::int64_t index);
  void settle();
  void noteMissingTexcoords();
  void checkForwardReferences() const;

  TextScanner scan_;
  const bool isWhole_;
  ObjBlock block_;
  PolygonMesh& mesh_ = block_.mesh;
  ReadLog& log_ = block_.log;
  std::vector<ForwardReference> forward_;  // only those with a larger point than all before
  std::size_t firstForwardTexcoord_ = 0;   // line
};

void ObjParser::readLine() {
  const std::string_view keyword = scan_.token();
  const auto is = [&](auto... words) { return ((keyword == words) || ...); };
  if (is("v")) {
    readPoint();
  } else if (is("f", "fo")) {
    readFace();
  } else if (is("vt")) {
    readTexcoord();
  } else if (is("usemtl")) {
    begin(FaceStatement::kMaterial);
  } else if (is("o")) {
    begin(FaceStatement::kObject);
  } else if (is("g")) {
    begin(FaceStatement::kGroup);
  } else if (is("mtllib")) {
    readMaterialFiles();
  } else if (is("s")) {
    readSmoothing();
  } else if (is("curv", "curv2", "surf")) {
    log_.report.add(Oddity::kFreeForm, scan_.line());
  } else if (is("l")) {
    ++block_.polylines;
  } else if (keyword.empty() && scan_.rest().starts_with(kColorComment)) {
    readCommentColors();
  }
}

void ObjParser::begin(FaceStatement::Kind kind) {
  block_.statements.push_back({.kind = kind, .face = mesh_.faceCount(), .name = readName()});
}

// Names may be paths of Windows, so a backslash at the end joins nothing.
std::string_view ObjParser::readName() {
  std::string_view name = scan_.restOfLine();
  if (name.ends_with('\\')) log_.report.add(Oddity::kBackslashName, scan_.line());
  return materialName(name);
}

// Line "mtllib FILE ...". Names may have blanks, so the line may be one name or several.
void ObjParser::readMaterialFiles() {
  const std::string_view names = readName();
  if (!names.empty()) log_.report.materialFiles.emplace_back(names);
}

// Line "vt u [v [w]]".
void ObjParser::readTexcoord() {
  Vec3d texcoord = Vec3d::Zero();
  int count = 0;
  for (auto token = scan_.token(); !token.empty(); token = scan_.token(), ++count) {
    const double number = scan_.numberOrNan(token);
    if (count < 3) texcoord[count] = number;
  }
  if (count < 1 || count > 3)
    scan_.fail("texture coordinate with " + std::to_string(count) + " numbers; expected u v");
  const auto number = static_cast<std::uint64_t>(block_.texcoords.size());
  const Vec2f& added = block_.texcoords.emplace_back(texcoord.head<2>().cast<float>());
  if (added.allFinite()) return;
  log_.report.add(Oddity::kUndefinedTexcoord, scan_.line(), number);
  block_.isSettled = isWhole_;
}

// Line "s N", "s on" or "s off": the smoothing group of the faces that follow. 0, and anything that
// is no number, is off.
void ObjParser::readSmoothing() {
  const std::string_view name = scan_.token();
  std::uint32_t group = name == "on" ? 1 : 0;
  std::uint32_t number = 0;
  if (std::from_chars(name.data(), name.data() + name.size(), number).ec == std::errc())
    group = number;
  block_.statements.push_back({.kind = FaceStatement::kSmoothing,
                               .face = mesh_.faceCount(),
                               .name = {},
                               .smoothing = group});
}

void ObjParser::readCommentColors() {
  constexpr std::size_t kDigits = 8;
  const std::size_t line = scan_.line();
  std::string_view digits = scan_.restOfLine().substr(kColorComment.size());
  digits.remove_prefix(std::min(digits.find_first_not_of(" \t"), digits.size()));
  digits = digits.substr(0, digits.find_last_not_of(" \t") + 1);
  const bool isHex = digits.find_first_not_of("0123456789abcdefABCDEF") == digits.npos;
  if (!isHex || digits.size() % kDigits != 0) {
    log_.report.add(Oddity::kDamagedColors, line);
    return;
  }
  block_.commentColors.setIntegers(255);
  for (; !digits.empty(); digits.remove_prefix(kDigits)) {
    unsigned color = 0;
    std::from_chars(digits.data() + 2, digits.data() + kDigits, color, 16);
    block_.commentColors.set(block_.commentColorCount++,
                             Vec3d(color >> 16U, color >> 8U & 0xFFU, color & 0xFFU), line);
    log_.report.add(Oddity::kForeignColor, line);
  }
}

void ObjParser::explainNoFaces() const {
  const auto fail = [&](const char* what) {
    throw InputError(log_.report.file + ": no faces: the file holds only " + what);
  };
  if (log_.report[Oddity::kFreeForm].count > 0)
    fail("free-form curves and surfaces (NURBS); convert them to polygons first");
  if (block_.polylines > 0) fail("lines; a surface needs faces");
}

// Line "v x y z", then nothing, a weight, a colour, or a colour with a fourth number.
void ObjParser::readPoint() {
  Vec3d point;
  Vec3d color;
  int count = 0;
  for (auto token = scan_.token(); !token.empty(); token = scan_.token(), ++count) {
    if (count < 3) {
      point[count] = scan_.coordinate(token);
    } else {
      const double number = scan_.number(token);
      if (count < 6) color[count - 3] = number;
    }
  }
  if (count != 3 && count != 4 && count != 6 && count != 7)
    scan_.fail("vertex with " + std::to_string(count) +
               " numbers; expected x y z, optionally a weight or a colour");
  if (count >= 6) block_.colors.set(mesh_.pointCount(), color, scan_.line());
  if (!point.allFinite()) log_.undefined.push_back({mesh_.pointCount(), scan_.line()});
  mesh_.points.push_back(point);
}

void ObjParser::readFace() {
  const std::size_t line = scan_.line();
  const std::size_t first = mesh_.faceVertices.size();
  for (auto corner = scan_.token(); !corner.empty(); corner = scan_.token())
    mesh_.faceVertices.push_back(readCorner(corner));

  const std::size_t corners = mesh_.faceVertices.size() - first;
  if (corners < 3) {
    dropCornersFrom(first);
    log_.report.add(Oddity::kShortFace, line);
    return;
  }
  mesh_.faceOffsets.push_back(mesh_.cornerCount());
}

void ObjParser::dropCornersFrom(std::size_t first) {
  mesh_.faceVertices.resize(first);
  if (block_.cornerTexcoords.size() > first) {
    block_.cornerTexcoords.resize(first);
    block_.isSettled = isWhole_;  // whether any are left
  }
  for (std::vector<Index>* relative : {&block_.relativeCorners, &block_.relativeCornerTexcoords})
    while (!relative->empty() && relative->back() >= first) relative->pop_back();
}

// Corner "v", "v/vt", "v//vn" or "v/vt/vn". Positive indices count from 1, negative ones back from
// the last point.
Index ObjParser::readCorner(std::string_view corner) {
  const std::size_t slash = std::min(corner.find('/'), corner.size());
  readTextureAndNormal(corner.substr(slash));
  const std::int64_t index = scan_.integer(corner.substr(0, slash));
  const auto pointCount = static_cast<std::int64_t>(mesh_.points.size());

  if (index == 0) scan_.fail("index 0; OBJ counts vertices from 1");
  if (isWhole_ && index < -pointCount)
    scan_.fail("index " + std::to_string(index) + " reaches before the first vertex; " +
               std::to_string(pointCount) + " precede this face");
  if (index >= std::int64_t{kNone})
    scan_.fail("index " + std::to_string(index) +
               " is too large; a mesh has fewer than 2^32 - 1 vertices");
  if (index < 0) {
    block_.lowestPoint = std::min(block_.lowestPoint, pointCount + index);
    block_.relativeCorners.push_back(mesh_.cornerCount());
    return static_cast<Index>(pointCount + index);
  }
  block_.highestPoint = std::max(block_.highestPoint, index - 1);
  if (isWhole_ && index > pointCount && (forward_.empty() || index > forward_.back().point))
    forward_.push_back({index, scan_.line()});
  return static_cast<Index>(index - 1);
}

// Reads the part of a corner from its first slash on. Normals are not used, so their range does not
// matter; but they must be numbers, else the file is damaged.
void ObjParser::readTextureAndNormal(std::string_view indices) {
  int count = 0;
  while (!indices.empty()) {
    indices.remove_prefix(1);
    const std::size_t length = std::min(indices.find('/'), indices.size());
    if (length > 0) {
      const std::int64_t index = scan_.integer(indices.substr(0, length));
      if (count == 0) setTexcoord(index);
    }
    indices.remove_prefix(length);
    ++count;
  }
  if (count > 2) scan_.fail("corner with " + std::to_string(count) + " slashes; expected v/vt/vn");
}

// Notes the texture coordinate of the corner that is being read. It may follow later in the file.
void ObjParser::setTexcoord(std::int64_t index) {
  const auto count = static_cast<std::int64_t>(block_.texcoords.size());
  const std::int64_t number = index > 0 ? index - 1 : count + index;
  const bool isBeforeAll = number < 0 && (isWhole_ || index < -std::int64_t{kNone});
  if (index == 0 || isBeforeAll || number >= std::int64_t{kNone}) {
    log_.report.add(Oddity::kUndefinedTexcoord, scan_.line());
    return;
  }
  if (index < 0) {
    block_.lowestTexcoord = std::min(block_.lowestTexcoord, number);
    block_.relativeCornerTexcoords.push_back(mesh_.cornerCount());
  } else {
    block_.highestTexcoord = std::max(block_.highestTexcoord, number);
    if (number >= count && firstForwardTexcoord_ == 0) firstForwardTexcoord_ = scan_.line();
  }
  block_.cornerTexcoords.resize(mesh_.faceVertices.size(), kNone);
  block_.cornerTexcoords.push_back(static_cast<Index>(number));
}

// Counts the corners whose texture coordinate the file does not have.
void ObjParser::noteMissingTexcoords() {
  const auto isMissing = [&](Index number) {
    return number != kNone && number >= block_.texcoords.size();
  };
  const auto& numbers = block_.cornerTexcoords;
  const auto count = std::count_if(numbers.begin(), numbers.end(), isMissing);
  if (count > 0)
    log_.report.add(Oddity::kUndefinedTexcoord, firstForwardTexcoord_, ReadReport::kNoElement,
                    static_cast<std::uint64_t>(count));
}

void ObjParser::checkForwardReferences() const {
  for (const auto& [point, line] : forward_)
    if (point > static_cast<std::int64_t>(mesh_.points.size()))
      scan_.failAt(line, "index " + std::to_string(point) + " is out of range; the file has " +
                             std::to_string(mesh_.points.size()) + " vertices");
}

void ObjParser::settle() {
  checkForwardReferences();
  if (mesh_.faceCount() == 0) explainNoFaces();
  noteMissingTexcoords();
}

}  // namespace

ObjBlock readObjBlock(std::string_view lines, const std::string& fileName, ObjPlace place) {
  constexpr TextScanner::Rules kRules = {.hashComments = true, .continuations = true};
  // A byte order mark is one only at the start.
  TextScanner scan = place == ObjPlace::kLater ? TextScanner(lines, fileName, kRules, 1)
                                               : TextScanner(lines, fileName, kRules);
  return ObjParser(std::move(scan), fileName, place == ObjPlace::kWhole).parse();
}

}  // namespace vox
