#include "libvox/core/error.h"
#include "libvox/core/image.h"
#include "libvox/io/read_mesh.h"
#include "libvox/io/scene_file.h"
#include "libvox/io/write_png.h"
#include "libvox/mesh/area_vector.h"
#include "tests/gltf_files.h"
#include "tests/temporary_folder.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace vox;
using namespace vox::test;
using Catch::Contains;
using Catch::StartsWith;

namespace {

constexpr int kByte = 5120, kUbyte = 5121, kShort = 5122, kUshort = 5123, kUint = 5125,
              kFloat = 5126;

const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<float> kTetrahedron = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
const std::vector<std::uint8_t> kTetrahedronFaces = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};

PolygonMesh parse(const std::string& content, ReadReport& report) {
  return parseMesh("a.glb", content, report);
}
PolygonMesh parse(const std::string& content) {
  ReadReport report;
  return parse(content, report);
}

std::string refusalOf(const std::string& content) {
  try {
    parse(content);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::vector<std::vector<double>> rows(const std::vector<Vec3d>& points) {
  std::vector<std::vector<double>> all;
  for (const Vec3d& p : points) all.push_back({p[0], p[1], p[2]});
  return all;
}

double volumeOf(const PolygonMesh& mesh) {
  double six = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto at = [&](int i) { return mesh.points[mesh.face(f)[static_cast<std::size_t>(i)]]; };
    six += at(0).cross(at(1)).dot(at(2));
  }
  return six / 6;
}

std::string smallPng() {
  std::ostringstream stream;
  writePng(stream, Image(2, 2));
  return stream.str();
}

/// A triangle with a material and what the material refers to.
GltfBuffer texturedTriangle() {
  GltfBuffer buffer;
  buffer.add<float>(kFloat, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  buffer.add<float>(kFloat, 2, {0, 0, 1, 0, 0, 0.75F});
  buffer.addBytes(smallPng());
  return buffer;
}
std::string materialFile(const std::string& material, const std::string& more) {
  return oneMesh(R"("attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0)") +
         ",\"materials\":[{" + material + "}]" + more;
}
const std::string kTexture =
    R"("pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,0.75],"baseColorTexture":{"index":0)";
const std::string kImage = R"(,"textures":[{"source":0}],"images":[{"bufferView":2}])";

}  // namespace

TEST_CASE("glTF indices of every type, strips and fans give the triangles that they stand for",
          "[io][gltf]") {
  const Polygons expected = {{0, 1, 2}, {0, 2, 3}};
  const std::string list = oneMesh(R"("attributes":{"POSITION":0},"indices":1)");
  GltfBuffer bytes, shorts, ints, strip, fan, plain, degenerate;
  for (GltfBuffer* buffer : {&bytes, &shorts, &ints, &strip, &fan, &plain, &degenerate})
    buffer->add(kFloat, 3, kSquare);
  bytes.add<std::uint8_t>(kUbyte, 1, {0, 1, 2, 0, 2, 3});
  shorts.add<std::uint16_t>(kUshort, 1, {0, 1, 2, 0, 2, 3});
  ints.add<std::uint32_t>(kUint, 1, {0, 1, 2, 0, 2, 3});
  for (const GltfBuffer* buffer : {&bytes, &shorts, &ints}) {
    CHECK(polygonsOf(parse(buffer->binary(list))) == expected);
    CHECK(polygonsOf(parse(buffer->text(list))) == expected);
    CHECK(rows(parse(buffer->binary(list)).points) == rows(parse(buffer->text(list)).points));
  }
  strip.add<std::uint8_t>(kUbyte, 1, {1, 2, 0, 3});
  CHECK(polygonsOf(
            parse(strip.binary(oneMesh(R"("attributes":{"POSITION":0},"indices":1,"mode":5)")))) ==
        Polygons{{1, 2, 0}, {2, 3, 0}});
  // Corners that come twice join two strips.
  degenerate.add<std::uint8_t>(kUbyte, 1, {0, 1, 2, 2, 0, 0, 0, 2, 3});
  CHECK(polygonsOf(parse(
            degenerate.binary(oneMesh(R"("attributes":{"POSITION":0},"indices":1,"mode":5)")))) ==
        Polygons{{0, 1, 2}, {0, 2, 3}});
  CHECK(polygonsOf(parse(fan.binary(oneMesh(R"("attributes":{"POSITION":0},"mode":6)")))) ==
        Polygons{{1, 2, 0}, {2, 3, 0}});
  ReadReport report;
  CHECK(polygonsOf(parse(plain.binary(oneMesh(R"("attributes":{"POSITION":0})")), report)) ==
        kOneTriangle);  // the fourth point is none
  CHECK(lossText(report) == "dropped 1 face of fewer than 3 corners");
}

