// Wavefront OBJ: the lines of a file as a mesh. Materials (mtllib) are read by read_materials.

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/io/face_set_builder.h"
#include "libvox/io/file_colors.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/obj_block.h"
#include "libvox/io/text_blocks.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace vox {

namespace {

// The blocks of a text, in order, as one mesh.
class ObjJoiner {
 public:
  ObjJoiner(std::vector<ObjBlock> blocks, ReadLog& log) : blocks_(std::move(blocks)), log_(log) {
    for (const ObjBlock& block : blocks_) {
      const Start& last = starts_.back();
      starts_.push_back({last.point + block.mesh.points.size(),
                         last.corner + block.mesh.faceVertices.size(),
                         last.face + block.mesh.faceOffsets.size() - 1,
                         last.texcoord + block.texcoords.size(), last.line + block.lineCount});
    }
  }

  // Whether all that the blocks say holds for the whole text. Precondition of join.
  bool isSettled() const {
    const Start& all = starts_.back();
    const auto size = [](std::size_t count) { return static_cast<std::int64_t>(count); };
    if (all.face == 0 || all.point >= kNone || all.corner >= kNone) return false;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const ObjBlock& block = blocks_[b];
      if (!block.isSettled || block.lowestPoint + size(starts_[b].point) < 0 ||
          block.lowestTexcoord + size(starts_[b].texcoord) < 0 ||
          block.highestPoint >= size(all.point) || block.highestTexcoord >= size(all.texcoord))
        return false;
    }
    return true;
  }

  PolygonMesh join();

 private:
  // Numbers of the first point, corner, face, texture coordinate and line of a block.
  struct Start {
    std::size_t point = 0, corner = 0, face = 0, texcoord = 0, line = 0;
  };

  void joinLogs();
  void joinColors();
  void joinStatements();
  void joinBlock(std::size_t b);

  std::vector<ObjBlock> blocks_;
  std::vector<Start> starts_ = {{}};  // of the blocks, and the end
  ReadLog& log_;
  PolygonMesh mesh_;
  std::vector<Vec2f> texcoords_;
};

PolygonMesh ObjJoiner::join() {
  joinLogs();
  joinColors();
  joinStatements();
  const Start& all = starts_.back();
  mesh_.points.resize(all.point);
  mesh_.faceVertices.resize(all.corner);
  mesh_.faceOffsets.resize(all.face + 1);
  const auto hasTexcoords = [](const ObjBlock& block) { return !block.cornerTexcoords.empty(); };
  if (std::any_of(blocks_.begin(), blocks_.end(), hasTexcoords)) {
    for (const ObjBlock& block : blocks_)
      texcoords_.insert(texcoords_.end(), block.texcoords.begin(), block.texcoords.end());
    mesh_.attributes.texcoords.resize(all.corner);
  }
  parallelForEach(blocks_.size(), 1, [&](std::size_t b) { joinBlock(b); });
  return std::move(mesh_);
}

void ObjJoiner::joinLogs() {
  std::uint64_t glued = 0;
  std::size_t lineOfGlued = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const ObjBlock& block = blocks_[b];
    const std::size_t line = starts_[b].line;
    log_.report.append(block.log.report, line);
    for (const auto& [point, pointLine] : block.log.undefined)
      log_.undefined.push_back({static_cast<Index>(starts_[b].point + point), line + pointLine});
    if (glued == 0 && block.gluedComments > 0) lineOfGlued = line + block.lineOfGluedComment;
    glued += block.gluedComments;
  }
  if (glued > 0) log_.report.add(Oddity::kGluedComment, lineOfGlued, ReadReport::kNoElement, glued);
}

void ObjJoiner::joinColors() {
  FileColors colors, commentColors;
  Index commentColorCount = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const ObjBlock& block = blocks_[b];
    colors.append(block.colors, static_cast<Index>(starts_[b].point), starts_[b].line);
    commentColors.append(block.commentColors, commentColorCount, starts_[b].line);
    commentColorCount += block.commentColorCount;
  }
  mesh_.pointColors = (colors.empty() ? commentColors : colors)
                          .takeLinear(static_cast<Index>(starts_.back().point), log_.report);
}

