#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/io/input_file.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/read_mesh.h"
#include "libvox/io/text_blocks.h"
#include "tests/mesh_files.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

using namespace vox;
using namespace vox::test;

namespace {

using BlockParser = PolygonMesh (*)(std::string_view, std::size_t, ReadLog&);

constexpr BlockParser kObj = parseObjInBlocks;
constexpr BlockParser kPly = parsePlyInBlocks;
PolygonMesh parseStlBlocks(std::string_view data, std::size_t facets, ReadLog& log) {
  return parseStlInBlocks(data, facets, log);
}

/// Everything that a parser tells, as text: equal texts mean equal bits.
std::string allOf(const PolygonMesh& mesh, const ReadLog& log) {
  std::string all;
  const auto add = [&](const auto& vector) {
    all += std::to_string(vector.size()) + ":";
    for (const auto& element : vector)
      all.append(reinterpret_cast<const char*>(&element), sizeof(element));
  };
  add(mesh.points);
  add(mesh.faceOffsets);
  add(mesh.faceVertices);
  add(mesh.pointColors);
  add(mesh.faceColors);
  add(mesh.faceGroups);
  add(mesh.attributes.texcoords);
  for (const FaceSets* sets :
       {&mesh.attributes.objects, &mesh.attributes.groups, &mesh.attributes.materials}) {
    add(sets->ofFaces);
    for (const std::string& name : sets->names) all += name + "\n";
  }
  for (const auto& [point, line] : log.undefined)
    all += std::to_string(point) + " on " + std::to_string(line) + "\n";
  for (const std::string& file : log.report.materialFiles) all += file + "\n";
  for (const auto& [count, line, element] : log.report.counts)
    all += std::to_string(count) + "," + std::to_string(line) + "," + std::to_string(element) + " ";
  return all;
}

struct Outcome {
  PolygonMesh mesh;
  ReadLog log;
  std::string all;  // or the message of the refusal
};

Outcome parsed(BlockParser parse, std::string_view content, std::size_t blockSize) {
  Outcome outcome{{}, {.report = {.file = "mesh"}}, {}};
  try {
    outcome.mesh = parse(content, blockSize, outcome.log);
    outcome.all = allOf(outcome.mesh, outcome.log);
  } catch (const InputError& error) {
    outcome.all = error.what();
  }
  return outcome;
}

/// Checks that blocks of every size, up to the whole, tell the same. Returns it.
Outcome sameInAllBlocks(BlockParser parse, const std::string& content) {
  Outcome whole = parsed(parse, content, content.size() + 1);
  for (std::size_t size = 1; size <= content.size(); ++size) {
    CAPTURE(size);
    REQUIRE(parsed(parse, content, size).all == whole.all);
  }
  return whole;
}

std::string withLineEnds(std::string text, const std::string& lineEnd) {
  for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + lineEnd.size()))
    text.replace(at, 1, lineEnd);
  return text;
}

std::uint64_t countOf(const Outcome& outcome, Oddity oddity) {
  return outcome.log.report[oddity].count;
}
std::size_t lineOf(const Outcome& outcome, Oddity oddity) {
  return outcome.log.report[oddity].line;
}

/// A strip of triangles over two rows of points.
std::string objStrip(int columns) {
  std::string text;
  for (int i = 0; i < columns; ++i)
    text += "v " + std::to_string(i) + " 0 0\nv " + std::to_string(i) + " 1 0\n";
  for (int i = 0; i + 1 < columns; ++i)
    text += "f " + std::to_string(2 * i + 1) + " " + std::to_string(2 * i + 3) + " " +
            std::to_string(2 * i + 2) + "\n";
  return text;
}

}  // namespace

// --- Lines -------------------------------------------------------------------------------------

TEST_CASE("blocks of lines are the text, cut only where a line surely ends", "[io]") {
  const std::string text = "a\nbb\r\nc\rd\\\nd\n\n\\\r\ne\r\r\nlast";
  for (std::size_t size = 1; size <= text.size() + 1; ++size) {
    CAPTURE(size);
    std::string joined;
    std::size_t lineEnds = 0;
    const auto blocks = lineBlocks(text, size);
    for (const std::string_view block : blocks) {
      joined += block;
      lineEnds += lineEndCount(block);
      if (joined.size() == text.size()) break;
      CHECK(block.size() >= size);
      CHECK((block.back() == '\n' || block.back() == '\r'));
      CHECK_FALSE((block.back() == '\r' && text[joined.size()] == '\n'));
      CHECK_FALSE(joined.ends_with("\\\n"));
      CHECK_FALSE(joined.ends_with("\\\r\n"));
    }
    CHECK(joined == text);
    CHECK(lineEnds == 9);
  }
  CHECK(lineBlocks("", 1).empty());
}