TEST_CASE("glTF arrays may be interleaved, shared, and of small integers", "[io][gltf]") {
  std::string bytes(4, 'x');
  for (int i = 0; i < 3; ++i) {
    for (const int axis : {0, 1, 2}) append(bytes, static_cast<float>(10 * i + axis));
    append(bytes, static_cast<std::uint16_t>(65535 * (i % 2)));
    append(bytes, static_cast<std::uint16_t>(13107 * i));
  }
  GltfBuffer buffer;
  buffer.addBytes(bytes, ",\"byteStride\":16");
  buffer.addAccessor(
      R"("bufferView":0,"byteOffset":4,"componentType":5126,"count":3,"type":"VEC3")");
  buffer.addAccessor(
      R"("bufferView":0,"byteOffset":16,"componentType":5123,"count":3,"type":"VEC2","normalized":true)");
  const PolygonMesh mesh = parse(buffer.binary(
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[)"
      R"({"attributes":{"POSITION":0,"TEXCOORD_0":1}},{"attributes":{"POSITION":0}}]}])"));
  CHECK(rows(mesh.points) ==
        std::vector<std::vector<double>>{{0, 1, 2}, {10, 11, 12}, {20, 21, 22}});
  CHECK(polygonsOf(mesh) == Polygons{{0, 1, 2}, {0, 1, 2}});
  REQUIRE(mesh.attributes.texcoords.size() == 6);
  CHECK(mesh.attributes.texcoords[1].isApprox(Vec2f(1, 0.8F)));  // v goes up
  CHECK(mesh.attributes.texcoords[2].isApprox(Vec2f(0, 0.6F)));
  CHECK(std::isnan(mesh.attributes.texcoords[3][0]));

  GltfBuffer small;
  small.add<std::int8_t>(kByte, 3, {0, 0, 0, 127, 0, 0, 0, -128, 0}, ",\"normalized\":true");
  small.add<std::int16_t>(kShort, 3, {0, 0, 0, 5, 0, 0, 0, -7, 0});
  const std::string required = ",\"extensionsRequired\":[\"KHR_mesh_quantization\"]";
  CHECK(rows(parse(small.binary(oneMesh("\"attributes\":{\"POSITION\":0}") + required)).points) ==
        std::vector<std::vector<double>>{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}});
  CHECK(rows(parse(small.binary(oneMesh("\"attributes\":{\"POSITION\":1}") + required)).points) ==
        std::vector<std::vector<double>>{{0, 0, 0}, {5, 0, 0}, {0, -7, 0}});
}

