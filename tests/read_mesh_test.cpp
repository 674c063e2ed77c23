// OpenMesh's vectors are not initialized; GCC warns about it when they are inlined here.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

#include "libvox/io/read_mesh.h"

#include "libvox/core/error.h"
#include "tests/mesh_files.h"
#include "tests/temporary_folder.h"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <catch2/catch.hpp>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <vector>

using namespace vox;
using vox::test::TemporaryFolder;

namespace {

using namespace vox::test;

PolygonMesh readText(std::string_view extension, std::string_view contents) {
  const TemporaryFolder folder;
  return readMesh(folder.write("mesh" + std::string(extension), std::string(contents)));
}

// The part of a message after "FILE:". Checks that the message starts so and is one printable
// line.
std::string refusal(std::string_view extension, std::string_view contents) {
  const TemporaryFolder folder;
  const auto file = folder.write("mesh" + std::string(extension), std::string(contents));
  try {
    readMesh(file);
  } catch (const InputError& error) {
    const std::string message = error.what();
    REQUIRE(message.starts_with(file.string() + ":"));
    REQUIRE(
        std::all_of(message.begin(), message.end(), [](char c) { return c >= ' ' && c <= '~'; }));
    return message.substr(file.string().size() + 1);
  }
  return "accepted";
}

struct Refused {
  std::string contents;
  std::string message;  // a part of it; for text it begins with the number of the line
};

void checkRefused(std::string_view extension, const std::vector<Refused>& cases) {
  for (const Refused& refused : cases) {
    CAPTURE(refused.contents);
    CHECK_THAT(refusal(extension, refused.contents), Catch::Contains(refused.message));
  }
}

}  // namespace

// --- Text in general ---------------------------------------------------------------------------

TEST_CASE("infinities and NaNs of every spelling are refused", "[io][error]") {
  for (const std::string bad : {"nan", "inf", "-inf", "1.#INF", "-1.#IND", "1.#QNAN", "1e999"}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(readText(".obj", "v 0 0 " + bad + "\n" + kTriangle + "f 1 2 3\n"), InputError);
    CHECK_THROWS_AS(readText(".off", "OFF 3 1 0\n0 0 " + bad + "\n1 0 0\n0 1 0\n3 0 1 2\n"),
                    InputError);
  }
}

// --- Files -------------------------------------------------------------------------------------

TEST_CASE("the extension names the format whatever its case", "[io]") {
  CHECK(polygonsOf(readText(".OBJ", kTriangle + "f 1 2 3\n")) == kOneTriangle);
  CHECK(polygonsOf(readText(".Off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")) == kOneTriangle);
}

TEST_CASE("unreadable files are refused by name", "[io][error]") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "folder.obj");
  const auto pipe = folder / "pipe.obj";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);

  CHECK_THROWS_WITH(readMesh(folder / "none.obj"), Catch::Contains("none.obj: no such file"));
  CHECK_THROWS_WITH(readMesh(folder / "folder.obj"), Catch::Contains("is a directory"));
  CHECK_THROWS_WITH(readMesh(pipe), Catch::Contains("not a regular file"));
  CHECK_THROWS_WITH(readMesh(folder.write("a.obj", "")), Catch::Contains("is empty"));
  CHECK_THROWS_WITH(readMesh(folder.write("a.3ds", "x")), Catch::Contains("'.3ds'"));
  CHECK_THROWS_AS(readMesh(folder / "none.obj"), InputError);
}

TEST_CASE("a line break in a file name does not break the message", "[io][error]") {
  CHECK_THROWS_WITH(readMesh("a\nb.obj"), Catch::StartsWith("a?b.obj: no such file"));
}

// --- OBJ ---------------------------------------------------------------------------------------

TEST_CASE("OBJ polygons arrive untouched", "[io][obj]") {
  const PolygonMesh mesh = readText(".obj",
                                    "# comment \\\n"
                                    "mtllib a.mtl\no thing\ng a b#c\nusemtl m\ns off\n"
                                    "v 0 0 0\nv 1 0 0 # right\nv 1 1 0\nv 0 1 0\nv 5 5 5\n"
                                    "vt 0 0\nvn 0 0 1\nvp 1 2\nl 1 2\n"
                                    "f 1 2 3 4\n"
                                    "f 1/1 2/1 3/1\n"
                                    "f 1//1 3//1 4//1\n"
                                    "f 1/9/9 1/-9/1 3/1/1 1/1/1 # repeated corner\n"
                                    "fo 1 2 4\n");
  CHECK(mesh.pointCount() == 5);
  CHECK(mesh.points[2] == Vec3d(1, 1, 0));
  CHECK(polygonsOf(mesh) == Polygons{{0, 1, 2, 3}, {0, 1, 2}, {0, 2, 3}, {0, 0, 2, 0}, {0, 1, 3}});
}