// --- OBJ ---------------------------------------------------------------------------------------

TEST_CASE("OBJ blocks of every size give the same mesh and the same oddities", "[io][obj]") {
  const std::string lineEnd = GENERATE("\n", "\r\n", "\r");
  const std::string last = GENERATE("f 1 2 7\n", "f 1 2 7");
  const std::string text =
      "mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\n"
      "f 1/1 2/2 3/-1\nusemtl red\nv 0 0 1 # on top\ng up\\\nf -1 -5 -4\n"
      "s 2\nf 1 \\\n  2 5\nf 1 2\nusemtl blue\no box\nv nan 0 0\n"
      "f 7 1 3/2\ns off\nusemtl red\nv 0 0 2\nvt 5 6\nf 3/-1 2/3 -1\n"
      "curv 1\nf 1 2 3#glued\n" +
      last;
  const Outcome whole = sameInAllBlocks(kObj, withLineEnds(text, lineEnd));

  CHECK(polygonsOf(whole.mesh) ==
        Polygons{{0, 1, 2}, {4, 0, 1}, {0, 1, 4}, {6, 0, 2}, {2, 1, 6}, {0, 1, 2}, {0, 1, 6}});
  CHECK(whole.mesh.pointCount() == 7);
  CHECK(whole.mesh.points[6] == Vec3d(0, 0, 2));
  CHECK(whole.mesh.faceGroups == std::vector<std::uint32_t>{0, 0, 2, 2, 0, 0, 0});
  const MeshAttributes& attributes = whole.mesh.attributes;
  CHECK(attributes.materials.names == std::vector<std::string>{"red", "blue"});
  CHECK(attributes.materials.ofFaces == std::vector<Index>{kNone, 0, 0, 1, 0, 0, 0});
  CHECK(attributes.groups.names == std::vector<std::string>{"up\\"});
  CHECK(attributes.groups.ofFaces == std::vector<Index>{kNone, 0, 0, 0, 0, 0, 0});
  CHECK(attributes.objects.ofFaces == std::vector<Index>{kNone, kNone, kNone, 0, 0, 0, 0});
  REQUIRE(attributes.texcoords.size() == 21);
  CHECK(attributes.texcoords[2] == Vec2f(1, 0));
  CHECK(attributes.texcoords[11] == Vec2f(1, 0));
  CHECK(attributes.texcoords[12] == Vec2f(5, 6));
  CHECK(std::isnan(attributes.texcoords[3][0]));
  REQUIRE(whole.mesh.pointColors.size() == 7);
  CHECK(whole.mesh.pointColors[0] == Vec3f(1, 0, 0));
  CHECK(whole.mesh.pointColors[6] == Vec3f(1, 1, 1));
  CHECK(whole.log.report.materialFiles == std::vector<std::string>{"a.mtl"});
  REQUIRE(whole.log.undefined.size() == 1);
  CHECK(whole.log.undefined[0].point == 5);
  CHECK(whole.log.undefined[0].line == 19);
  CHECK(countOf(whole, Oddity::kShortFace) == 1);
  CHECK(lineOf(whole, Oddity::kShortFace) == 16);
  CHECK(lineOf(whole, Oddity::kBackslashName) == 11);
  CHECK(lineOf(whole, Oddity::kFreeForm) == 26);
  CHECK(lineOf(whole, Oddity::kGluedComment) == 27);
}

TEST_CASE("a continued line may end with an empty one, in OBJ blocks of every size", "[io][obj]") {
  const std::string content =
      "v 0 0 0\nvn 0 0 1 \\\n\nv 1 0 0\nl 1 2 \\\n# \\\nv 0 1 0\ns 1 \\\n\\\n\nf 1 2 3\nf 1 2 4\n";
  for (const char* lineEnd : {"\n", "\r\n", "\r"}) {
    const Outcome outcome = sameInAllBlocks(kObj, withLineEnds(content, lineEnd));
    CHECK(outcome.all.find("mesh:12: ") == 0);  // three vertices before it
  }
}

