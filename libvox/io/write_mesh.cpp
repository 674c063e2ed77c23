// Meshes as OBJ, OFF and PLY.

#include "libvox/io/write_mesh.h"

#include "libvox/core/color.h"
#include "libvox/core/error.h"
#include "libvox/io/byte_order.h"
#include "libvox/io/input_file.h"
#include "libvox/io/mesh_buffer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

namespace vox {

namespace {

constexpr int kDigits = 17;  // enough to distinguish any two doubles

/// Texts and numbers of a mesh file.
class Writer {
 public:
  explicit Writer(std::ostream& out) : buffer_(out) {}

  void text(std::string_view text) { buffer_.bytes() += text; }
  void count(std::size_t number) { convert(number); }
  void real(double number) { convert(number, std::chars_format::general, kDigits); }
  /// As few digits as distinguish it from other floats.
  void real(float number) { convert(number); }
  template <typename T>
  void binary(T number) {
    appendLittleEndian(buffer_.bytes(), number);
  }
  void endItem() { buffer_.endItem(); }
  void finish() { buffer_.finish(); }

 private:
  template <typename... Arguments>
  void convert(Arguments... arguments) {
    std::array<char, 64> digits;
    const auto [end, error] =
        std::to_chars(digits.data(), digits.data() + digits.size(), arguments...);
    buffer_.bytes().append(digits.data(), end);
  }

  MeshBuffer buffer_;
};

void writePoint(Writer& out, const Vec3d& point) {
  out.real(point.x());
  out.text(" ");
  out.real(point.y());
  out.text(" ");
  out.real(point.z());
}

/// " r g b" of an element; nothing if there are no colours.
void writeColor(Writer& out, const std::vector<Vec3f>& colors, Index element) {
  if (colors.empty()) return;
  for (const float light : colors[element]) {
    out.text(" ");
    out.real(static_cast<float>(screenFromLinear(light)));
  }
}

void endLine(Writer& out) {
  out.text("\n");
  out.endItem();
}

void writeObj(Writer& out, const PolygonMesh& mesh) {
  out.text("# libvox\n");
  for (Index v = 0; v < mesh.pointCount(); ++v) {
    out.text("v ");
    writePoint(out, mesh.points[v]);
    writeColor(out, mesh.pointColors, v);
    endLine(out);
  }
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    out.text("f");
    for (const Index v : mesh.face(f)) {
      out.text(" ");
      out.count(std::size_t{v} + 1);
      out.endItem();
    }
    out.text("\n");
  }
}

void writeOff(Writer& out, const PolygonMesh& mesh) {
  out.text(mesh.pointColors.empty() ? "OFF\n# libvox\n" : "COFF\n# libvox\n");
  out.count(mesh.pointCount());
  out.text(" ");
  out.count(mesh.faceCount());
  out.text(" 0\n");
  for (Index v = 0; v < mesh.pointCount(); ++v) {
    writePoint(out, mesh.points[v]);
    writeColor(out, mesh.pointColors, v);
    if (!mesh.pointColors.empty()) out.text(" 1");  // alpha
    endLine(out);
  }
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    out.count(mesh.faceSize(f));
    for (const Index v : mesh.face(f)) {
      out.text(" ");
      out.count(v);
      out.endItem();
    }
    writeColor(out, mesh.faceColors, f);
    out.text("\n");
  }
}

// Whether wider types than the common ones are needed. Some readers know only the common ones.
struct PlyTypes {
  bool doubles;      // rather than floats
  bool wideCounts;   // uint rather than uchar
  bool wideIndices;  // uint rather than int
};

PlyTypes plyTypesFor(const PolygonMesh& mesh) {
  Index largest = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) largest = std::max(largest, mesh.faceSize(f));
  const auto isFloat = [](const Vec3d& point) {
    return std::all_of(point.begin(), point.end(),
                       [](double x) { return static_cast<double>(static_cast<float>(x)) == x; });
  };
  const bool doubles = !std::all_of(mesh.points.begin(), mesh.points.end(), isFloat);
  return {doubles, largest > 255, mesh.points.size() > std::size_t{1} << 31};
}

constexpr const char* kPlyColor = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

/// Three bytes of an element; nothing if there are no colours.
void writeBytes(Writer& out, const std::vector<Vec3f>& colors, Index element) {
  if (colors.empty()) return;
  for (const float light : colors[element])
    out.binary(static_cast<std::uint8_t>(std::lround(255 * screenFromLinear(light))));
}

void writePlyHeader(Writer& out, const PolygonMesh& mesh, PlyTypes types) {
  out.text("ply\nformat binary_little_endian 1.0\ncomment libvox\nelement vertex ");
  out.count(mesh.pointCount());
  for (const char* axis : {"x", "y", "z"}) {
    out.text(types.doubles ? "\nproperty double " : "\nproperty float ");
    out.text(axis);
  }
  out.text("\n");
  if (!mesh.pointColors.empty()) out.text(kPlyColor);
  out.text("element face ");
  out.count(mesh.faceCount());
  out.text("\nproperty list ");
  out.text(types.wideCounts ? "uint " : "uchar ");
  out.text(types.wideIndices ? "uint " : "int ");
  out.text("vertex_indices\n");
  if (!mesh.faceColors.empty()) out.text(kPlyColor);
  out.text("end_header\n");
}

void writePly(Writer& out, const PolygonMesh& mesh) {
  const PlyTypes types = plyTypesFor(mesh);
  writePlyHeader(out, mesh, types);
  for (Index v = 0; v < mesh.pointCount(); ++v) {
    for (const double x : mesh.points[v])
      if (types.doubles)
        out.binary(x);
      else
        out.binary(static_cast<float>(x));
    writeBytes(out, mesh.pointColors, v);
    out.endItem();
  }
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    if (types.wideCounts) {
      out.binary(mesh.faceSize(f));
    } else {
      out.binary(static_cast<std::uint8_t>(mesh.faceSize(f)));
    }
    for (const Index v : mesh.face(f)) {
      out.binary(v);  // int and uint have the same bytes below 2^31
      out.endItem();
    }
    writeBytes(out, mesh.faceColors, f);
  }
}

}  // namespace

MeshFormat meshFormatFor(const std::filesystem::path& file) {
  const std::string extension = lowerExtension(file);
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".off") return MeshFormat::kOff;
  throw UsageError(
      file.string() +
      ": cannot write this format; use .obj, .ply or .off, or .glb with vox subdivide");
}

void writeMesh(std::ostream& out, const PolygonMesh& mesh, MeshFormat format) {
  Writer writer(out);
  switch (format) {
    case MeshFormat::kObj:
      writeObj(writer, mesh);
      break;
    case MeshFormat::kPly:
      writePly(writer, mesh);
      break;
    case MeshFormat::kOff:
      writeOff(writer, mesh);
      break;
  }
  writer.finish();
}

}  // namespace vox