TEST_CASE("OBJ indices may count backwards or reach forwards", "[io][obj]") {
  const std::string text = "f 1 2 3\n" + kTriangle + "f -3 -2 -1\nv 9 9 9\nf -4 +2 4\n";
  CHECK(polygonsOf(readText(".obj", text)) == Polygons{{0, 1, 2}, {0, 1, 2}, {0, 1, 3}});
}

TEST_CASE("OBJ vertices may carry a weight or a colour", "[io][obj]") {
  const PolygonMesh mesh =
      readText(".obj", "v 0 0 1 1\nv 0 0 2 .5 .5 .5\nv 0 0 3 1 .5 .5 .5\nf 1 2 3\n");
  CHECK(mesh.points[1] == Vec3d(0, 0, 2));
  CHECK(mesh.points[2] == Vec3d(0, 0, 3));
}

TEST_CASE("lines end with LF, CRLF or CR, and a backslash joins them", "[io][obj]") {
  const std::string lineEnd = GENERATE("\n", "\r\n", "\r");
  std::string text =
      "\xEF\xBB\xBFv 0 0 0\nv 1 \\\n0 0\nv 0 1\\\n 0\ng long \\\nname\nf 1 2 \\\n3\n";
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += lineEnd.size())
    text.replace(at, 1, lineEnd);

  const PolygonMesh mesh = readText(".obj", text);

  CHECK(mesh.points[1] == Vec3d(1, 0, 0));
  CHECK(polygonsOf(mesh) == kOneTriangle);
  CHECK_THAT(refusal(".obj", text + "f 1 2 x" + lineEnd), Catch::StartsWith("10: "));
}

TEST_CASE("numbers are read exactly and without a locale", "[io][obj]") {
  const PolygonMesh mesh =
      readText(".obj",
               "v 0.1 +2.5 -.5\nv 1e-308 4.9406564584124654e-324 1e-400\n"
               "v 123456789.123456789 -1E15 1.\nv 1e-99999999999999999999 0e999 "
               "0.000001e5\nf 1 2 3 4\n");
  CHECK(mesh.points[0] == Vec3d(0.1, 2.5, -0.5));
  CHECK(mesh.points[1] == Vec3d(1e-308, std::numeric_limits<double>::denorm_min(), 0));
  CHECK(mesh.points[2] == Vec3d(123456789.123456789, -1e15, 1));
  CHECK(mesh.points[3] == Vec3d(0, 0, 0.1));
}

TEST_CASE("bad OBJ is refused with its line", "[io][obj][error]") {
  checkRefused(
      ".obj",
      {
          {"v 0 0 0\n", " no faces"},
          {"v 0 0 0\nv nan 0 0\nv 0 0 1\nf 1 2 3\n", "2: vertex 1 has a coordinate that is not"},
          {"v 0 -inf 0\nv 0 0 0\nv 0 0 1\nf 1 2 3\n", "1: vertex 0 has a coordinate that is not"},
          {"\n\nv 0 0 1e999\n", "3: '1e999' is too large"},
          {"v 0 0 1e99999999999999999999\n", "1: '1e99999999999999999999' is too large"},
          {"v 0 0 0." + std::string(50, '0') + "1e400\n", "is too large"},
          {"v 0 0 1e30\n", "1: coordinate '1e30' is larger than 1e15"},
          {"v 0 0 1.0000001e15\n", "1: coordinate"},
          {"v 0 0\n", "1: vertex with 2 numbers"},
          {"v 0 0 0 0 0\n", "1: vertex with 5 numbers"},
          {"v 0 0 0 0 0 0 0 0\n", "1: vertex with 8 numbers"},
          {"v 0 0 zero\n", "1: expected a number, found 'zero'"},
          {"v 0 0 0 1 red 1\n", "1: expected a number, found 'red'"},
          {"v 0 0x10 0\n", "1: expected a number, found '0x10'"},
          {"v 0 1,5 0\n", "1: expected a number, found '1,5'"},
          {"v 0 +-1 0\n", "1: expected a number"},
          {"v 0 \x01\x1b[31m 0\n", "1: expected a number, found '??[31m'"},
          {"v " + std::string(100, 'x'), "found '" + std::string(40, 'x') + "...'"},
          {kTriangle + "f 1 2\n", " no faces: dropped 1 face of fewer than 3 corners (on line 4)"},
          {kTriangle + "f 1 2 0\n", "4: index 0"},
          {kTriangle + "f 1 2 4\nf 1 2 9\n", "4: index 4 is out of range; the file has 3"},
          {kTriangle + "f 1 2 5\nf 1 2 9\nv 0 0 0\nv 0 0 0\n", "5: index 9 is out of range"},
          {kTriangle + "f 1 \\\n2 \\\n4\n", "6: index 4 is out of range"},
          {kTriangle + "f -1 -2 -4\n", "4: index -4 reaches before the first vertex"},
          {kTriangle + "f 1 2 4294967295\n", "4: index 4294967295 is too large"},
          {kTriangle + "f 1 2 99999999999999999999\n", "4: '99999999999999999999' is too large"},
          {kTriangle + "f 1 2 3.5\n", "4: expected a whole number, found '3.5'"},
          {kTriangle + "f 1/x 2 3\n", "4: expected a whole number, found 'x'"},
          {kTriangle + "f 1/1/1/1 2 3\n", "4: corner with 3 slashes"},
          {kTriangle + "f /1 2 3\n", "4: expected a whole number"},
      });
}