TEST_CASE("OBJ blocks of every size name the first error by its line", "[io][obj][error]") {
  const std::string start = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const auto& [rest, message] : std::vector<std::array<std::string, 2>>{
           {"v 1 2\nf 1 2 x\n", "mesh:5: vertex with 2 numbers"},
           {"f 1 2 3\nf 1 2 -4\nv 0 0\n", "mesh:6: index -4 reaches before the first vertex; 3"},
           {"f 1 2 9\nf 1 2 3\nv 0 0 1\n", "mesh:5: index 9 is out of range; the file has 4"},
           {"f 1 2 9\nf 1 2 3\nv 0 0\n", "mesh:7: vertex with 2 numbers"},
           {"\\\n\\\nf 1 2 0", "mesh:7: index 0"}}) {
    CAPTURE(rest);
    CHECK_THAT(sameInAllBlocks(kObj, start + rest).all, Catch::StartsWith(message));
  }
}

TEST_CASE("OBJ texture coordinates that do not exist are counted in blocks of every size",
          "[io][obj]") {
  const Outcome whole = sameInAllBlocks(
      kObj, kTriangle + "vt 0 0\nf 1/1 2/2 3/9\nvt 1 1\nf 1/-3 2/0 3/-1\nvt nan 0\nf 1 2 3/1\n");
  CHECK(countOf(whole, Oddity::kUndefinedTexcoord) == 4);
  CHECK(lineOf(whole, Oddity::kUndefinedTexcoord) == 7);
}

TEST_CASE("OBJ colours in comments keep their order in blocks of every size", "[io][obj][color]") {
  const Outcome whole = sameInAllBlocks(
      kObj, "#MRGB ffff0000ff00ff00\n" + kTriangle + "f 1 2 3\n#MRGB zz\n#MRGB ff0000ff\n");
  CHECK(whole.mesh.pointColors == std::vector<Vec3f>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  CHECK(lineOf(whole, Oddity::kDamagedColors) == 6);
}

TEST_CASE("an error in the last line of a large text names that line", "[io][error]") {
  constexpr int kColumns = 40000;
  const std::string obj = objStrip(kColumns);
  const auto lines = static_cast<std::size_t>(std::count(obj.begin(), obj.end(), '\n'));
  const std::string line = std::to_string(lines + 1);
  CHECK_THAT(parsed(kObj, obj + "f 1 2 x", 1 << 16).all, Catch::StartsWith("mesh:" + line + ":"));
  CHECK_THAT(parsed(kObj, withLineEnds(obj, "\r\n") + "f 1 2 99999999", 1 << 16).all,
             Catch::StartsWith("mesh:" + line + ": index 99999999"));

  std::string ply = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(kColumns) +
                    "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                    "property list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < kColumns; ++i) ply += std::to_string(i) + " 0 1\n";
  const std::string faceLine = std::to_string(kColumns + 10);
  CHECK_THAT(parsed(kPly, ply + "3 0 1 z", 1 << 16).all,
             Catch::StartsWith("mesh:" + faceLine + ":"));
  const Outcome sound = parsed(kPly, ply + "3 0 1 39999", 1 << 16);
  CHECK(polygonsOf(sound.mesh) == Polygons{{0, 1, 39999}});
  CHECK(sound.mesh.points[39999] == Vec3d(39999, 0, 1));
}

TEST_CASE("very long lines are read whole", "[io][obj]") {
  constexpr Index kCorners = 100000;
  std::string text = "# " + std::string(500000, 'x') + "\n";
  std::string face = "f";
  for (Index v = 0; v < kCorners; ++v) {
    text += "v " + std::to_string(v) + " 0 0\n";
    face += (v % 1000 == 0 ? " \\\n" : " ") + std::to_string(v + 1);
  }
  const Outcome outcome = parsed(kObj, text + face + "\nf 1 2 3", 1 << 12);
  REQUIRE(outcome.mesh.faceCount() == 2);
  CHECK(outcome.mesh.faceSize(0) == kCorners);
  CHECK(outcome.mesh.face(0)[kCorners - 1] == kCorners - 1);
}

TEST_CASE("any number of threads reads the same mesh", "[io][parallel]") {
  const std::string obj = objStrip(3000);
  const auto read = [&](int threads) {
    return onThreads(threads, [&] { return parsed(kObj, obj, 1000).all; });
  };
  CHECK(read(1) == read(8));
}

// --- PLY ---------------------------------------------------------------------------------------

