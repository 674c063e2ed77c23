// Polygon File Format (Stanford): the elements of a file as a mesh.
//
// Source: G. Turk, "The PLY Polygon File Format", 1994; images as MeshLab names them: texnumber
// counts the comments TextureFile from 0.

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/io/companion_file.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/ply_blocks.h"
#include "libvox/io/ply_body.h"
#include "libvox/io/ply_header.h"
#include "libvox/io/ply_plain.h"
#include "libvox/io/text_scanner.h"
#include "libvox/io/unique_names.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace vox {

namespace {

const Vec2f kNoTexcoord = Vec2f::Constant(std::numeric_limits<float>::quiet_NaN());

// The blocks of a file, in order, as one mesh.
class PlyJoiner {
 public:
  // Reads the blocks that are not plain, or all.
  PlyJoiner(const PlyHeader& header, const std::vector<PlyBlock>& blocks, bool hasPlain,
            ReadLog& log)
      : header_(header), log_(log), plain_(blocks.size()), parts_(blocks.size()) {
    parallelForEach(blocks.size(), 1, [&](std::size_t b) {
      if (hasPlain) plain_[b] = plainBlockOf(header, blocks[b]);
      if (!plain_[b]) parts_[b] = readPlyBlock(header, blocks[b], log.report.file);
    });
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const PolygonMesh& mesh = parts_[b].mesh;
      const PlyCounts counts = plain_[b] ? countsOf(*plain_[b])
                                         : PlyCounts{mesh.points.size(), mesh.faceVertices.size(),
                                                     mesh.faceOffsets.size() - 1};
      const PlyCounts& start = starts_.back();
      starts_.push_back({start.points + counts.points, start.corners + counts.corners,
                         start.faces + counts.faces});
    }
  }

  // Nothing: a plain block has an error, or a face to drop.
  std::optional<PolygonMesh> join();

 private:
  void joinLogs();
  void joinColors();
  void joinTexcoords();
  void joinTextures();
  void joinPart(std::size_t b);

  const PlyHeader& header_;
  ReadLog& log_;
  std::vector<std::optional<PlainBlock>> plain_;  // read by join, straight to their places
  std::vector<PlyPart> parts_;                    // the other blocks
  std::vector<PlyCounts> starts_ = {{}};          // of the blocks, and the end
  PolygonMesh mesh_;
};

std::optional<PolygonMesh> PlyJoiner::join() {
  const PlyCounts& all = starts_.back();
  mesh_.points.resize(all.points);
  mesh_.faceVertices.resize(all.corners);
  mesh_.faceOffsets.resize(all.faces + 1);
  std::atomic<bool> isSound{true};
  parallelForEach(parts_.size(), 1, [&](std::size_t b) {
    if (!plain_[b]) return joinPart(b);
    if (!loadPlain(*plain_[b], header_.vertexCount, starts_[b], mesh_)) isSound = false;
  });
  if (!isSound) return std::nullopt;
  joinLogs();
  joinColors();
  joinTexcoords();
  joinTextures();
  return std::move(mesh_);
}

void PlyJoiner::joinLogs() {
  for (const PlyElement& element : header_.elements)
    if (element.hasColor && element.colorLine > 0)
      log_.report.add(Oddity::kForeignColor, element.colorLine);
  for (std::size_t b = 0; b < parts_.size(); ++b) {
    log_.report.append(parts_[b].log.report);
    for (const auto& [point, line] : parts_[b].log.undefined)
      log_.undefined.push_back({static_cast<Index>(starts_[b].points + point), line});
  }
}

void PlyJoiner::joinColors() {
  FileColors ofPoints, ofFaces;
  for (std::size_t b = 0; b < parts_.size(); ++b) {
    ofPoints.append(parts_[b].pointColors, static_cast<Index>(starts_[b].points));
    ofFaces.append(parts_[b].faceColors, static_cast<Index>(starts_[b].faces));
  }
  mesh_.pointColors = ofPoints.takeLinear(static_cast<Index>(starts_.back().points), log_.report);
  mesh_.faceColors = ofFaces.takeLinear(static_cast<Index>(starts_.back().faces), log_.report);
}