// --- PLY ---------------------------------------------------------------------------------------

namespace {

const std::string kPlyVertices =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kPlyFaces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kPlyText = "ply\nformat ascii 1.0\n" + kPlyVertices + kPlyFaces + "end_header\n";
const std::string kPlyPoints = "0 0 0\n1 0 0\n0 1 0\n";  // lines 10 to 12

// Every scalar type, properties out of order, lists of odd types, unknown elements, faces before
// vertices.
std::string variedPly(std::endian order) {
  std::string bytes = order == std::endian::little ? "ply\r\nformat binary_little_endian 1.0\r\n"
                                                   : "ply\r\nformat binary_big_endian 1.0\r\n";
  bytes +=
      "comment made by hand\r\nobj_info nothing\r\n"
      "element face 2\r\nproperty char flag\r\nproperty list short float vertex_index\r\n"
      "property uint16 id\r\n"
      "element junk 2\r\nproperty list uint32 float64 a\r\nproperty int8 b\r\n"
      "element empty 1000000000\r\n"
      "element vertex 4\r\nproperty double z\r\nproperty list uchar ushort tags\r\n"
      "property int x\r\nproperty uchar red\r\nproperty float y\r\nend_header\r\n";
  const auto put = [&]<typename... T>(T... numbers) { (append(bytes, numbers, order), ...); };
  put(std::int8_t{-1}, std::int16_t{4}, 0.0F, 1.0F, 2.0F, 3.0F, std::uint16_t{7});
  put(std::int8_t{-1}, std::int16_t{3}, 3.0F, 2.0F, 0.0F, std::uint16_t{8});
  put(std::uint32_t{2}, 0.5, 0.25, std::int8_t{0});
  put(std::uint32_t{0}, std::int8_t{0});
  for (int v = 0; v < 4; ++v)
    put(0.1 * v, std::uint8_t{1}, std::uint16_t{5}, std::int32_t{-v}, std::uint8_t{255},
        0.5F * static_cast<float>(v));
  return bytes + "trailing bytes";
}

}  // namespace

TEST_CASE("ascii PLY may wrap lines, and keeps all digits", "[io][ply]") {
  const PolygonMesh mesh = readText(".ply", kPlyText + "0.1 0 0\n1 0\n0\n\n0 1 -0.25\n3 0 1 2\n");
  CHECK(mesh.points == std::vector<Vec3d>{{0.1, 0, 0}, {1, 0, 0}, {0, 1, -0.25}});
  CHECK(polygonsOf(mesh) == kOneTriangle);
}

TEST_CASE("binary PLY may hold any types in any order of bytes and properties", "[io][ply]") {
  const PolygonMesh mesh =
      readText(".ply", variedPly(GENERATE(std::endian::little, std::endian::big)));
  CHECK(mesh.points ==
        std::vector<Vec3d>{{0, 0, 0}, {-1, 0.5, 0.1}, {-2, 1, 0.2}, {-3, 1.5, 0.1 * 3}});
  CHECK(polygonsOf(mesh) == Polygons{{0, 1, 2, 3}, {3, 2, 0}});
}