namespace {

std::string plyHeader(const std::string& format, std::size_t vertices, std::size_t faces,
                      const std::string& ofVertices = "", const std::string& ofFaces = "") {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\n" + ofVertices + "element face " +
         std::to_string(faces) + "\nproperty list uchar int vertex_indices\n" + ofFaces +
         "end_header\n";
}

/// Vertices at (0, 0, 0), (1, 0, 0), ... and the polygons.
std::string binaryPly(std::endian order, std::size_t vertices, const Polygons& polygons) {
  std::string ply =
      plyHeader(order == std::endian::little ? "binary_little_endian" : "binary_big_endian",
                vertices, polygons.size());
  for (std::size_t v = 0; v < vertices; ++v)
    for (const float x : {static_cast<float>(v), 0.0F, 0.0F}) append(ply, x, order);
  for (const auto& polygon : polygons) {
    append(ply, static_cast<std::uint8_t>(polygon.size()), order);
    for (const Index v : polygon) append(ply, static_cast<std::int32_t>(v), order);
  }
  return ply;
}

}  // namespace

TEST_CASE("binary PLY faces of one size or several are the same in blocks of every size",
          "[io][ply]") {
  const std::endian order = GENERATE(std::endian::little, std::endian::big);
  const Polygons polygons = GENERATE(Polygons{{0, 1, 2}, {2, 1, 3}, {3, 4, 5}, {5, 4, 0}},
                                     Polygons{{0, 1, 2}, {2, 1, 3, 4}, {3, 4, 5}, {5, 4, 3, 1, 0}});
  const Outcome whole = sameInAllBlocks(kPly, binaryPly(order, 6, polygons));
  CHECK(polygonsOf(whole.mesh) == polygons);
  REQUIRE(whole.mesh.pointCount() == 6);
  for (int v = 0; v < 6; ++v) CHECK(whole.mesh.points[static_cast<Index>(v)] == Vec3d(v, 0, 0));
}

TEST_CASE("short faces of binary PLY are dropped in blocks of every size", "[io][ply]") {
  const Outcome whole = sameInAllBlocks(
      kPly, binaryPly(std::endian::little, 5, {{0, 1, 2}, {3, 4}, {1, 2, 3}, {}, {2, 3, 4}}));
  CHECK(polygonsOf(whole.mesh) == Polygons{{0, 1, 2}, {1, 2, 3}, {2, 3, 4}});
  CHECK(countOf(whole, Oddity::kShortFace) == 2);
  CHECK(whole.log.report[Oddity::kShortFace].element == 1);
}

TEST_CASE("damaged binary PLY names its element in blocks of every size", "[io][ply][error]") {
  const Polygons polygons = {{0, 1, 2}, {2, 1, 3}, {3, 2, 9}, {3, 2, 7}};
  const std::string ply = binaryPly(std::endian::little, 4, polygons);
  CHECK(sameInAllBlocks(kPly, ply).all == "mesh: face 2 refers to vertex 9 of 4 (numbered from 0)");
  CHECK(sameInAllBlocks(kPly, ply.substr(0, ply.size() - 30)).all ==
        "mesh: truncated: ends within face 1 of 4");
  std::string far = binaryPly(std::endian::little, 4, {{0, 1, 2}});
  std::string number;
  append(number, 1e16F);
  far.replace(far.find("end_header\n") + 11 + 3 * 12 + 4, 4, number);
  CHECK_THAT(sameInAllBlocks(kPly, far).all,
             Catch::StartsWith("mesh: vertex 3: coordinate y is larger than 1e15"));
}

TEST_CASE("colours and texture coordinates of PLY are the same in blocks of every size",
          "[io][ply][color]") {
  const bool isText = GENERATE(true, false);
  std::string ply = plyHeader(isText ? "ascii" : "binary_little_endian", 4, 3,
                              "property uchar r\nproperty uchar g\nproperty uchar b\n",
                              "property list uchar float texcoord\nproperty uchar red\n"
                              "property uchar green\nproperty uchar blue\n");
  const auto addFloat = [&](float x) {
    isText ? void(ply += std::to_string(x) + " ") : append(ply, x);
  };
  const auto addByte = [&](int x) {
    isText ? void(ply += std::to_string(x) + " ") : append(ply, static_cast<std::uint8_t>(x));
  };
  const auto addIndex = [&](int x) {
    isText ? void(ply += std::to_string(x) + " ") : append(ply, static_cast<std::int32_t>(x));
  };
  const auto endLine = [&] { ply += isText ? "\n" : ""; };
  for (int v = 0; v < 4; ++v) {
    for (const int x : {v, v * v, 1}) addFloat(static_cast<float>(x));
    for (const int c : {255 * (v % 2), 0, 255}) addByte(c);
    endLine();
  }
  for (int f = 0; f < 3; ++f) {
    addByte(3);
    for (int i = 0; i < 3; ++i) addIndex((f + i) % 4);
    addByte(f == 1 ? 6 : 0);
    for (int i = 0; i < (f == 1 ? 6 : 0); ++i) addFloat(static_cast<float>(i));
    for (const int c : {0, 255 * (f % 2), 0}) addByte(c);
    endLine();
  }
  const Outcome whole = sameInAllBlocks(kPly, ply);
  CHECK(polygonsOf(whole.mesh) == Polygons{{0, 1, 2}, {1, 2, 3}, {2, 3, 0}});
  CHECK(whole.mesh.pointColors == std::vector<Vec3f>{{0, 0, 1}, {1, 0, 1}, {0, 0, 1}, {1, 0, 1}});
  CHECK(whole.mesh.faceColors == std::vector<Vec3f>{{0, 0, 0}, {0, 1, 0}, {0, 0, 0}});
  REQUIRE(whole.mesh.attributes.texcoords.size() == 9);
  CHECK(std::isnan(whole.mesh.attributes.texcoords[2][0]));
  CHECK(whole.mesh.attributes.texcoords[3] == Vec2f(0, 1));
  CHECK(whole.mesh.attributes.texcoords[5] == Vec2f(4, 5));
  CHECK(countOf(whole, Oddity::kForeignColor) == 1);
}