void ObjJoiner::joinStatements() {
  const auto faceCount = static_cast<Index>(starts_.back().face);
  std::array<FaceSetBuilder, 3> sets;  // by FaceStatement::Kind
  bool hasSmoothing = false;
  std::uint32_t smoothing = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (const FaceStatement& statement : blocks_[b].statements) {
      const auto face = static_cast<Index>(starts_[b].face + statement.face);
      if (statement.kind != FaceStatement::kSmoothing) {
        sets.at(statement.kind).begin(std::string(statement.name), face);
        continue;
      }
      hasSmoothing = true;
      mesh_.faceGroups.resize(face, smoothing);
      smoothing = statement.smoothing;
    }
  if (hasSmoothing) mesh_.faceGroups.resize(faceCount, smoothing);
  mesh_.attributes.objects = sets[FaceStatement::kObject].take(faceCount);
  mesh_.attributes.groups = sets[FaceStatement::kGroup].take(faceCount);
  mesh_.attributes.materials = sets[FaceStatement::kMaterial].take(faceCount);
}

// Writes the points and faces of a block to their places, and frees it.
void ObjJoiner::joinBlock(std::size_t b) {
  ObjBlock block = std::move(blocks_[b]);
  const Start& start = starts_[b];
  const auto placeOf = [](auto& vector, std::size_t first) {
    return vector.begin() + static_cast<std::ptrdiff_t>(first);
  };
  for (const Index c : block.relativeCorners)
    block.mesh.faceVertices[c] += static_cast<Index>(start.point);
  std::copy(block.mesh.points.begin(), block.mesh.points.end(), placeOf(mesh_.points, start.point));
  std::copy(block.mesh.faceVertices.begin(), block.mesh.faceVertices.end(),
            placeOf(mesh_.faceVertices, start.corner));
  std::transform(block.mesh.faceOffsets.begin() + 1, block.mesh.faceOffsets.end(),
                 placeOf(mesh_.faceOffsets, start.face + 1),
                 [&](Index offset) { return static_cast<Index>(start.corner + offset); });
  if (mesh_.attributes.texcoords.empty()) return;
  for (const Index c : block.relativeCornerTexcoords)
    block.cornerTexcoords[c] += static_cast<Index>(start.texcoord);
  block.cornerTexcoords.resize(block.mesh.faceVertices.size(), kNone);
  const Vec2f none = Vec2f::Constant(std::numeric_limits<float>::quiet_NaN());
  std::transform(block.cornerTexcoords.begin(), block.cornerTexcoords.end(),
                 placeOf(mesh_.attributes.texcoords, start.corner), [&](Index number) {
                   return number < texcoords_.size() ? texcoords_[number] : none;
                 });
}

std::vector<ObjBlock> readBlocks(const std::vector<std::string_view>& texts,
                                 const std::string& fileName) {
  std::vector<ObjBlock> blocks(texts.size());
  parallelForEach(texts.size(), 1, [&](std::size_t b) {
    blocks[b] = readObjBlock(texts[b], fileName, b == 0 ? ObjPlace::kStart : ObjPlace::kLater);
  });
  return blocks;
}

}  // namespace

PolygonMesh parseObj(std::string_view text, ReadLog& log) {
  constexpr std::size_t kBytesPerBlock = std::size_t{1} << 19;
  return parseObjInBlocks(text, kBytesPerBlock, log);
}

// A block with an error, or with a reference that may lead nowhere, is no use alone: then the whole
// text is read in order.
PolygonMesh parseObjInBlocks(std::string_view text, std::size_t bytesPerBlock, ReadLog& log) {
  const std::string& fileName = log.report.file;
  try {
    const std::vector<std::string_view> texts = lineBlocks(text, bytesPerBlock);
    if (texts.size() > 1) {
      ObjJoiner joiner(readBlocks(texts, fileName), log);
      if (joiner.isSettled()) return joiner.join();
    }
  } catch (const InputError&) {  // below with its line
  }
  std::vector<ObjBlock> blocks;
  blocks.push_back(readObjBlock(text, fileName, ObjPlace::kWhole));
  return ObjJoiner(std::move(blocks), log).join();
}

}  // namespace vox