TEST_CASE("binary PLY cut anywhere is refused", "[io][ply][error]") {
  const std::string whole = variedPly(std::endian::little);
  const std::size_t end = whole.size() - std::string("trailing bytes").size();
  for (std::size_t size = 1; size < end; ++size) {
    CAPTURE(size);
    CHECK(refusal(".ply", whole.substr(0, size)) != "accepted");
  }
  CHECK_THAT(refusal(".ply", whole.substr(0, end - 1)),
             Catch::Contains(" truncated: ends within vertex 3 of 4"));
}

TEST_CASE("PLY triangle strips become triangles that keep the winding", "[io][ply]") {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\n"
      "property float y\nproperty float z\nelement tristrips 1\n"
      "property list int int vertex_indices\nend_header\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n";
  CHECK(polygonsOf(readText(".ply", header + points + "12 0 1 2 3 -1 1 2 3 3 4 2 -1\n")) ==
        Polygons{{0, 1, 2}, {2, 1, 3}, {1, 2, 3}, {4, 3, 2}});
  CHECK_THAT(refusal(".ply", header + points + "3 0 1 -2\n"), Catch::StartsWith("15: "));
}

TEST_CASE("bad ascii PLY is refused with its line", "[io][ply][error]") {
  checkRefused(
      ".ply",
      {
          {kPlyText + "0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n", "11: vertex 1 has a coordinate that is"},
          {kPlyText + "0 0 0\n1 0 1e16\n0 1 0\n3 0 1 2\n", "11: coordinate '1e16' is larger"},
          {kPlyText + "0 0 0\n1 0 1e999\n0 1 0\n3 0 1 2\n", "11: '1e999' is too large"},
          {kPlyText + "0 0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "10: unexpected '0' after the last"},
          {kPlyText + "0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "11: unexpected '0' after"},
          {kPlyText + kPlyPoints, "12: truncated: ends within face 0 of 1"},
          {kPlyText + kPlyPoints + "3 0 1\n", "13: truncated: ends within face 0 of 1"},
          {kPlyText + "0 0 0\n", "10: truncated: ends within vertex 1 of 3"},
          {kPlyText + kPlyPoints + "3 0 1 3\n", "13: face 0 refers to vertex 3 of 3"},
          {kPlyText + kPlyPoints + "3 0 1 -1\n", "13: face 0 refers to vertex -1 of 3"},
          {kPlyText + kPlyPoints + "3 0 1 1.5\n", "13: face 0: a count or index is not a whole"},
          {kPlyText + kPlyPoints + "2 0 1\n", " no faces: dropped 1 face"},
          {kPlyText + kPlyPoints + "-3 0 1 2\n", "13: face 0: a list has -3 items"},
          {kPlyText + kPlyPoints + "3 0 1 two\n", "13: expected a number, found 'two'"},
          {kPlyText + kPlyPoints + "4000000000 0 1 2\n", "13: truncated"},
      });
}

TEST_CASE("bad PLY headers are refused with their line", "[io][ply][error]") {
  const std::string start = "ply\nformat ascii 1.0\n";
  checkRefused(
      ".ply",
      {
          {"plx\n", "1: no PLY file"},
          {"ply\nformat ascii 2.0\nend_header\n", "2: unknown format version '2.0'"},
          {"ply\nformat utf8 1.0\nend_header\n", "2: unknown format 'utf8'"},
          {"ply\nformat ascii\nend_header\n", "2: the line ends where a version"},
          {"ply\n" + kPlyVertices + kPlyFaces + "end_header\n", "no format line"},
          {start, "2: truncated: ends before end_header"},
          {start + "elements vertex 3\n", "3: unknown header line 'elements'"},
          {start + "property float x\n", "3: property before the first element"},
          {start + "element vertex x\n", "3: expected a whole number"},
          {start + "element vertex -1\n", "3: element vertex has count -1"},
          {start + "element vertex 4294967295\n", "3: element vertex has count 4294967295"},
          {start + "element vertex 1\nelement vertex 1\n", "4: second element vertex"},
          {start + "element vertex 1\nproperty half x\n", "4: unknown type 'half'"},
          {start + "element vertex 1\nproperty list int x\n", "4: "},
          {start + kPlyVertices + "property int x\n", "7: second property 'x'"},
          {start + kPlyFaces + "end_header\n", "no element vertex with properties x, y and z"},
          {start + kPlyVertices + "end_header\n0 0 0\n", "7: no faces"},
          {start + kPlyVertices +
               "element face 0\nproperty list uchar int vertex_index\nend_header\n" + kPlyPoints,
           " no faces"},
      });
}

TEST_CASE("bad binary PLY is refused with its element", "[io][ply][error]") {
  const auto file = [](float x, std::uint8_t corners, float last) {
    std::string bytes = "ply\nformat binary_little_endian 1.0\n" + kPlyVertices +
                        "element face 1\nproperty list uchar float vertex_indices\nend_header\n";
    for (const float number : {0.F, 0.F, 0.F, x, 0.F, 0.F, 0.F, 1.F, 0.F}) append(bytes, number);
    append(bytes, corners);
    for (const float number : {0.F, 1.F, last}) append(bytes, number);
    return bytes;
  };
  CHECK(polygonsOf(readText(".ply", file(1, 3, 2))) == kOneTriangle);
  checkRefused(".ply", {
                           {file(NAN, 3, 2), " vertex 1 has a coordinate that is not a finite"},
                           {file(INFINITY, 3, 2), " vertex 1 has a coordinate that is not a"},
                           {file(1e30F, 3, 2), " vertex 1: coordinate x is larger than 1e15"},
                           {file(1, 2, 2), " no faces: dropped 1 face of fewer than 3 corners"},
                           {file(1, 4, 2), " truncated: ends within face 0 of 1"},
                           {file(1, 3, 3), " face 0 refers to vertex 3 of 3"},
                           {file(1, 3, -1), " face 0 refers to vertex -1 of 3"},
                           {file(1, 3, 1.5F), " face 0: a count or index is not a whole number"},
                           {file(1, 3, NAN), " face 0: a count or index is not a whole number"},
                       });
}

// --- OFF ---------------------------------------------------------------------------------------

TEST_CASE("OFF headers come in many forms", "[io][off]") {
  const std::string header = GENERATE("OFF\n4 2 5\n", "OFF 4 2 5\n", "4 2 5\n", "OFF 4 2\n",
                                      "# c\n\nOFF # c\n# c\n 4 2 0 # c\n", "COFF\n4 2 0\n",
                                      "STOFF\n4 2 0\n", "NOFF 4 2 0\n", "STCNOFF\r\n4 2 0\r\n");
  CAPTURE(header);
  const bool attributes = header.find("4 2") > 4 && header.find("#") == std::string::npos;
  const std::string more = attributes ? " 1 0 0 1 1 1 0 0\n" : "\n";
  const std::string points = "0 0 0" + more + "1 0 0" + more + "\n1 1 0" + more + "0 1 0.1" + more;

  const PolygonMesh mesh =
      readText(".off", header + points + "4 0 1 2 3 255 0 0\n# c\n3 0 2 3 0.5 0.5 0.5 1 # c\n");

  CHECK(mesh.points == std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.1}});
  CHECK(polygonsOf(mesh) == Polygons{{0, 1, 2, 3}, {0, 2, 3}});
}

