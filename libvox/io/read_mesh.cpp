// Mesh files of all formats, and the checks that all formats share.

#include "libvox/io/read_mesh.h"

#include "libvox/core/error.h"
#include "libvox/io/input_file.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/text_scanner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

namespace vox {

namespace {

namespace fs = std::filesystem;

using Parser = PolygonMesh (*)(std::string_view, const std::string&);

struct Format {
  std::string_view extension;
  Parser parse;
};

constexpr std::array<Format, 5> kFormats = {{
    {".obj", parseObj},
    {".ply", parsePly},
    {".off", parseOff},
    {".stl", parseStl},
    {".om", parseOm},
}};

// The parser for the extension of a file name; null if it is unknown.
Parser parserFor(const fs::path& file) {
  const std::string extension = lowerExtension(file);
  const auto format = std::find_if(kFormats.begin(), kFormats.end(),
                                   [&](const Format& f) { return f.extension == extension; });
  return format == kFormats.end() ? nullptr : format->parse;
}

void checkCounts(const PolygonMesh& mesh, const std::string& fileName) {
  if (mesh.faceOffsets.size() < 2)
    throw InputError(fileName + ": no faces; a mesh needs at least one");
  const std::size_t largest =
      std::max({mesh.points.size(), mesh.faceVertices.size(), mesh.faceOffsets.size()});
  if (largest >= kNone)
    throw InputError(fileName + ": more than 2^32 - 2 vertices or corners; split the model");
}

void checkPoints(const PolygonMesh& mesh, const std::string& fileName) {
  for (Index v = 0; v < mesh.pointCount(); ++v) {
    const double size = mesh.points[v].cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    if (size <= kMaxCoordinate) continue;
    throw InputError(fileName + ": vertex " + std::to_string(v) +
                     (std::isfinite(size)
                          ? " has a coordinate larger than 1e15; scale the model down"
                          : " has a coordinate that is not a finite number"));
  }
}

void checkFaces(const PolygonMesh& mesh, const std::string& fileName) {
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    if (mesh.faceSize(f) < 3)
      throw InputError(fileName + ": face " + std::to_string(f) + " has " +
                       std::to_string(mesh.faceSize(f)) + " corners; it needs at least 3");
    for (const Index v : mesh.face(f))
      if (v >= mesh.pointCount())
        throw InputError(fileName + ": face " + std::to_string(f) + " refers to vertex " +
                         std::to_string(v) + " of " + std::to_string(mesh.pointCount()) +
                         " (numbered from 0)");
  }
}

}  // namespace

PolygonMesh readMesh(const fs::path& file) {
  requireInputFile(file);
  requireMeshExtension(file);
  return parseMesh(file, contentsOf(file));
}

void requireMeshExtension(const fs::path& file) {
  if (parserFor(file) == nullptr)
    throw InputError(file.string() + ": unknown extension " + quote(file.extension().string()) +
                     "; a mesh is .obj, .ply, .off, .stl or .om");
}

PolygonMesh parseMesh(const fs::path& file, std::string_view content) {
  const std::string fileName = file.string();
  requireMeshExtension(file);
  PolygonMesh mesh = parserFor(file)(content, fileName);
  checkCounts(mesh, fileName);
  checkPoints(mesh, fileName);
  checkFaces(mesh, fileName);
  return mesh;
}

}  // namespace vox