TEST_CASE("ascii PLY that wraps lines is the same in blocks of every size", "[io][ply]") {
  const std::string lineEnd = GENERATE("\n", "\r\n", "\r");
  const Outcome whole = sameInAllBlocks(
      kPly, withLineEnds(plyHeader("ascii", 3, 2) + "0 0 0\n\n1 0\n0\n0 1 nan\n3 0 1\n2\n3 2 1 0\n",
                         lineEnd));
  CHECK(polygonsOf(whole.mesh) == Polygons{{0, 1, 2}, {2, 1, 0}});
  REQUIRE(whole.log.undefined.size() == 1);
  CHECK(whole.log.undefined[0].line == 14);
}

// --- STL ---------------------------------------------------------------------------------------

TEST_CASE("binary STL welds the same in blocks of every size", "[io][stl]") {
  constexpr std::uint32_t kFacets = 300;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  std::string stl(80, ' ');
  append(stl, kFacets);
  const auto less = [](const Vec3d& a, const Vec3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::map<Vec3d, Index, decltype(less)> numbers(less);
  std::vector<Vec3d> points;
  Polygons polygons;
  std::uint32_t state = 1;
  const auto next = [&] { return state = state * 1664525U + 1013904223U; };
  for (std::uint32_t f = 0; f < kFacets; ++f) {
    const bool isDropped = f % 7 == 6 || f + 1 == kFacets;
    for (int i = 0; i < 3; ++i) append(stl, 0.0F);
    std::vector<Index> polygon;
    for (int i = 0; i < 3; ++i) {
      Vec3d point;
      for (double& x : point) x = std::array<double, 4>{-0.0, 0.0, 1.5, -2}[next() >> 30U];
      if (isDropped && i == 1) point[2] = static_cast<double>(kNan);
      for (const double x : point) append(stl, static_cast<float>(x));
      if (isDropped) continue;
      const auto [known, isNew] = numbers.try_emplace(point, static_cast<Index>(points.size()));
      if (isNew) points.push_back(point);
      polygon.push_back(known->second);
    }
    if (!isDropped) polygons.push_back(polygon);
    append(stl, static_cast<std::uint16_t>(f % 5 == 0 ? 0x8000U + f : 0U));
  }
  const Outcome whole = parsed(parseStlBlocks, stl, kFacets);
  CHECK(polygonsOf(whole.mesh) == polygons);
  REQUIRE(whole.mesh.points.size() == points.size());
  CHECK(std::memcmp(whole.mesh.points.data(), points.data(), points.size() * sizeof(Vec3d)) == 0);
  CHECK(countOf(whole, Oddity::kUndefinedFacet) == kFacets - polygons.size());
  CHECK(whole.log.report[Oddity::kUndefinedFacet].element == 6);
  for (std::size_t size = 1; size < kFacets; ++size) {
    CAPTURE(size);
    REQUIRE(parsed(parseStlBlocks, stl, size).all == whole.all);
  }
}

// --- Files -------------------------------------------------------------------------------------

TEST_CASE("a file larger than a block of reading arrives whole", "[io]") {
  const TemporaryFolder folder;
  std::string content;
  for (std::uint32_t i = 0; i < 2500000; ++i) append(content, i);
  const FileContent read = contentsOf(folder.write("numbers.bin", content));
  CHECK(std::string_view(read) == content);
}