TEST_CASE("bad OFF is refused with its line", "[io][off][error]") {
  const std::string start = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  checkRefused(
      ".off",
      {
          {"OFF BINARY\n", "1: binary OFF is not supported"},
          {"4OFF\n3 1 0\n", "1: '4OFF': vertices that are not 3-dimensional"},
          {"nOFF\n3\n3 1 0\n", "1: 'nOFF': vertices that are not 3-dimensional"},
          {"XOFF\n3 1 0\n", "1: unknown keyword 'XOFF'"},
          {"hello\n", "1: expected a whole number, found 'hello'"},
          {"OFF\n3 -1 0\n", "2: the number of faces is '-1'"},
          {"OFF\n4294967295 1 0\n", "2: the number of vertices is '4294967295'"},
          {"OFF\n3\n", "2: truncated: ends before the number of faces"},
          {"OFF\n3 1 0 7\n", "2: unexpected '7' after the counts"},
          {"OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", " no faces"},
          {"OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "4: vertex 1 has a coordinate that"},
          {"OFF\n3 1 0\n0 0 0\n1 1e16 0\n", "4: coordinate '1e16' is larger"},
          {"OFF\n3 1 0\n0 0 0\n1 x 0\n", "4: expected a number, found 'x'"},
          {"NOFF\n3 1 0\n0 0 0\n", "3: vertex 0 has 3 numbers; the keyword promises 6"},
          {"OFF\n3 1 0\n0 0 0\n1 0 0\n", "4: truncated: ends within vertex 2 of 3"},
          {"OFF\n4000000000 1 0\n0 0 0\n", "3: truncated: ends within vertex 1 of 4000000000"},
          {start, "5: truncated: ends within face 0 of 1"},
          {start + "3 0 1", "6: truncated: ends within face 0 of 1"},
          {start + "3 0 1\n3 0 1 2\n", "6: face 0 has 2 of 3 indices on its line"},
          {start + "3 0 1 3\n", "6: face 0 refers to vertex 3 of 3"},
          {start + "3 0 1 -1\n", "6: face 0 refers to vertex -1 of 3"},
          {start + "2 0 1\n", " no faces: dropped 1 face of fewer than 3 corners (on line 6)"},
          {start + "-3 0 1 2\n", "6: face 0 has -3 corners"},
      });
}

// --- STL ---------------------------------------------------------------------------------------

namespace {

using Facet = std::array<float, 9>;

std::string binaryStl(const std::vector<Facet>& facets,
                      std::string header = "solid looks like text") {
  header.resize(80, ' ');
  append(header, static_cast<std::uint32_t>(facets.size()));
  for (const Facet& facet : facets) {
    for (int i = 0; i < 3; ++i) append(header, std::numeric_limits<float>::quiet_NaN());
    for (const float number : facet) append(header, number);
    append(header, std::uint16_t{0});
  }
  return header;
}

std::string textFacet(const std::string& vertices) {
  return "facet normal 0 0 1\nouter loop\n" + vertices + "endloop\nendfacet\n";
}

const std::string kStlVertices = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";

}  // namespace

TEST_CASE("binary STL welds equal positions in order of appearance", "[io][stl]") {
  const PolygonMesh mesh = readText(".stl", binaryStl({{0, 0, 0, 1, 0, 0, 1, 1, 0.1F},
                                                       {-0.0F, 0, -0.0F, 1, 1, 0.1F, 0, 1, 0},
                                                       {1, 0, 0, 1, 0, 0, 5, 5, 5}}));
  CHECK(mesh.points ==
        std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, double{0.1F}}, {0, 1, 0}, {5, 5, 5}});
  CHECK(polygonsOf(mesh) == Polygons{{0, 1, 2}, {0, 2, 3}, {1, 1, 4}});
}