// Writes the points and faces of a part to their places, and frees them.
void PlyJoiner::joinPart(std::size_t b) {
  const PolygonMesh part = std::exchange(parts_[b].mesh, {});
  const PlyCounts& start = starts_[b];
  std::copy(part.points.begin(), part.points.end(), mesh_.points.data() + start.points);
  std::copy(part.faceVertices.begin(), part.faceVertices.end(),
            mesh_.faceVertices.data() + start.corners);
  std::transform(part.faceOffsets.begin() + 1, part.faceOffsets.end(),
                 mesh_.faceOffsets.data() + start.faces + 1,
                 [&](Index offset) { return static_cast<Index>(start.corners + offset); });
}

// Corners without texture coordinates of their own have those of their points.
void PlyJoiner::joinTexcoords() {
  std::vector<Vec2f> ofPoints, ofCorners;
  for (std::size_t b = 0; b < parts_.size(); ++b) {
    PlyPart& part = parts_[b];
    ofPoints.insert(ofPoints.end(), part.pointTexcoords.begin(), part.pointTexcoords.end());
    if (part.cornerTexcoords.empty()) continue;
    ofCorners.resize(starts_[b].corners, kNoTexcoord);
    ofCorners.insert(ofCorners.end(), part.cornerTexcoords.begin(), part.cornerTexcoords.end());
  }
  if (ofCorners.empty() && ofPoints.empty()) return;
  ofCorners.resize(mesh_.faceVertices.size(), kNoTexcoord);
  for (std::size_t c = 0; c < ofCorners.size(); ++c)
    if (!ofPoints.empty() && std::isnan(ofCorners[c][0]))
      ofCorners[c] = ofPoints[mesh_.faceVertices[c]];
  mesh_.attributes.texcoords = std::move(ofCorners);
}

// The images that comments name become materials.
void PlyJoiner::joinTextures() {
  if (header_.textureFiles.empty()) return;
  const std::filesystem::path folder = std::filesystem::path(log_.report.file).parent_path();
  MeshAttributes& attributes = mesh_.attributes;
  UniqueNames names;
  for (const std::string& file : header_.textureFiles) {
    Material& look = attributes.looks.emplace_back();
    look.name = names.given(file);
    look.image.emplace();
    look.image->file = foundCompanion(companionPath(file, folder), folder).string();
    attributes.materials.names.push_back(look.name);
  }
  std::vector<std::int64_t> texnumbers;
  for (std::size_t b = 0; b < parts_.size(); ++b) {
    texnumbers.resize(starts_[b].faces, 0);
    texnumbers.insert(texnumbers.end(), parts_[b].texnumbers.begin(), parts_[b].texnumbers.end());
  }
  texnumbers.resize(mesh_.faceCount(), 0);
  const auto count = static_cast<std::int64_t>(header_.textureFiles.size());
  for (const std::int64_t number : texnumbers)
    attributes.materials.ofFaces.push_back(
        number >= 0 && number < count ? static_cast<Index>(number) : kNone);
}

}  // namespace

PolygonMesh parsePly(std::string_view data, ReadLog& log) {
  constexpr std::size_t kBytesPerBlock = std::size_t{1} << 18;
  return parsePlyInBlocks(data, kBytesPerBlock, log);
}

// If a block has an error, the elements are read in order, to find the first one.
PolygonMesh parsePlyInBlocks(std::string_view data, std::size_t bytesPerBlock, ReadLog& log) {
  TextScanner scan(data, log.report.file, {});
  const PlyHeader header = parsePlyHeader(scan);
  const std::vector<PlyBlock> whole = {{0, elementCount(header), scan.rest(), scan.line()}};
  try {
    std::vector<PlyBlock> blocks;
    if (scan.rest().size() > bytesPerBlock) blocks = plyBlocks(header, scan, bytesPerBlock);
    for (const bool hasPlain : {true, false})
      if (!blocks.empty())
        if (auto mesh = PlyJoiner(header, blocks, hasPlain, log).join()) return *std::move(mesh);
  } catch (const InputError&) {  // below
  }
  return PlyJoiner(header, whole, false, log).join().value();
}

}  // namespace vox
