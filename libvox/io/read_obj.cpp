// Wavefront OBJ, polygons only.
//
// Source: Wavefront Advanced Visualizer manual, appendix B1 "Object files"; the vertex colours that
// many programs append to v lines; and those that ZBrush writes into comments:
//   #MRGB MMRRGGBBMMRRGGBB...   mask and colour of each vertex, from the first on, hexadecimal
// Materials (mtllib) are read by read_materials.

#include "libvox/core/error.h"
#include "libvox/io/face_set_builder.h"
#include "libvox/io/file_colors.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/read_mtl.h"
#include "libvox/io/text_scanner.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

namespace vox {

namespace {

constexpr std::string_view kColorComment = "#MRGB";

class ObjParser {
 public:
  ObjParser(std::string_view text, ReadLog& log)
      : scan_(text, log.report.file, {.hashComments = true, .continuations = true}), log_(log) {}

  PolygonMesh parse() {
    do readLine();
    while (scan_.nextLine());
    checkForwardReferences();
    if (hasGroups_) mesh_.faceGroups.resize(mesh_.faceCount(), 0);
    if (mesh_.faceCount() == 0) explainNoFaces();
    if (scan_.gluedComments() > 0)
      log_.report.add(Oddity::kGluedComment, scan_.lineOfGluedComment(), ReadReport::kNoElement,
                      scan_.gluedComments());
    FileColors& colors = colors_.empty() ? commentColors_ : colors_;
    mesh_.pointColors = colors.takeLinear(mesh_.pointCount(), log_.report);
    mesh_.attributes.objects = objects_.take(mesh_.faceCount());
    mesh_.attributes.groups = groups_.take(mesh_.faceCount());
    mesh_.attributes.materials = materials_.take(mesh_.faceCount());
    takeTexcoords();
    return std::move(mesh_);
  }

 private:
  // An index of a point that has not been read yet; it may follow later in the file.
  struct ForwardReference {
    std::int64_t point;  // from 1, as in the file
    std::size_t line;
  };

  void readLine();
  std::string readName();
  void readMaterialFiles();
  void readGroup();
  void readPoint();
  void readFace();
  void readCommentColors();
  void explainNoFaces() const;
  void readTexcoord();
  Index readCorner(std::string_view corner);
  void readTextureAndNormal(std::string_view indices);
  void setTexcoord(std::int64_t index);
  void takeTexcoords();
  void checkForwardReferences() const;