TEST_CASE("welding a large STL finds exactly the distinct positions", "[io][stl]") {
  std::vector<Facet> facets;  // a triangulated grid of 100 x 100 points
  for (int i = 0; i < 99; ++i)
    for (int j = 0; j < 99; ++j) {
      const auto x = static_cast<float>(i), y = static_cast<float>(j);
      facets.push_back({x, y, 0, x + 1, y, 0, x + 1, y + 1, 0});
      facets.push_back({x, y, 0, x + 1, y + 1, 0, x, y + 1, 0});
    }
  const PolygonMesh mesh = readText(".stl", binaryStl(facets));
  CHECK(mesh.pointCount() == 10000);
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (std::size_t i = 0; i < 3; ++i)
      REQUIRE(mesh.points[mesh.face(f)[i]] ==
              Vec3d(double{facets[f][3 * i]}, double{facets[f][3 * i + 1]}, 0));
}

TEST_CASE("ascii STL may hold several solids and polygons", "[io][stl]") {
  const PolygonMesh mesh = readText(
      ".stl", "solid facet of a name\r\n" + textFacet(kStlVertices) + "endsolid facet of a name\n" +
                  "SOLID\n FACET NORMAL nan nan nan OUTER LOOP\nVertex 0 0 0\nVERTEX 0 1 -0\n" +
                  "vertex 1 1 0.1\nvertex 0.5 .5 1e-1\nENDLOOP ENDFACET\nEndSolid");
  CHECK(mesh.points ==
        std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.1}, {0.5, 0.5, 0.1}});
  CHECK(polygonsOf(mesh) == Polygons{{0, 1, 2}, {0, 2, 3, 4}});
}

TEST_CASE("bad STL is refused with its line or triangle", "[io][stl][error]") {
  const std::string whole = binaryStl({{0, 0, 0, 1, 0, 0, 0, 1, 0}});
  const std::string notSolid = binaryStl({{0, 0, 0, 1, 0, 0, 0, 1, 0}}, "binary");
  checkRefused(
      ".stl",
      {
          {"garbage", " no STL file"},
          {notSolid.substr(0, 100),
           " no STL file, or damaged: 1 triangles in the header take 134 "
           "bytes, the file has 100"},
          {whole.substr(0, 100), " no STL file, or damaged: 1 triangles"},
          {binaryStl({}), " no faces"},
          {binaryStl({{0, 0, 0, 1, INFINITY, 0, 0, 1, 0}}),
           " no faces: dropped 1 facet at NaN or infinity"},
          {binaryStl({{0, 0, 0, 1, 1e30F, 0, 0, 1, 0}}), " vertex 1 has a coordinate larger than"},
          {"solid\nendsolid\n", " no faces"},
          {"solid\n" + textFacet("vertex 0 0 0\nvertex 1 nan 0\n") + "endsolid\n",
           " no faces: dropped 1 facet at NaN or infinity (on line 2)"},
          {"solid\n" + textFacet("vertex 0 0 0\nvertex 1 1e16 0\n"), "5: coordinate '1e16'"},
          {"solid\n" + textFacet("vertex 0 0 0\nvertex 1 0 0\n") + "endsolid\n",
           " no faces: dropped 1 face of fewer than 3 corners (on line 2)"},
          {"solid\n" + textFacet("vertex 0 0\nvertex 1 0 0\n"),
           "5: expected a number, found 'vertex'"},
          {"solid\nfacet normal 0 0 1\n" + kStlVertices, "3: expected outer, found 'vertex'"},
          {"solid\n" + textFacet(kStlVertices), "8: truncated: ends where facet or endsolid"},
          {"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0", "4: truncated"},
      });
}