TEST_CASE("glTF colours are linear, of any type", "[io][gltf]") {
  const std::string rest = oneMesh(R"("attributes":{"POSITION":0,"COLOR_0":1})");
  const auto colorOf = [&](const GltfBuffer& buffer) { return parse(buffer.binary(rest)); };
  const auto make = [&](auto&& add) {
    GltfBuffer buffer;
    buffer.add<float>(kFloat, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
    add(buffer);
    return colorOf(buffer).pointColors;
  };
  for (const std::vector<Vec3f>& colors : {
           make([](GltfBuffer& b) {
             b.add<float>(kFloat, 3, {0.2F, 0.4F, 1, 0, 0, 0, 1, 1, 1});
           }),
           make([](GltfBuffer& b) {
             b.add<float>(kFloat, 4, {0.2F, 0.4F, 1, 0.5F, 0, 0, 0, 1, 1, 1, 1, 1});
           }),
           make([](GltfBuffer& b) {
             b.add<std::uint8_t>(kUbyte, 4, {51, 102, 255, 0, 0, 0, 0, 9, 255, 255, 255, 1},
                                 ",\"normalized\":true");
           }),
           make([](GltfBuffer& b) {
             b.add<std::uint16_t>(kUshort, 3, {13107, 26214, 65535, 0, 0, 0, 65535, 65535, 65535},
                                  ",\"normalized\":true");
           }),
       }) {
    REQUIRE(colors.size() == 3);
    CHECK(colors[0].isApprox(Vec3f(0.2F, 0.4F, 1)));
    CHECK(colors[1] == Vec3f::Zero());
    CHECK(colors[2] == Vec3f::Ones());
  }
}

TEST_CASE("glTF nodes place their meshes; mirrors keep the outside outside", "[io][gltf]") {
  GltfBuffer buffer;
  buffer.add(kFloat, 3, kTetrahedron);
  buffer.add(kUbyte, 1, kTetrahedronFaces);
  buffer.add<float>(kFloat, 2, {0, 0.5F, 0.25F, 0.5F, 0.5F, 0.5F, 0.75F, 0.5F});
  const std::string mesh =
      R"(,"meshes":[{"name":"tip","primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1}]}])";
  // A turn of 90 degrees about z, after a scale; then the parent's shift and mirror.
  const std::string turned = R"({"mesh":0,"name":"wing","translation":[10,0,0],)"
                             R"("rotation":[0,0,0.7071067811865476,0.7071067811865476],)"
                             R"("scale":[2,3,4]})";
  const std::string parent = R"({"children":[1],"matrix":[1,0,0,0, 0,1,0,0, 0,0,-1,0, 0,0,5,1]})";
  const PolygonMesh placed = parse(buffer.binary("\"scenes\":[{\"nodes\":[0]}],\"nodes\":[" +
                                                 parent + "," + turned + "]" + mesh));
  REQUIRE(placed.pointCount() == 4);
  CHECK((placed.points[0] - Vec3d(10, 0, 5)).norm() < 1e-12);
  CHECK((placed.points[1] - Vec3d(10, 2, 5)).norm() < 1e-12);
  CHECK((placed.points[2] - Vec3d(7, 0, 5)).norm() < 1e-12);
  CHECK((placed.points[3] - Vec3d(10, 0, 1)).norm() < 1e-12);
  CHECK(volumeOf(placed) == Approx(24.0 / 6));      // not -24 / 6: it is mirrored
  for (Index c = 0; c < placed.cornerCount(); ++c)  // u is a quarter of the number of the vertex
    CHECK(placed.attributes.texcoords[c][0] == 0.25F * static_cast<float>(placed.faceVertices[c]));

  // A mesh in several nodes; names come once. Nodes of other scenes stay out.
  const std::string several =
      R"("scene":1,"scenes":[{"nodes":[3]},{"nodes":[0,1,2]}],"nodes":[{"mesh":0,"name":"a"},)"
      R"({"mesh":0,"name":"a","scale":[-1,1,1]},{"mesh":0,"translation":[0,0,3]},{"mesh":0}])";
  const PolygonMesh three = parse(buffer.binary(several + mesh));
  CHECK(three.faceCount() == 12);
  CHECK(three.pointCount() == 9);  // the second is a mirror image: three of its places are taken
  CHECK(volumeOf(three) == Approx(3.0 / 6));
  CHECK(three.attributes.objects.names == std::vector<std::string>{"a", "a 2", "tip"});
  CHECK(three.attributes.objects.ofFaces == std::vector<Index>{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2});
  const std::string all =
      R"("scenes":[{"nodes":[0]},{"nodes":[0,1]}],"nodes":[{"mesh":0},{"mesh":0}])";
  CHECK(parse(buffer.binary(all + mesh)).faceCount() == 8);
}