  TextScanner scan_;
  ReadLog& log_;
  PolygonMesh mesh_;
  FileColors colors_;
  FileColors commentColors_;
  Index commentColorCount_ = 0;
  std::uint64_t lines_ = 0;
  bool hasGroups_ = false;
  std::uint32_t group_ = 0;
  std::vector<ForwardReference> forward_;  // only those with a larger point than all before
  FaceSetBuilder objects_, groups_, materials_;
  std::vector<Vec2f> texcoords_;
  std::vector<Index> cornerTexcoords_;    // per corner so far, or fewer: the others have none
  std::size_t firstForwardTexcoord_ = 0;  // line
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
    materials_.begin(readName(), mesh_.faceCount());
  } else if (is("o")) {
    objects_.begin(readName(), mesh_.faceCount());
  } else if (is("g")) {
    groups_.begin(readName(), mesh_.faceCount());
  } else if (is("mtllib")) {
    readMaterialFiles();
  } else if (is("s")) {
    readGroup();
  } else if (is("curv", "curv2", "surf")) {
    log_.report.add(Oddity::kFreeForm, scan_.line());
  } else if (is("l")) {
    ++lines_;
  } else if (keyword.empty() && scan_.rest().starts_with(kColorComment)) {
    readCommentColors();
  }
}

// Names may be paths of Windows, so a backslash at the end joins nothing.
std::string ObjParser::readName() {
  std::string_view name = scan_.restOfLine();
  if (name.ends_with('\\')) log_.report.add(Oddity::kBackslashName, scan_.line());
  return std::string(materialName(name));
}

// Line "mtllib FILE ...". Names may have blanks, so the line may be one name or several.
void ObjParser::readMaterialFiles() {
  std::string names = readName();
  if (!names.empty()) log_.report.materialFiles.push_back(std::move(names));
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
  const auto number = static_cast<std::uint64_t>(texcoords_.size());
  const Vec2f& added = texcoords_.emplace_back(texcoord.head<2>().cast<float>());
  if (!added.allFinite()) log_.report.add(Oddity::kUndefinedTexcoord, scan_.line(), number);
}

// Line "s N", "s on" or "s off": the smoothing group of the faces that follow. 0, and anything that
// is no number, is off.
void ObjParser::readGroup() {
  const std::string_view name = scan_.token();
  hasGroups_ = true;
  group_ = name == "on" ? 1 : 0;
  std::uint32_t number = 0;
  if (std::from_chars(name.data(), name.data() + name.size(), number).ec == std::errc())
    group_ = number;
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
  commentColors_.setIntegers(255);
  for (; !digits.empty(); digits.remove_prefix(kDigits)) {
    unsigned color = 0;
    std::from_chars(digits.data() + 2, digits.data() + kDigits, color, 16);
    commentColors_.set(commentColorCount_++,
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
  if (lines_ > 0) fail("lines; a surface needs faces");
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
  if (count >= 6) colors_.set(mesh_.pointCount(), color, scan_.line());
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
    mesh_.faceVertices.resize(first);
    cornerTexcoords_.resize(std::min(cornerTexcoords_.size(), first));
    log_.report.add(Oddity::kShortFace, line);
    return;
  }
  mesh_.faceOffsets.push_back(mesh_.cornerCount());
  if (hasGroups_) {
    mesh_.faceGroups.resize(mesh_.faceCount() - 1, 0);
    mesh_.faceGroups.push_back(group_);
  }
}

// Corner "v", "v/vt", "v//vn" or "v/vt/vn". Positive indices count from 1, negative ones back from
// the last point.
Index ObjParser::readCorner(std::string_view corner) {
  const std::size_t slash = std::min(corner.find('/'), corner.size());
  readTextureAndNormal(corner.substr(slash));
  const std::int64_t index = scan_.integer(corner.substr(0, slash));
  const auto pointCount = static_cast<std::int64_t>(mesh_.points.size());

  if (index == 0) scan_.fail("index 0; OBJ counts vertices from 1");
  if (index < -pointCount)
    scan_.fail("index " + std::to_string(index) + " reaches before the first vertex; " +
               std::to_string(pointCount) + " precede this face");
  if (index >= std::int64_t{kNone})
    scan_.fail("index " + std::to_string(index) +
               " is too large; a mesh has fewer than 2^32 - 1 vertices");
  if (index > pointCount && (forward_.empty() || index > forward_.back().point))
    forward_.push_back({index, scan_.line()});
  return static_cast<Index>(index > 0 ? index - 1 : pointCount + index);
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
  const auto count = static_cast<std::int64_t>(texcoords_.size());
  const std::int64_t number = index > 0 ? index - 1 : count + index;
  if (index == 0 || number < 0 || number >= std::int64_t{kNone}) {
    log_.report.add(Oddity::kUndefinedTexcoord, scan_.line());
    return;
  }
  if (number >= count && firstForwardTexcoord_ == 0) firstForwardTexcoord_ = scan_.line();
  cornerTexcoords_.resize(mesh_.faceVertices.size(), kNone);
  cornerTexcoords_.push_back(static_cast<Index>(number));
}

void ObjParser::takeTexcoords() {
  if (cornerTexcoords_.empty()) return;
  cornerTexcoords_.resize(mesh_.cornerCount(), kNone);
  const Vec2f none = Vec2f::Constant(std::numeric_limits<float>::quiet_NaN());
  std::vector<Vec2f>& ofCorners = mesh_.attributes.texcoords;
  ofCorners.reserve(cornerTexcoords_.size());
  for (const Index number : cornerTexcoords_) {
    if (number != kNone && number >= texcoords_.size())
      log_.report.add(Oddity::kUndefinedTexcoord, firstForwardTexcoord_);
    ofCorners.push_back(number < texcoords_.size() ? texcoords_[number] : none);
  }
}

void ObjParser::checkForwardReferences() const {
  for (const auto& [point, line] : forward_)
    if (point > static_cast<std::int64_t>(mesh_.points.size()))
      scan_.failAt(line, "index " + std::to_string(point) + " is out of range; the file has " +
                             std::to_string(mesh_.points.size()) + " vertices");
}

}  // namespace

PolygonMesh parseObj(std::string_view text, ReadLog& log) {
  return ObjParser(text, log).parse();
}

}  // namespace vox
