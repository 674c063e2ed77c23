#include "libvox/io/read_mesh.h"

#include "libvox/core/error.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/text_scanner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <system_error>

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

// The parser of a file name; null if its extension is unknown.
Parser parserFor(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  const auto format = std::find_if(kFormats.begin(), kFormats.end(),
                                   [&](const Format& f) { return f.extension == extension; });
  return format == kFormats.end() ? nullptr : format->parse;
}

// Refuses what cannot be read to an end, before it is opened: opening a FIFO would block.
std::uintmax_t sizeOfRegularFile(const fs::path& file, const std::string& fileName) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found)
    throw InputError(fileName + ": no such file; check the path");
  if (error) throw InputError(fileName + ": cannot be read: " + error.message());
  if (fs::is_directory(status))
    throw InputError(fileName + ": is a directory; name a mesh file inside it");
  if (!fs::is_regular_file(status))
    throw InputError(fileName + ": is not a regular file; copy the mesh to a file first");

  const std::uintmax_t size = fs::file_size(file, error);
  if (error) throw InputError(fileName + ": cannot be read: " + error.message());
  if (size == 0) throw InputError(fileName + ": the file is empty");
  return size;
}

std::string contentsOf(const fs::path& file, const std::string& fileName) {
  const std::uintmax_t size = sizeOfRegularFile(file, fileName);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(fileName + ": cannot be opened; check its permissions");

  std::string contents(size, '\0');
  in.read(contents.data(), static_cast<std::streamsize>(size));
  if (in.bad() || static_cast<std::uintmax_t>(in.gcount()) != size)
    throw InputError(fileName + ": could be read only in part");
  return contents;
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
  const std::string fileName = onOneLine(file.string());
  const Parser parse = parserFor(file);
  const std::string contents = contentsOf(file, fileName);
  if (!parse)
    throw InputError(fileName + ": unknown extension " + quote(file.extension().string()) +
                     "; a mesh is .obj, .ply, .off, .stl or .om");

  PolygonMesh mesh = parse(contents, fileName);
  checkCounts(mesh, fileName);
  checkPoints(mesh, fileName);
  checkFaces(mesh, fileName);
  return mesh;
}

bool isMeshFile(const fs::path& file) {
  return parserFor(file) != nullptr;
}

}  // namespace vox
