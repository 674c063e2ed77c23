// Wavefront OBJ, polygons only.
//
// Source: Wavefront Advanced Visualizer manual, appendix B1 "Object files", and the vertex colours
// that many programs append to v lines.

#include "libvox/core/error.h"
#include "libvox/io/file_colors.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/text_scanner.h"

#include <utility>

namespace vox {

namespace {

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& fileName)
      : scan_(text, fileName, {.hashComments = true, .continuations = true}) {}

  PolygonMesh parse() {
    do {
      const std::string_view keyword = scan_.token();
      if (keyword == "v") {
        readPoint();
      } else if (keyword == "f" || keyword == "fo") {
        readFace();
      }
    } while (scan_.nextLine());
    checkForwardReferences();
    mesh_.pointColors = colors_.takeLinear(mesh_.pointCount());
    return std::move(mesh_);
  }

 private:
  // An index of a point that has not been read yet; it may follow later in the file.
  struct ForwardReference {
    std::int64_t point;  // from 1, as in the file
    std::size_t line;
  };

  void readPoint();
  void readFace();
  Index readCorner(std::string_view corner);
  void checkTextureAndNormal(std::string_view indices) const;
  void checkForwardReferences() const;

  TextScanner scan_;
  PolygonMesh mesh_;
  FileColors colors_;
  std::vector<ForwardReference> forward_;  // only those with a larger point than all before
};

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
  if (count >= 6) colors_.set(mesh_.pointCount(), color);
  mesh_.points.push_back(point);
}

void ObjParser::readFace() {
  const std::size_t line = scan_.line();
  const std::size_t first = mesh_.faceVertices.size();
  for (auto corner = scan_.token(); !corner.empty(); corner = scan_.token())
    mesh_.faceVertices.push_back(readCorner(corner));

  const std::size_t corners = mesh_.faceVertices.size() - first;
  if (corners < 3)
    scan_.failAt(line, "face with " + std::to_string(corners) + " corners; it needs at least 3");
  mesh_.faceOffsets.push_back(mesh_.cornerCount());
}

// Corner "v", "v/vt", "v//vn" or "v/vt/vn". Positive indices count from 1, negative ones back from
// the last point.
Index ObjParser::readCorner(std::string_view corner) {
  const std::size_t slash = std::min(corner.find('/'), corner.size());
  checkTextureAndNormal(corner.substr(slash));
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

// Checks the part of a corner from its first slash on. Texture and normal are not used, so their
// range does not matter; but they must be numbers, else the file is damaged.
void ObjParser::checkTextureAndNormal(std::string_view indices) const {
  int count = 0;
  while (!indices.empty()) {
    indices.remove_prefix(1);
    const std::size_t length = std::min(indices.find('/'), indices.size());
    if (length > 0) scan_.integer(indices.substr(0, length));
    indices.remove_prefix(length);
    ++count;
  }
  if (count > 2) scan_.fail("corner with " + std::to_string(count) + " slashes; expected v/vt/vn");
}

void ObjParser::checkForwardReferences() const {
  for (const auto& [point, line] : forward_)
    if (point > static_cast<std::int64_t>(mesh_.points.size()))
      scan_.failAt(line, "index " + std::to_string(point) + " is out of range; the file has " +
                             std::to_string(mesh_.points.size()) + " vertices");
}

}  // namespace

PolygonMesh parseObj(std::string_view text, const std::string& fileName) {
  return ObjParser(text, fileName).parse();
}

}  // namespace vox