TEST_CASE("glTF materials give base colours and images", "[io][gltf]") {
  const GltfBuffer buffer = texturedTriangle();
  const auto lookOf = [&](const std::string& material, const std::string& more = kImage) {
    ReadReport report;
    const PolygonMesh mesh = parse(buffer.binary(materialFile(material, more)), report);
    for (const std::string& problem : report.materialProblems) UNSCOPED_INFO(problem);
    CHECK(report.materialProblems.empty());
    REQUIRE(mesh.attributes.looks.size() == 1);
    CHECK(mesh.attributes.materials.ofFaces == std::vector<Index>{0});
    return mesh.attributes.looks[0];
  };
  const Material look = lookOf("\"name\":\"skin\"," + kTexture + "}}");
  CHECK(look.name == "skin");
  CHECK(look.color == Vec3f(0.5F, 0.25F, 1));
  CHECK(look.opacity == 1);
  CHECK(look.multiplies);
  REQUIRE(look.image);
  CHECK(look.image->file == "a.glb: images[0]");
  CHECK(*look.image->content == smallPng());
  CHECK(look.image->opaque);
  CHECK_FALSE(look.image->clamp);
  for (const char* mode : {"BLEND", "MASK"}) {
    const Material clear = lookOf("\"alphaMode\":\"" + std::string(mode) + "\"," + kTexture + "}}");
    CHECK(clear.opacity == 0.75);
    CHECK_FALSE(clear.image->opaque);
  }
  const std::string clamped =
      R"(,"textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":33071,"wrapT":33071}])";
  const std::string uri = ",\"images\":[{\"uri\":\"data:image/png;base64," + base64Of(smallPng());
  const Material second = lookOf(kTexture + "}}", clamped + uri + "\"}]");
  CHECK(second.image->clamp);
  CHECK(*second.image->content == smallPng());
  const Material beside =
      lookOf(kTexture + "}}", clamped + R"(,"images":[{"uri":"an%20image.png"}])");
  CHECK(beside.image->file == "an image.png");
  CHECK_FALSE(beside.image->content);

  // The place in the image, from its upper left corner: offset + scale * (u, v).
  const Material moved = lookOf(
      kTexture + R"(,"extensions":{"KHR_texture_transform":{"offset":[0.1,0.2],"scale":[2,3]}}}})");
  const Vec2d uv(0.3, 0.4);
  const Vec2d fromBelow(uv[0], 1 - uv[1]);
  const Vec2d place = fromBelow.cwiseProduct(moved.image->scale) + moved.image->offset;
  CHECK(place[0] == Approx(0.1 + 2 * uv[0]));
  CHECK(1 - place[1] == Approx(0.2 + 3 * uv[1]));
}

TEST_CASE("images of glTF in one place are stored once", "[io][gltf]") {
  GltfBuffer buffer = texturedTriangle();
  buffer.add<float>(kFloat, 3, {0, 0, 1, 1, 0, 1, 0, 1, 1});
  const auto primitive = [](const char* points, const char* material) {
    return std::string("{\"attributes\":{\"POSITION\":") + points +
           ",\"TEXCOORD_0\":1},\"material\":" + material + "}";
  };
  const std::string more =
      "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{"
      "\"primitives\":[" +
      primitive("0", "0") + "," + primitive("2", "1") + "]}],\"materials\":[{" + kTexture +
      "}}},{" +
      R"("pbrMetallicRoughness":{"baseColorTexture":{"index":1}}}],)"
      R"("textures":[{"source":0},{"source":1}],"images":[{"bufferView":2},{"bufferView":2}])";
  const std::vector<Material> looks = parse(buffer.binary(more)).attributes.looks;
  REQUIRE(looks.size() == 2);
  CHECK(looks[0].image->file == "a.glb: images[0]");
  CHECK(looks[1].image->file == "a.glb: images[1]");
  CHECK(looks[0].image->content == looks[1].image->content);
  CHECK(*looks[0].image->content == smallPng());
}

TEST_CASE("what is wrong with a glTF material is told, and the mesh is read", "[io][gltf]") {
  const GltfBuffer buffer = texturedTriangle();
  const auto problemOf = [&](const std::string& material, const std::string& more = kImage) {
    ReadReport report;
    const PolygonMesh mesh = parse(buffer.binary(materialFile(material, more)), report);
    CHECK(mesh.faceCount() == 1);
    CHECK_FALSE(mesh.attributes.looks.at(0).image);
    REQUIRE(report.materialProblems.size() == 1);
    CHECK_THAT(report.materialProblems[0], StartsWith("a.glb: "));
    return report.materialProblems[0];
  };
  CHECK_THAT(problemOf(kTexture + ",\"texCoord\":1}}"), Contains("TEXCOORD_1"));
  CHECK_THAT(problemOf(kTexture + R"(,"extensions":{"KHR_texture_transform":{"rotation":1}}}})"),
             Contains("rotation is not read"));
  CHECK_THAT(problemOf(kTexture + "}}", R"(,"textures":[{"source":5}],"images":[])"),
             Contains("textures[0].source is 5; the file has 0 images"));
  CHECK_THAT(
      problemOf(kTexture + "}}", R"(,"textures":[{"source":0}],"images":[{"bufferView":9}])"),
      Contains("images[0].bufferView is 9; the file has 3 bufferViews"));
  CHECK_THAT(problemOf(kTexture + "}}", R"(,"textures":[{}])"), Contains("no PNG or JPEG"));
  CHECK_THAT(
      problemOf(kTexture + "}}",
                R"(,"textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,%"}])"),
      Contains("no Base64"));
  CHECK_THAT(problemOf("\"pbrMetallicRoughness\":7"), Contains("is no object"));
  CHECK_THAT(problemOf(R"("extensions":{"KHR_materials_pbrSpecularGlossiness":{}})"),
             Contains("KHR_materials_pbrSpecularGlossiness"));
}