// --- OM ----------------------------------------------------------------------------------------

namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Color |
                   OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::Status);
};
using FloatMesh = OpenMesh::PolyMesh_ArrayKernelT<>;
using DoubleMesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;

const Polygons kOmFaces = {{0, 1, 2, 3}, {3, 2, 4}, {0, 3, 4, 5, 6}};

// A quad, a triangle and a pentagon around vertex 3.
template <typename Mesh>
Mesh openMesh() {
  Mesh mesh;
  for (int v = 0; v < 7; ++v) mesh.add_vertex(typename Mesh::Point(0.1f, v, 1));
  for (const auto& face : kOmFaces) {
    std::vector<OpenMesh::VertexHandle> corners;
    for (const Index v : face) corners.emplace_back(static_cast<int>(v));
    mesh.add_face(corners);
  }
  return mesh;
}

// The OM file that OpenMesh writes for a mesh.
template <typename Mesh>
std::string omFile(const Mesh& mesh, const OpenMesh::IO::Options& options = {}) {
  omlog().disable();
  const TemporaryFolder folder;
  REQUIRE(OpenMesh::IO::write_mesh(mesh, (folder / "a.om").string(), options));
  return test::contentOf(folder / "a.om");
}

OpenMesh::IO::Options everything() {
  using OpenMesh::IO::Options;
  return Options(Options::VertexNormal | Options::VertexColor | Options::FaceNormal |
                 Options::Status | Options::Custom);
}

// An OM file of version 1.2, whose faces are lists of vertices.
std::string oldOmFile(char kind, const std::vector<std::uint8_t>& faceBytes) {
  std::string bytes = std::string("OM") + kind;
  append(bytes, std::uint8_t{1 << 5 | 2});
  for (const std::uint32_t count : {4U, 2U, 5U}) append(bytes, count);
  append(bytes, std::uint16_t{0x1600});  // vertex positions, 3 floats
  for (const float number : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 1.F, 0.5F})
    append(bytes, number);
  append(bytes, std::uint16_t{0x00e8});  // face topology, 8-bit indices
  for (const std::uint8_t byte : faceBytes) append(bytes, byte);
  return bytes;
}

}  // namespace

TEST_CASE("OM files of OpenMesh arrive as they were written", "[io][om]") {
  const PolygonMesh floats = readText(".om", omFile(openMesh<FloatMesh>()));
  CHECK(polygonsOf(floats) == kOmFaces);
  CHECK(floats.points[6] == Vec3d(double{0.1F}, 6, 1));

  DoubleMesh mesh = openMesh<DoubleMesh>();
  mesh.set_point(OpenMesh::VertexHandle(5), {0.1, 1e-308, 123456789.123456789});
  OpenMesh::VPropHandleT<double> weights;
  OpenMesh::FPropHandleT<std::string> names;
  mesh.add_property(weights, "weight");
  mesh.add_property(names, "name");
  mesh.property(weights).set_persistent(true);
  mesh.property(names).set_persistent(true);
  for (const auto& options : {OpenMesh::IO::Options(), everything()}) {
    const PolygonMesh doubles = readText(".om", omFile(mesh, options));
    CHECK(polygonsOf(doubles) == kOmFaces);
    CHECK(doubles.points[5] == Vec3d(0.1, 1e-308, 123456789.123456789));
  }
}

TEST_CASE("OM faces marked as deleted stay deleted", "[io][om]") {
  DoubleMesh mesh = openMesh<DoubleMesh>();
  mesh.delete_face(OpenMesh::FaceHandle(1), false);
  CHECK(polygonsOf(readText(".om", omFile(mesh, everything()))) ==
        Polygons{kOmFaces[0], kOmFaces[2]});
}

