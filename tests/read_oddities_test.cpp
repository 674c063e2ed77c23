// What readers accept beyond the definitions of the formats, and what they tell about it.

#include "libvox/core/color.h"
#include "libvox/core/error.h"
#include "libvox/io/read_mesh.h"
#include "libvox/io/read_report.h"
#include "libvox/io/scene_file.h"
#include "libvox/pipeline/convert.h"
#include "tests/mesh_files.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

using namespace vox;
using Catch::Contains;
using Catch::StartsWith;

namespace read_oddities {  // names of its own: see tests/CMakeLists.txt
namespace {

using namespace vox::test;

struct Read {
  PolygonMesh mesh;
  ReadReport report;
};

Read read(const std::string& file, std::string_view content) {
  Read all;
  all.mesh = parseMesh(file, content, all.report);
  return all;
}

std::string refusal(const std::string& file, std::string_view content) {
  try {
    parseMesh(file, content);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// Linear colour of sRGB values, 0 to 1.
Vec3f light(double r, double g, double b) {
  return Vec3d(linearFromScreen(r), linearFromScreen(g), linearFromScreen(b)).cast<float>();
}

void checkColors(const std::vector<Vec3f>& colors, const std::vector<Vec3f>& expected) {
  REQUIRE(colors.size() == expected.size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    CAPTURE(i, colors[i].transpose(), expected[i].transpose());
    CHECK((colors[i] - expected[i]).cwiseAbs().maxCoeff() < 1e-6F);
  }
}

const std::string kOffPoints = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

}  // namespace

// --- OBJ ---------------------------------------------------------------------------------------

TEST_CASE("OBJ faces of fewer than 3 corners are dropped and counted", "[io][obj]") {
  const Read all = read("a.obj", kTriangle + "f 1 2\nf 1 2 3\nf\nf 3\nf 1/1 2/2\n");
  CHECK(polygonsOf(all.mesh) == kOneTriangle);
  CHECK(lossText(all.report) == "dropped 4 faces of fewer than 3 corners (the first on line 4)");
  CHECK(firstOddity(all.report) == "a.obj:4: face of fewer than 3 corners");
}

TEST_CASE("a # right after a number begins a comment", "[io][obj][off]") {
  const Read obj =
      read("a.obj", "v 0 0 0#a\nv 1 0 0.5#\nv 0 1 0\nf 1 2 3#7\nf 1//2 2/1/1#\\\nf 3 2 1\n");
  CHECK(obj.mesh.points[1] == Vec3d(1, 0, 0.5));
  CHECK(polygonsOf(obj.mesh) == Polygons{{0, 1, 2}, {2, 1, 0}});
  CHECK(obj.report[Oddity::kGluedComment].count == 4);
  CHECK(obj.report[Oddity::kGluedComment].line == 1);
  const Read off = read("a.off", "OFF#a\n4 1 0#b\n" + kOffPoints + "4 0 1 2 3#c\n");
  CHECK(polygonsOf(off.mesh) == Polygons{{0, 1, 2, 3}});
  CHECK(lossText(off.report).empty());
}

TEST_CASE("a backslash at the end of a name joins no lines", "[io][obj]") {
  const std::string keyword = GENERATE("mtllib C:\\tmp\\", "usemtl a\\", "o \\", "g a b\\");
  const std::string end = GENERATE("\n", "\r\n", "\r");
  CAPTURE(keyword);
  const Read all = read("a.obj", kTriangle + keyword + end + "f 1 2 3" + end);
  CHECK(polygonsOf(all.mesh) == kOneTriangle);
  CHECK(all.report[Oddity::kBackslashName].line == 4);
  // Elsewhere it does.
  CHECK(polygonsOf(read("a.obj", kTriangle + "f 1 2 \\" + end + "3" + end).mesh) == kOneTriangle);
}

TEST_CASE("OBJ colours in comments of ZBrush are those of the vertices in order",
          "[io][obj][color]") {
  const std::string block =
      GENERATE("#MRGB ffff0000ffFF8000\n#MRGB ff0000ff\n", "#MRGB ffff0000ffff8000ff0000ff \r\n",
               "#MRGBffff0000ffff8000ff0000ffff123456\n");
  const bool before = GENERATE(true, false);
  const Read all =
      read("a.obj", before ? block + kTriangle + "f 1 2 3\n" : kTriangle + block + "f 1 2 3\n");
  checkColors(all.mesh.pointColors, {light(1, 0, 0), light(1, 128 / 255.0, 0), light(0, 0, 1)});
  CHECK(lossText(all.report).empty());
  CHECK_FALSE(firstOddity(all.report).empty());
  // Colours in v lines win; vertices without are white; damaged lines are no error.
  const Read both = read("a.obj", "#MRGB ff00ff00\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  checkColors(both.mesh.pointColors, {light(1, 0, 0), light(1, 1, 1), light(1, 1, 1)});
  const Read few =
      read("a.obj", kTriangle + "#MRGB ff00ff00\n#MRGB ff00f\n#MRGB nothing!\nf 1 2 3\n");
  checkColors(few.mesh.pointColors, {light(0, 1, 0), light(1, 1, 1), light(1, 1, 1)});
  CHECK_THAT(lossText(few.report), Contains("ignored 2 lines of #MRGB"));
}

TEST_CASE("files without polygons say what they hold", "[io][error]") {
  CHECK_THAT(refusal("a.obj", "v 0 0 0\nv 1 0 0\n"), Contains("only points"));
  CHECK_THAT(refusal("a.obj", kTriangle + "p 1 2 3\n"), Contains("only points"));
  CHECK_THAT(refusal("a.obj", kTriangle + "l 1 2 3\n"), Contains("only lines"));
  CHECK_THAT(refusal("a.obj", kTriangle + "cstype bspline\ndeg 2 2\nsurf 0 1 0 1 1 2 3\nend\n"),
             Contains("NURBS"));
  CHECK_THAT(refusal("a.obj", kTriangle + "curv 0 1 1 2 3\n"), Contains("NURBS"));
  CHECK_THAT(refusal("a.off", "OFF\n4 0 0\n" + kOffPoints), Contains("only points"));
  CHECK_THAT(refusal("a.ply",
                     "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                     "property float y\nproperty float z\nend_header\n0 0 0\n"),
             Contains("cloud of points"));
  // Beside polygons they are ignored, with a word.
  CHECK_THAT(lossText(read("a.obj", kTriangle + "f 1 2 3\nsurf 0 1 0 1 1 2 3\n").report),
             Contains("ignored 1 free-form curve or surface (on line 5)"));
}

TEST_CASE("UTF-16 is refused as such, a mark of UTF-8 is skipped", "[io][error]") {
  const std::string ascii = kTriangle + "f 1 2 3\n";
  std::string little, big;
  for (const char c : ascii) {
    little += {c, '\0'};
    big += {'\0', c};
  }
  for (const std::string& text : {"\xFF\xFE" + little, "\xFE\xFF" + big, little, big}) {
    CHECK_THAT(refusal("a.obj", text), StartsWith("a.obj:1: the text is UTF-16"));
    CHECK_THAT(refusal("a.off", text), StartsWith("a.off:1: the text is UTF-16"));
    CHECK_THAT(refusal("a.ply", text), StartsWith("a.ply:1: the text is UTF-16"));
    CHECK_THAT(refusal("a.stl", text), Contains("UTF-16"));
  }
  CHECK(polygonsOf(read("a.obj", "\xEF\xBB\xBF" + ascii).mesh) == kOneTriangle);
}

// --- Positions -----------------------------------------------------------------------------------

TEST_CASE("vertices at NaN or infinity are dropped if no face uses them", "[io]") {
  const std::string bad = GENERATE("nan", "-nan", "NaN", "nan(ind)", "-nan(ind)", "inf", "-inf",
                                   "+inf", "Infinity", "1.#INF", "-1.#IND", "1.#QNAN0");
  CAPTURE(bad);
  const auto law = [&](const std::string& file, const std::string& unused, const std::string& used,
                       int line) {
    const Read all = read(file, unused);
    CHECK(all.mesh.faceCount() == 1);
    CHECK(all.mesh.pointCount() == 4);
    CHECK_THAT(lossText(all.report), Contains("dropped 1 vertex at NaN or infinity") &&
                                         Contains("(on line " + std::to_string(line) + ")"));
    CHECK_THAT(refusal(file, used), StartsWith(file + ":" + std::to_string(line) + ": vertex"));
  };
  const std::string obj = "v 0 0 0\nv 0 " + bad + " 0\nv 1 0 0\nv 0 1 0\n";
  law("a.obj", obj + "f 1 3 4\n", obj + "f 1 2 4\n", 2);
  const std::string off = "OFF\n4 1 0\n0 0 0\n0 " + bad + " 0\n1 0 0\n0 1 0\n";
  law("a.off", off + "3 0 2 3\n", off + "3 0 1 3\n", 4);
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty double y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n0 " +
      bad + " 0\n1 0 0\n0 1 0\n";
  law("a.ply", ply + "3 0 2 3\n", ply + "3 0 1 3\n", 11);
}

TEST_CASE("binary vertices at NaN are dropped if no face uses them", "[io][ply]") {
  const auto file = [](std::int32_t second) {
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    for (const float x : {0.F, std::numeric_limits<float>::quiet_NaN(), 1.F, 2.F})
      for (const float number : {x, x * x, 0.F}) append(bytes, number, std::endian::big);
    append(bytes, std::uint8_t{3});
    for (const std::int32_t v : {0, second, 3}) append(bytes, v, std::endian::big);
    return bytes;
  };
  const Read all = read("a.ply", file(2));
  CHECK(lossText(all.report) == "dropped 1 vertex at NaN or infinity that no face uses");
  CHECK(firstOddity(all.report) == "a.ply: vertex at NaN or infinity that no face uses (number 1)");
  CHECK_THAT(refusal("a.ply", file(1)), StartsWith("a.ply: vertex 1 has a coordinate"));
}

// --- OFF -----------------------------------------------------------------------------------------

TEST_CASE("an OFF keyword may be in lower case", "[io][off]") {
  for (const std::string header : {"off\n3 1 0\n", "off 3 1 0\n", "off3 1 0\n"})
    CHECK(polygonsOf(read("a.off", header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").mesh) ==
          Polygons{{0, 1, 2}});
}

TEST_CASE("an OFF keyword may be glued to the counts", "[io][off]") {
  const auto [keyword, more] =
      GENERATE(table<std::string, std::string>({{"OFF", ""},
                                                {"COFF", " 1 0 0 1"},
                                                {"NOFF", " 0 0 1"},
                                                {"STOFF", " 0 0"},
                                                {"CNOFF", " 0 0 1 1 0 0 1"},
                                                {"STCNOFF", " 0 0 1 1 0 0 1 0 0"}}));
  CAPTURE(keyword);
  std::string points;
  for (const char* point : {"0 0 0", "1 0 0", "1 1 0", "0 1 0"}) points += point + more + "\n";
  const Read glued = read("a.off", "# c\n" + keyword + "4 1 0\n" + points + "4 0 1 2 3\n");
  CHECK(polygonsOf(glued.mesh) == Polygons{{0, 1, 2, 3}});
  CHECK(glued.mesh.pointColors.empty() == (keyword.find('C') == keyword.npos));
  CHECK(firstOddity(glued.report) == "a.off:2: keyword without a blank before its number");
  CHECK(firstOddity(read("a.off", keyword + " 4 1 0\n" + points + "4 0 1 2 3\n").report).empty());
}

TEST_CASE("the counts of OFF may stand on several lines", "[io][off]") {
  const std::string counts = GENERATE("OFF\n4 1\n0\n", "OFF 4\n1\n0\n", "OFF\n4 1\n", "4 1 # c\n\n",
                                      "OFF # c\n# c\n4 # c\n1 5\n");
  CAPTURE(counts);
  const Read all = read("a.off", counts + kOffPoints + "4 0 1 2 3\n");
  CHECK(all.mesh.points[3] == Vec3d(0, 1, 0));
  CHECK(polygonsOf(all.mesh) == Polygons{{0, 1, 2, 3}});
}

TEST_CASE("an OFF face may run over several lines", "[io][off]") {
  const std::string face = GENERATE("4 0 3\n2 1\n", "4\n0 3 2 1\n", "4 0\n3\n\n# c\n2 # c\n1\n",
                                    "4 0 3 2\n1 255 0 0\n", "4 0\n3 2 1 0.5 0.5 1 1\n");
  CAPTURE(face);
  const Read all = read("a.off", "OFF\n4 2 0\n" + kOffPoints + face + "3 0 1 2\n");
  CHECK(polygonsOf(all.mesh) == Polygons{{0, 3, 2, 1}, {0, 1, 2}});
  CHECK(firstOddity(all.report) == "a.off:7: face over several lines");
  CHECK(lossText(all.report).empty());
  CHECK(all.mesh.faceColors.empty() == (face.find('5') == face.npos));
}

TEST_CASE("an OFF face that lacks an index does not eat the next face", "[io][off][error]") {
  const std::string start = "OFF\n4 3 0\n" + kOffPoints;
  for (const std::string next : {"3 0 2 3\n", "4 0 1 2 3\n", "3 0 2 3 255 0 0\n"})
    CHECK_THAT(refusal("a.off", start + "4 0 1 2\n" + next + "3 0 1 2\n"),
               StartsWith("a.off:7: face 0 has 3 of 4 indices on its line"));
}

TEST_CASE("short OFF faces and bytes after the last face are dropped and counted", "[io][off]") {
  const Read all = read("a.off", "OFF\n4 5 0\n" + kOffPoints +
                                     "2 0 2\n4 0 1 2 3 255 0 0\n1 3 0 255 0\n0\n3 0 1 2 0 0 255\n"
                                     "more\nof it");
  CHECK(polygonsOf(all.mesh) == Polygons{{0, 1, 2, 3}, {0, 1, 2}});
  checkColors(all.mesh.faceColors, {light(1, 0, 0), light(0, 0, 1)});
  CHECK(lossText(all.report) ==
        "dropped 3 faces of fewer than 3 corners (the first on line 7), "
        "ignored 10 bytes after the last face (the first on line 12)");
}

// --- STL -----------------------------------------------------------------------------------------

namespace {

struct StlFacet {
  std::array<float, 9> corners;
  std::uint16_t attribute = 0;
};

std::string binaryStl(const std::vector<StlFacet>& facets, std::string header = "binary") {
  header.resize(80, ' ');
  append(header, static_cast<std::uint32_t>(facets.size()));
  for (const StlFacet& facet : facets) {
    for (int i = 0; i < 3; ++i) append(header, 0.0F);
    for (const float number : facet.corners) append(header, number);
    append(header, facet.attribute);
  }
  return header;
}

StlFacet facetAt(float z, std::uint16_t attribute = 0) {
  return {{0, 0, z, 1, 0, z, 0, 1, z}, attribute};
}

std::uint16_t fiveBits(unsigned low, unsigned middle, unsigned high, bool top) {
  return static_cast<std::uint16_t>(low | middle << 5U | high << 10U | (top ? 0x8000U : 0U));
}

std::string textFacet(const std::string& vertices) {
  return "facet normal 0 0 1\nouter loop\n" + vertices + "endloop\nendfacet\n";
}

const std::string kStlVertices = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";

}  // namespace

TEST_CASE("bytes after the last STL facet are ignored and counted", "[io][stl]") {
  for (const std::string header : {"binary", "solid or not"}) {
    const Read binary = read("a.stl", binaryStl({facetAt(0)}, header) + std::string("\0\0x", 3));
    CHECK(binary.mesh.faceCount() == 1);
    CHECK(lossText(binary.report) == "ignored 3 bytes after the last face");
    CHECK_THAT(refusal("a.stl", binaryStl({facetAt(0), facetAt(1)}, header).substr(0, 180)),
               Contains("damaged"));
  }
  const std::string text = "solid\n" + textFacet(kStlVertices) + "endsolid\n";
  CHECK(lossText(read("a.stl", text + "more\n").report) ==
        "ignored 5 bytes after the last face (the first on line 10)");
  CHECK(read("a.stl", text + std::string(20, '\0')).mesh.faceCount() == 1);
}

TEST_CASE("STL facets at NaN or infinity are dropped and counted", "[io][stl]") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const Read binary = read(
      "a.stl",
      binaryStl({{{0, 0, nan, 1, 0, 0, 0, 1, 0}}, facetAt(0), {{0, 0, 0, 1, inf, 0, 0, 1, 0}}}));
  CHECK(polygonsOf(binary.mesh) == kOneTriangle);
  CHECK(binary.mesh.pointCount() == 3);
  CHECK(lossText(binary.report) == "dropped 2 facets at NaN or infinity");
  const Read text =
      read("a.stl", "solid\n" + textFacet("vertex 0 0 0\nvertex 1 -nan 0\nvertex 0 1 0\n") +
                        textFacet("vertex 0 0 0\nvertex 1 0 0\n") + textFacet(kStlVertices) +
                        "endsolid\n");
  CHECK(polygonsOf(text.mesh) == kOneTriangle);
  CHECK(lossText(text.report) ==
        "dropped 1 face of fewer than 3 corners (on line 9), "
        "dropped 1 facet at NaN or infinity (on line 2)");
}

TEST_CASE("colours of binary STL follow the program that wrote them", "[io][stl][color]") {
  // VisCAM and SolidView: blue lowest, a colour if the highest bit is set.
  const Read visCam = read("a.stl", binaryStl({facetAt(0, fiveBits(0, 0, 31, true)),
                                               facetAt(1, fiveBits(31, 0, 0, true)),
                                               facetAt(2, fiveBits(31, 31, 0, false))}));
  checkColors(visCam.mesh.faceColors, {light(1, 0, 0), light(0, 0, 1), light(1, 1, 1)});
  // Magics: red lowest, that of the whole if the highest bit is set.
  std::string header = "by someone COLOR=";
  header += std::string("\x00\xff\x33\xff", 4) + ",MATERIAL=";
  const Read magics = read("a.stl", binaryStl({facetAt(0, fiveBits(31, 0, 0, false)),
                                               facetAt(1, fiveBits(0, 31, 31, false)),
                                               facetAt(2, fiveBits(9, 9, 9, true))},
                                              header));
  checkColors(magics.mesh.faceColors, {light(1, 0, 0), light(0, 1, 1), light(0, 1, 0.2)});
  CHECK(lossText(magics.report).empty());
  // Attributes that are 0 are no colours.
  CHECK(read("a.stl", binaryStl({facetAt(0), facetAt(1)})).mesh.faceColors.empty());
}

TEST_CASE("a dropped facet does not shift the colours of the others", "[io][stl][color]") {
  StlFacet lost = facetAt(0, fiveBits(31, 31, 31, true));
  lost.corners[4] = std::numeric_limits<float>::quiet_NaN();
  const Read all = read("a.stl", binaryStl({lost, facetAt(1, fiveBits(0, 31, 0, true))}));
  checkColors(all.mesh.faceColors, {light(0, 1, 0)});
}

TEST_CASE("ascii STL may have no names, odd case and several solids", "[io][stl]") {
  const Read all =
      read("a.stl", "SOLID\r\n" + textFacet(kStlVertices) + "ENDSOLID\r\n\r\nsolid  \n" +
                        textFacet("VERTEX 0 0 1\nvertex 1 0 1\nVertex 0 1 1\n") +
                        "EndSolid name of it\n");
  CHECK(polygonsOf(all.mesh) == Polygons{{0, 1, 2}, {3, 4, 5}});
  CHECK(firstOddity(all.report).empty());
}

// --- PLY -----------------------------------------------------------------------------------------

namespace {

template <typename T>
std::string plyOf(const std::string& format, const std::string& type,
                  const std::array<std::string, 3>& names,
                  const std::vector<std::array<T, 3>>& rgb) {
  std::string bytes = "ply\nformat " + format + " 1.0\nelement vertex 3\nproperty float x\n" +
                      "property float y\nproperty float z\n";
  for (const std::string& name : names) bytes += "property " + type + " " + name + "\n";
  bytes +=
      "property uchar alpha\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::endian order = format == "binary_big_endian" ? std::endian::big : std::endian::little;
  for (std::size_t v = 0; v < 3; ++v) {
    const std::array<float, 3> point = {v == 1 ? 1.F : 0.F, v == 2 ? 1.F : 0.F, 0.F};
    if (format == "ascii") {
      for (const float x : point) bytes += std::to_string(x) + " ";
      for (const T value : rgb[v]) bytes += std::to_string(value) + " ";
      bytes += "9\n";
      continue;
    }
    for (const float x : point) append(bytes, x, order);
    for (const T value : rgb[v]) append(bytes, value, order);
    append(bytes, std::uint8_t{9});
  }
  if (format == "ascii") return bytes + "3 0 1 2\n";
  append(bytes, std::uint8_t{3});
  for (const std::int32_t v : {0, 1, 2}) append(bytes, v, order);
  return bytes;
}

const std::array<std::string, 3> kUsualNames = {"red", "green", "blue"};

template <typename T>
void checkBytesOfType(const std::string& type) {
  CAPTURE(type);
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const std::vector<std::array<T, 3>> rgb = {
        {static_cast<T>(255), static_cast<T>(128), 0}, {0, 1, 0}, {51, 0, static_cast<T>(255)}};
    const Read all = read("a.ply", plyOf<T>(format, type, kUsualNames, rgb));
    checkColors(all.mesh.pointColors,
                {light(1, 128 / 255.0, 0), light(0, 1 / 255.0, 0), light(0.2, 0, 1)});
    CHECK(lossText(all.report).empty());
  }
}

template <typename T>
void checkRangeOfType(const std::string& type, T largest) {
  CAPTURE(type);
  const T half = static_cast<T>(largest / 2);
  const Read all = read("a.ply", plyOf<T>("binary_little_endian", type, kUsualNames,
                                          {{largest, half, 0}, {0, largest, 0}, {0, 0, largest}}));
  const double share = static_cast<double>(half) / static_cast<double>(largest);
  checkColors(all.mesh.pointColors, {light(1, share, 0), light(0, 1, 0), light(0, 0, 1)});
}

}  // namespace

TEST_CASE("PLY colours of any type may be 0 to 255", "[io][ply][color]") {
  checkBytesOfType<std::int8_t>("char");
  checkBytesOfType<std::uint8_t>("uchar");
  checkBytesOfType<std::int16_t>("short");
  checkBytesOfType<std::uint16_t>("ushort");
  checkBytesOfType<std::int32_t>("int");
  checkBytesOfType<std::uint32_t>("uint");
  checkBytesOfType<float>("float");
  checkBytesOfType<double>("double");
}

TEST_CASE("PLY colours that use the range of their type are scaled by it", "[io][ply][color]") {
  checkRangeOfType<std::int16_t>("short", 32767);
  checkRangeOfType<std::uint16_t>("uint16", 65535);
  checkRangeOfType<std::int32_t>("int", 65535);
  checkRangeOfType<std::uint32_t>("uint32", 4294967295U);
  checkRangeOfType<float>("float", 1.0F);
  checkRangeOfType<double>("float64", 255.0);
}

TEST_CASE("colours slightly above 1 are clamped, not taken for bytes", "[io][color]") {
  const double most = GENERATE(1.0001, 1.02, 1.9);
  const Read ply = read("a.ply", plyOf<double>("ascii", "double", kUsualNames,
                                               {{most, 0.5, 0}, {0, 1, 0}, {0, 0, 1}}));
  checkColors(ply.mesh.pointColors, {light(1, 0.5, 0), light(0, 1, 0), light(0, 0, 1)});
  CHECK(lossText(ply.report) == "clamped 1 colour value above full brightness (on line 14)");
  const std::string text = std::to_string(most);
  const Read obj =
      read("a.obj", "v 0 0 0 0 0.5 " + text + "\nv 1 0 0 0 0 1\nv 0 1 0 1 0 0\nf 1 2 3\n");
  checkColors(obj.mesh.pointColors, {light(0, 0.5, 1), light(0, 0, 1), light(1, 0, 0)});
  const Read off = read("a.off", "OFF 4 1 0\n" + kOffPoints + "4 0 1 2 3 " + text + " 0.5 0\n");
  checkColors(off.mesh.faceColors, {light(1, 0.5, 0)});
}

TEST_CASE("PLY colours have several names, of which the most usual counts", "[io][ply][color]") {
  using Names = std::array<std::string, 3>;
  const Names names =
      GENERATE(Names{"r", "g", "b"}, Names{"diffuse_red", "diffuse_green", "diffuse_blue"},
               Names{"R", "G", "B"}, Names{"Red", "Green", "Blue"},
               Names{"diffuse_r", "diffuse_g", "diffuse_b"}, kUsualNames);
  CAPTURE(names[0]);
  const std::vector<std::array<std::uint8_t, 3>> rgb = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
  const std::string file = plyOf<std::uint8_t>("ascii", "uchar", names, rgb);
  checkColors(read("a.ply", file).mesh.pointColors,
              {light(1, 0, 0), light(0, 1, 0), light(0, 0, 1)});
  CHECK(lossText(read("a.ply", file).report).empty());
  for (const char* other : {"ambient_", "specular_"}) {
    const std::string named = plyOf<std::uint8_t>(
        "ascii", "uchar", {other + kUsualNames[0], other + kUsualNames[1], other + kUsualNames[2]},
        rgb);
    CHECK(read("a.ply", named).mesh.pointColors.empty());
  }
  const std::string both =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty uchar diffuse_red\nproperty uchar red\n"
      "property float x\nproperty float y\nproperty float z\nproperty uchar green\n"
      "property uchar g\nproperty uchar blue\nelement face 1\n"
      "property list uchar int vertex_index\nend_header\n";
  const Read all =
      read("a.ply", both + "9 255 0 0 0 0 9 0\n9 0 1 0 0 255 9 0\n9 0 0 1 0 0 9 255\n3 0 1 2\n");
  checkColors(all.mesh.pointColors, {light(1, 0, 0), light(0, 1, 0), light(0, 0, 1)});
}

TEST_CASE("short PLY faces are dropped with their colours", "[io][ply][color]") {
  const Read all =
      read("a.ply",
           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
           "0 0 0\n1 0 0\n0 1 0\n0 255 0 0\n3 0 1 2 0 255 0\n2 0 1 255 0 0\n1 2 255 0 0\n");
  CHECK(polygonsOf(all.mesh) == kOneTriangle);
  checkColors(all.mesh.faceColors, {light(0, 1, 0)});
  CHECK(lossText(all.report) == "dropped 3 faces of fewer than 3 corners (the first on line 16)");
}

// --- What becomes of it
// ----------------------------------------------------------------------------

TEST_CASE("conversion warns of what was lost, and strict refuses every oddity with its place",
          "[io][pipeline]") {
  const test::TemporaryFolder folder;
  const std::string cube =
      "8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
      "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7";
  const auto convertFile = [&](const std::string& content, bool strict) {
    ConvertOptions options;
    options.dim = 8;
    options.strict = strict;
    return convert(readScene(folder.write("a.off", content)), options).report.warnings;
  };
  CHECK(convertFile("OFF\n" + cube + "\n", true).empty());
  CHECK(convertFile("OFF" + cube + "\n", false).empty());
  CHECK_THROWS_WITH(convertFile("OFF" + cube + "\n", true), Contains("a.off:1: keyword without"));
  CHECK(convertFile("OFF\n" + cube + "\nrest", false) ==
        std::vector<std::string>{
            "a: reading its file ignored 4 bytes after the last face (the first on line 17)"});
  CHECK_THROWS_AS(convertFile("OFF\n" + cube + "\nrest", true), InputError);
  CHECK_THROWS_WITH(convertFile("OFF\n" + cube + "\nrest", true),
                    Contains("a.off:17: byte after the last face, which --strict forbids"));
}

TEST_CASE("the grid of colours of an input without colours gives one warning",
          "[pipeline][color]") {
  const test::TemporaryFolder folder;
  const std::string faces = "v 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  const auto warningsOf = [&](const std::string& points) {
    ConvertOptions options;
    options.dim = 8;
    options.grids = std::vector{GridKind::kColor};
    return convert(readScene(folder.write("a.obj", points + faces)), options).report.warnings;
  };
  const std::vector<std::string> warnings = warningsOf(kTriangle);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("no colours"));
  CHECK(warningsOf("v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\n").empty());
}

TEST_CASE("a scale multiplies all coordinates, and the command line wins over the scene",
          "[io][scene]") {
  const std::string object =
      "[[object]]\npoints = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n"
      "transform = { translate = [0, 0, 3] }\n";
  const auto pointsOf = [&](const std::string& key, std::optional<double> scale) {
    return parseScene("a.toml", key + object, scale).objects[0].mesh.points;
  };
  using Points = std::vector<Vec3d>;
  CHECK(pointsOf("", {}) == Points{{0, 0, 3}, {1, 0, 3}, {0, 1, 3}});
  CHECK(pointsOf("scale = 0.5\n", {}) == Points{{0, 0, 1.5}, {0.5, 0, 1.5}, {0, 0.5, 1.5}});
  CHECK(pointsOf("scale = 0.5\n", 1000) == Points{{0, 0, 3000}, {1000, 0, 3000}, {0, 1000, 3000}});
  const SceneObject scaled = parseScene("a.toml", object, 4).objects[0];
  CHECK(scaled.fromWorld * scaled.mesh.points[1] == Vec3d(1, 0, 0));
  CHECK_THROWS_AS(pointsOf("scale = 0\n", {}), InputError);
  CHECK_THROWS_AS(pointsOf("scale = \"mm\"\n", {}), InputError);
  for (const double wrong : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()})
    CHECK_THROWS_AS(pointsOf("", wrong), UsageError);
  CHECK_THROWS_WITH(pointsOf("", 1e16), Contains("beyond 1e15"));
}

}  // namespace read_oddities