TEST_CASE("points, lines, skins and morph targets of glTF are noted", "[io][gltf]") {
  GltfBuffer buffer;
  buffer.add(kFloat, 3, kSquare);
  ReadReport report;
  const PolygonMesh mesh =
      parse(buffer.binary(
                R"("nodes":[{"mesh":0,"skin":0,"scale":[9,9,9]}],"meshes":[{"primitives":[)"
                R"({"attributes":{"POSITION":0},"mode":1},{"attributes":{"POSITION":0},"mode":0},)"
                R"({"attributes":{"POSITION":0},"mode":6,"targets":[{"POSITION":0}]}]}])"),
            report);
  CHECK(mesh.faceCount() == 2);
  CHECK(mesh.points[1] == Vec3d(1, 0, 0));  // a skin places its mesh without the node
  CHECK(lossText(report) ==
        "ignored 2 sets of points or lines, ignored 2 skins or sets of morph targets");
}

TEST_CASE("buffers of glTF may be files; their contents count", "[io][gltf]") {
  GltfBuffer buffer;
  buffer.add(kFloat, 3, kSquare);
  const std::string fan = oneMesh(R"("attributes":{"POSITION":0},"mode":6)");
  const TemporaryFolder folder;
  folder.write("the points.bin", buffer.bytes() + "more");
  const auto file = folder.write("a.gltf", buffer.text(fan, "the%20points.bin"));
  const Scene scene = readScene(file);
  CHECK(scene.objects.at(0).mesh.faceCount() == 2);
  CHECK(scene.files == std::vector<std::filesystem::path>{file, folder / "the points.bin"});
  folder.write("the points.bin", buffer.bytes() + "less");
  CHECK(readScene(file).inputHash != scene.inputHash);
  const auto refusal = [&](const std::string& content) {
    folder.write("the points.bin", content);
    try {
      readMesh(file);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(refusal("short"), StartsWith(file.string() + ": buffers[0] has 5 bytes; expected 48"));
  CHECK_THAT(refusal(""), Contains("buffers[0] cannot be read: ") && Contains("is empty"));
}

TEST_CASE("wrong glTF is refused by name", "[io][gltf]") {
  const std::string mesh = oneMesh(R"("attributes":{"POSITION":0},"indices":1)");
  const auto with = [&](const std::string& accessor, const std::string& rest) {
    GltfBuffer buffer;
    buffer.add(kFloat, 3, kSquare);
    buffer.addBytes(std::string("\0\1\2\3", 4));
    buffer.addAccessor(accessor);
    return refusalOf(buffer.binary(rest));
  };
  const auto accessor = [&](const std::string& members) { return with(members, mesh); };
  const auto file = [&](const std::string& rest) {
    return with(R"("bufferView":1,"componentType":5121,"count":3,"type":"SCALAR")", rest);
  };
  CHECK(file(mesh) == "accepted");
  const std::string view = "\"bufferView\":1,\"type\":\"SCALAR\",\"componentType\":5121,";
  CHECK(accessor(view + "\"count\":5") ==
        "a.glb: accessors[1] of 5 elements reaches beyond bufferViews[1] of 4 bytes");
  for (const char* members :
       {"\"count\":9007199254740992", "\"count\":1,\"byteOffset\":4",
        "\"count\":3,\"byteOffset\":2", "\"count\":1,\"byteOffset\":9007199254740992"})
    CHECK_THAT(accessor(view + members), Contains("reaches beyond bufferViews[1]"));
  CHECK_THAT(accessor(view + "\"count\":-1"),
             Contains("accessors[1].count is no whole number from 0 to 2^53"));
  CHECK_THAT(accessor(view + "\"count\":1.5"), Contains("no whole number"));
  CHECK_THAT(accessor(view + "\"count\":3,\"sparse\":{}"),
             Contains("accessors[1] is sparse; export the model without sparse accessors"));
  CHECK_THAT(accessor(R"("type":"SCALAR","componentType":5121,"count":3)"),
             Contains("accessors[1] lacks bufferView"));
  CHECK_THAT(accessor(R"("bufferView":7,"type":"SCALAR","componentType":5121,"count":3)"),
             Contains("accessors[1].bufferView is 7; the file has 2 bufferViews"));
  CHECK_THAT(accessor(R"("bufferView":1,"type":"MAT4","componentType":5121,"count":3)"),
             Contains("'MAT4'"));
  CHECK_THAT(accessor(R"("bufferView":1,"type":"SCALAR","componentType":5124,"count":1)"),
             Contains("componentType is none"));
  CHECK_THAT(accessor(R"("bufferView":1,"type":"SCALAR","componentType":5126,"count":1)"),
             Contains("whole numbers without a sign"));
  CHECK_THAT(with(R"("bufferView":1,"componentType":5121,"count":4,"type":"SCALAR")",
                  oneMesh(R"("attributes":{"POSITION":0},"indices":1,"mode":5)")),
             Contains("accepted"));
  CHECK_THAT(with(R"("bufferView":0,"componentType":5121,"count":3,"type":"SCALAR")",
                  oneMesh(R"("attributes":{"POSITION":0},"indices":1)")),
             Contains("accepted"));
  CHECK_THAT(
      with(R"("bufferView":0,"byteOffset":14,"componentType":5121,"count":3,"type":"SCALAR")",
           mesh),
      StartsWith("a.glb: meshes[0].primitives[0] refers to vertex 128 of 4"));

  const auto meshes = [&](const std::string& primitive) { return file(oneMesh(primitive)); };
  CHECK_THAT(meshes("\"attributes\":{}"),
             Contains("meshes[0].primitives[0].attributes lacks POSITION"));
  CHECK_THAT(meshes(R"("attributes":{"POSITION":0,"TEXCOORD_0":1})"),
             Contains("TEXCOORD_0 has 3 elements for 4 positions"));
  CHECK_THAT(meshes(R"("attributes":{"POSITION":1})"), Contains("other than 3 numbers"));
  CHECK_THAT(meshes(R"("attributes":{"POSITION":0},"mode":7)"), Contains("no mode of glTF"));
  CHECK_THAT(meshes(R"("attributes":{"POSITION":0},"material":0)"),
             Contains("material is 0; the file has 0 materials"));
  CHECK_THAT(
      meshes(R"("attributes":{"POSITION":0},"extensions":{"KHR_draco_mesh_compression":{}})"),
      Contains("KHR_draco_mesh_compression") && Contains("without compression"));
  for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"})
    CHECK_THAT(file(mesh + ",\"extensionsRequired\":[\"" + name + "\"]"),
               Contains(name) && Contains("export it without compression"));
  CHECK_THAT(file(mesh + ",\"extensionsRequired\":[\"XX_new\"]"),
             Contains("'XX_new', which is not read"));

  CHECK_THAT(file(R"("nodes":[{"children":[0]}],"scenes":[{"nodes":[0]}])"),
             Contains("nodes[0] is the child of two nodes, or of itself"));
  CHECK_THAT(file(R"("nodes":[{"children":[8]}])"), Contains("children[0] is 8"));
  CHECK_THAT(file(R"("scene":2)"), Contains("scene is 2; the file has 0 scenes"));
  CHECK_THAT(file(R"("nodes":[{"mesh":0}])"), Contains("mesh is 0; the file has 0 meshes"));
  CHECK_THAT(file(R"("nodes":[{}])"), Contains("no node of the scene has a mesh"));
  CHECK_THAT(file(oneMesh("", ",\"matrix\":[1,2]")), Contains("no list of 16 numbers"));
  CHECK_THAT(file(oneMesh("", ",\"matrix\":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]")),
             Contains("no affine transform"));
  CHECK_THAT(file(R"("nodes":3)"), Contains("nodes is no list"));
  CHECK_THAT(file(R"("nodes":[3])"), Contains("nodes[0] is no object"));
  CHECK_THAT(file(oneMesh(R"("attributes":{"POSITION":0},"mode":0)")), Contains("no faces"));

  CHECK(refusalOf("{\n\"asset\":{]}") == "a.glb:2: malformed JSON");
  CHECK_THAT(refusalOf("{\"a\":1e999}"), Contains("a number is too large"));
  CHECK_THAT(refusalOf("[]"), Contains("is no object"));
  CHECK_THAT(refusalOf("{}"), Contains("lacks asset"));
  CHECK_THAT(refusalOf(R"({"asset":{"version":"1.0"}})"), Contains("export the model as glTF 2.0"));
  CHECK_THAT(
      refusalOf(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1}],)"
                R"("bufferViews":[{"buffer":0,"byteLength":1}],"accessors":[{"bufferView":0,)"
                R"("count":1,"componentType":5126,"type":"VEC3"}],)" +
                oneMesh(R"("attributes":{"POSITION":0})") + "}"),
      Contains("buffers[0] lacks uri"));
}

