// Mesh files of all formats, and the checks that all formats share.

#include "libvox/io/read_mesh.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/io/input_file.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/read_materials.h"
#include "libvox/io/text_scanner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vox {

namespace {

namespace fs = std::filesystem;

using Parser = PolygonMesh (*)(std::string_view, ReadLog&);

struct Format {
  std::string_view extension;
  Parser parse;
};

constexpr std::array<Format, 7> kFormats = {{
    {".obj", parseObj},
    {".ply", parsePly},
    {".off", parseOff},
    {".stl", parseStl},
    {".om", parseOm},
    {".gltf", parseGltf},
    {".glb", parseGltf},
}};

// The parser for the extension of a file name; null if it is unknown.
Parser parserFor(const fs::path& file) {
  const std::string extension = lowerExtension(file);
  const auto format = std::find_if(kFormats.begin(), kFormats.end(),
                                   [&](const Format& f) { return f.extension == extension; });
  return format == kFormats.end() ? nullptr : format->parse;
}

void checkCounts(const PolygonMesh& mesh, const ReadReport& report) {
  const std::string& fileName = report.file;
  if (mesh.faceOffsets.size() < 2) {
    const std::string lost = lossText(report);
    throw InputError(fileName + ": no faces" +
                     (!lost.empty() ? ": " + lost
                      : mesh.points.empty()
                          ? "; a mesh needs at least one"
                          : ": the file holds only points; a surface needs faces"));
  }
  const std::size_t largest =
      std::max({mesh.points.size(), mesh.faceVertices.size(), mesh.faceOffsets.size()});
  if (largest >= kNone)
    throw InputError(fileName + ": more than 2^32 - 2 vertices or corners; split the model");
}

std::string placeOf(Index point, const ReadLog& log) {
  const auto found = std::find_if(log.undefined.begin(), log.undefined.end(),
                                  [&](const ReadLog::PointLine& at) { return at.point == point; });
  return log.report.file + ":" +
         (found == log.undefined.end() ? "" : std::to_string(found->line) + ":");
}

/// Refuses points beyond the limit, and those at NaN or infinity that faces use. The others move
/// to 0.
void settlePoints(PolygonMesh& mesh, ReadLog& log) {
  const auto sizeOfPoint = [&](Index v) {
    return mesh.points[v].cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  };
  const Index first = lowestWhere(mesh.pointCount(), kElementsPerTask,
                                  [&](Index v) { return !(sizeOfPoint(v) <= kMaxCoordinate); });
  std::vector<Index> undefined;
  for (Index v = first; v < mesh.pointCount(); ++v) {
    const double size = sizeOfPoint(v);
    if (size <= kMaxCoordinate) continue;
    if (std::isfinite(size))
      throw InputError(log.report.file + ": vertex " + std::to_string(v) +
                       " has a coordinate larger than 1e15; scale the model down");
    undefined.push_back(v);
  }
  if (undefined.empty()) return;
  std::vector<bool> used(mesh.points.size(), false);
  for (const Index v : mesh.faceVertices) used[v] = true;
  std::size_t next = 0;
  for (const Index v : undefined) {
    if (used[v])
      throw InputError(placeOf(v, log) + " vertex " + std::to_string(v) +
                       " has a coordinate that is not a finite number, and a face uses it");
    while (next < log.undefined.size() && log.undefined[next].point < v) ++next;
    const bool hasLine = next < log.undefined.size();
    log.report.add(Oddity::kUndefinedPoint, hasLine ? log.undefined[next].line : 0, v);
    mesh.points[v].setZero();
  }
}

void checkFaces(const PolygonMesh& mesh, const std::string& fileName) {
  const auto isWrong = [&](Index f) {
    const auto isOutOfRange = [&](Index v) { return v >= mesh.pointCount(); };
    const std::span<const Index> face = mesh.face(f);
    return face.size() < 3 || std::any_of(face.begin(), face.end(), isOutOfRange);
  };
  const Index f = lowestWhere(mesh.faceCount(), kElementsPerTask, isWrong);
  if (f == mesh.faceCount()) return;
  if (mesh.faceSize(f) < 3)
    throw InputError(fileName + ": face " + std::to_string(f) + " has " +
                     std::to_string(mesh.faceSize(f)) + " corners; it needs at least 3");
  for (const Index v : mesh.face(f))
    if (v >= mesh.pointCount())
      throw InputError(fileName + ": face " + std::to_string(f) + " refers to vertex " +
                       std::to_string(v) + " of " + std::to_string(mesh.pointCount()) +
                       " (numbered from 0)");
}

}  // namespace

PolygonMesh readMesh(const fs::path& file, ReadReport& report) {
  requireInputFile(file);
  requireMeshExtension(file);
  PolygonMesh mesh = parseMesh(file, contentsOf(file), report);
  readMaterials(file, mesh, report);
  return mesh;
}

PolygonMesh readMesh(const fs::path& file) {
  ReadReport report;
  return readMesh(file, report);
}

void requireMeshExtension(const fs::path& file) {
  if (parserFor(file) == nullptr)
    throw InputError(file.string() + ": unknown extension " + quote(file.extension().string()) +
                     "; a mesh is .obj, .ply, .off, .stl, .om, .gltf or .glb");
}

PolygonMesh parseMesh(const fs::path& file, std::string_view content, ReadReport& report) {
  requireMeshExtension(file);
  ReadLog log{.report = {.file = file.string()}};
  PolygonMesh mesh = parserFor(file)(content, log);
  checkCounts(mesh, log.report);
  checkFaces(mesh, log.report.file);
  settlePoints(mesh, log);
  report = std::move(log.report);
  return mesh;
}

PolygonMesh parseMesh(const fs::path& file, std::string_view content) {
  ReadReport report;
  return parseMesh(file, content, report);
}

}  // namespace vox