TEST_CASE("OM files of version 1 list the vertices of each face", "[io][om]") {
  const PolygonMesh mesh = readText(".om", oldOmFile('P', {4, 0, 0, 1, 2, 3, 3, 0, 3, 2, 0}));
  CHECK(mesh.points[3] == Vec3d(0, 1, 0.5));
  CHECK(polygonsOf(mesh) == Polygons{{0, 1, 2, 3}, {3, 2, 0}});
  CHECK(polygonsOf(readText(".om", oldOmFile('T', {0, 1, 2, 3, 2, 0}))) ==
        Polygons{{0, 1, 2}, {3, 2, 0}});
}

TEST_CASE("damaged OM is refused with what is damaged", "[io][om][error]") {
  const std::string good = omFile(openMesh<FloatMesh>());
  const auto with = [&](std::size_t at, std::initializer_list<unsigned char> bytes) {
    std::string bad = good;
    for (const unsigned char byte : bytes) bad[at++] = static_cast<char>(byte);
    return bad;
  };
  const std::size_t halfedges = 16 + 2 + 7 * 12 + 2;  // behind header and positions
  checkRefused(
      ".om",
      {
          {"garbage", " no OM file"},
          {with(0, {'X'}), " no OM file"},
          {with(2, {'X'}), " no OM file: the mesh kind"},
          {with(3, {0x43}), " OM version 2.3 is newer than 2.2"},
          {with(4, {0xff, 0xff, 0xff, 0xff}), " damaged: the header promises 4294967295 vertices"},
          {with(4, {0xff, 0xff, 0xff, 0x3f}), " truncated, or damaged"},
          {with(18, {0, 0, 0xc0, 0x7f}), " vertex 0 has a coordinate that is not a finite number"},
          {with(18, {0xff, 0xff, 0x7f, 0x7f}), " vertex 0 has a coordinate larger than 1e15"},
          {with(16, {0x00, 0x0e}), " vertex positions are not three floats"},
          {with(halfedges, {0x7f}), " refers to half-edge 127"},
          {with(halfedges, {0}), "its half-edges form no loop"},
          {with(halfedges + 1, {99}), " refers to vertex 99 of 7"},
          {with(halfedges + 1, {0xff}), " refers to vertex -1 of 7"},
          {with(halfedges + 2, {7}), "its half-edges form no loop"},
          {good.substr(0, halfedges - 2), " damaged: it has no faces"},
          {good.substr(0, halfedges + 5), " truncated, or damaged"},
          {oldOmFile('T', {0, 1, 2, 3, 2}), " truncated, or damaged"},
          {oldOmFile('P', {4, 0, 0, 1, 2, 3, 3}), " truncated: ends within face 1 of 2"},
          {oldOmFile('P', {4, 0, 0, 1, 2, 9, 3, 0, 3, 2, 0}), " face 0 refers to vertex 9 of 4"},
          {oldOmFile('P', {1, 0, 0, 2, 0, 3, 2}),
           " no faces: dropped 2 faces of fewer than 3 corners"},
      });
}

TEST_CASE("no flipped bit or cut of an OM file escapes the checks", "[io][om][error]") {
  const std::string good = omFile(openMesh<DoubleMesh>(), everything());
  const TemporaryFolder folder;
  const auto survives = [&](const std::string& file) {
    try {
      readMesh(folder.write("mesh.om", file));
    } catch (const InputError&) {
    }
  };
  for (std::size_t at = 0; at < good.size(); ++at) {
    survives(good.substr(0, at + 1));
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ (1 << at % 8));
    survives(bad);
  }
  SUCCEED();
}

TEST_CASE("smoothing groups of an OBJ file belong to the faces that follow", "[io]") {
  const test::TemporaryFolder folder;
  const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const auto groupsOf = [&](const std::string& faces) {
    return readMesh(folder.write("groups.obj", points + faces)).faceGroups;
  };
  using Groups = std::vector<std::uint32_t>;
  CHECK(groupsOf("f 1 2 3\n").empty());
  CHECK(groupsOf("f 1 2 3\ns 2\nf 1 3 4\ns off\nf 1 2 4\ns on\nf 2 3 4\n") == Groups{0, 2, 0, 1});
  CHECK(groupsOf("s 7\nf 1 2 3\nf 1 2\nf 1 3 4\n") == Groups{7, 7});
  CHECK(groupsOf("f 1 2 3\ns 4\n") == Groups{0});
}