TEST_CASE("a glTF file that places a mesh too often is refused before memory is taken",
          "[io][gltf]") {
  GltfBuffer buffer;
  buffer.add(kFloat, 3, std::vector<float>(30000));
  std::string nodes, primitives;
  for (int i = 0; i < 3000; ++i) {
    nodes += std::string(i > 0 ? "," : "") + "{\"mesh\":0}";
    primitives += std::string(i > 0 ? "," : "") + R"({"attributes":{"POSITION":0},"mode":5})";
  }
  const std::string content =
      buffer.binary("\"nodes\":[" + nodes + "],\"meshes\":[{\"primitives\":[" + primitives + "]}]");
  CHECK_THAT(refusalOf(content), Contains("more than 2^32 - 2 vertices or corners"));
}

TEST_CASE("empty sets of triangles in many glTF nodes cost nothing", "[io][gltf]") {
  GltfBuffer buffer;
  buffer.add(kFloat, 3, kSquare);
  buffer.addAccessor(R"("bufferView":0,"componentType":5126,"count":0,"type":"VEC3")");
  std::string nodes = "{\"mesh\":1}";
  std::string primitives = R"({"attributes":{"POSITION":1}})";
  for (int i = 0; i < 30000; ++i) {
    nodes += ",{\"mesh\":0}";
    primitives += R"(,{"attributes":{"POSITION":1}})";
  }
  const PolygonMesh mesh =
      parse(buffer.binary("\"nodes\":[" + nodes + "],\"meshes\":[{\"primitives\":[" + primitives +
                          R"(]},{"primitives":[{"attributes":{"POSITION":0},"mode":6}]}])"));
  CHECK(mesh.pointCount() == 4);
  CHECK(mesh.attributes.objects.names.size() == 1);
}

TEST_CASE("deeply nested JSON is no danger", "[io][gltf]") {
  const std::string deep = std::string(300000, '[') + std::string(300000, ']');
  CHECK_THAT(refusalOf("{\"extras\":" + deep + "}"), Contains("lacks asset"));
  CHECK_THAT(refusalOf(std::string(300000, '[')), Contains("malformed JSON"));
}

TEST_CASE("damaged GLB is read or refused, and every truncated one is refused", "[io][gltf]") {
  const std::string whole = texturedTriangle().binary(materialFile(kTexture + "}}", kImage));
  CHECK(refusalOf(whole) == "accepted");
  for (std::size_t size = 1; size < whole.size(); ++size) {
    CAPTURE(size);
    CHECK_THAT(refusalOf(whole.substr(0, size)), StartsWith("a.glb:"));
  }
  std::mt19937 random(1);
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = whole;
    for (int k = 0; k <= i % 4; ++k)
      damaged[random() % damaged.size()] = static_cast<char>(random());
    const std::string answer = refusalOf(damaged);
    CHECK((answer == "accepted" || answer.starts_with("a.glb:")));
  }
}
