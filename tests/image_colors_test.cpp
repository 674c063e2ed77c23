#include "libvox/core/color.h"
#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/read_mesh.h"
#include "libvox/io/write_glb.h"
#include "libvox/io/write_png.h"
#include "libvox/mesh/area_vector.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/shaded_refinement.h"
#include "tests/conversion.h"
#include "tests/gltf_files.h"
#include "tests/shapes.h"
#include "tests/spline_torus.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

using namespace vox;
using Catch::Contains;

namespace {

std::string pngOf(const Image& image) {
  std::ostringstream stream;
  writePng(stream, image);
  return stream.str();
}

/// A scene of a mesh with one material, an image for all faces.
Scene imageScene(PolygonMesh mesh, const Image& image) {
  Material material;
  material.name = "skin";
  material.image.emplace();
  material.image->file = "skin.png";
  material.image->content = std::make_shared<const std::string>(pngOf(image));
  mesh.attributes.materials = {{"skin"}, std::vector<Index>(mesh.faceCount(), 0)};
  mesh.attributes.looks = {material};
  Scene scene;
  scene.objects.push_back({"object", std::move(mesh)});
  return scene;
}

ConvertOptions colorsAt(int dim) {
  ConvertOptions options;
  options.dim = dim;
  options.grids = std::vector{GridKind::kColor};
  return options;
}

/// An image whose texels tell their column in red and their row, from below, in green.
Image placeImage(int size) {
  Image image(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      image.at(x, y) = {static_cast<std::uint8_t>(x * 255 / (size - 1)),
                        static_cast<std::uint8_t>((size - 1 - y) * 255 / (size - 1)), 0, 255};
  return image;
}

/// The texture coordinate that a value of placeImage tells.
double placeOf(float light, int size) {
  return (screenFromLinear(light) * (size - 1) + 0.5) / size;
}

/// 12 colours that are different and no means of each other.
Pixel islandColor(Index f) {
  return {static_cast<std::uint8_t>(20 * f), static_cast<std::uint8_t>(f * f),
          static_cast<std::uint8_t>(255 - 13 * f), 255};
}

/// An image with a square of one colour for each face, side by side; and texture coordinates that
/// lay each face into its square, a texel off the sides.
Image islands(PolygonMesh& mesh) {
  constexpr int kSide = 16;
  const auto count = static_cast<int>(mesh.faceCount());
  Image image(kSide * count, kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide * count; ++x)
      image.at(x, y) = islandColor(static_cast<Index>(x / kSide));
  constexpr double kInset = 1.0 / kSide;
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (Index i = 0; i < mesh.faceSize(f); ++i) {
      const double angle = 2 * 3.14159265358979 * i / mesh.faceSize(f);
      const double x = 0.5 + (0.5 - kInset) * std::cos(angle);
      const double y = 0.5 + (0.5 - kInset) * std::sin(angle);
      mesh.attributes.texcoords.emplace_back(Vec2d((f + x) / count, y).cast<float>());
    }
  return image;
}

/// The voxels whose colour is not that of the face whose centre is nearest by angle.
std::size_t bleeding(const PolygonMesh& mesh, const openvdb::Vec3SGrid& color,
                     std::size_t& checked) {
  std::size_t wrong = 0;
  for (auto voxel = color.cbeginValueOn(); voxel; ++voxel) {
    const openvdb::Vec3d world = color.indexToWorld(voxel.getCoord());
    const Vec3d at(world.x(), world.y(), world.z());
    std::vector<std::pair<double, Index>> order;
    for (Index f = 0; f < mesh.faceCount(); ++f)
      order.emplace_back(-at.dot(test::faceCentroid(mesh, f)), f);
    std::sort(order.begin(), order.end());
    if (order[1].first - order[0].first < 1e-3) continue;  // on a seam
    ++checked;
    const Pixel expected = islandColor(order[0].second);
    for (std::size_t channel = 0; channel < 3; ++channel)
      if (std::abs(screenFromLinear((*voxel)[static_cast<int>(channel)]) * 255 -
                   expected[channel]) > 0.01) {
        ++wrong;
        break;
      }
  }
  return wrong;
}

}  // namespace

TEST_CASE("an image lies where the closest points have its texture coordinates", "[color][image]") {
  constexpr int kMajor = 12;
  constexpr int kMinor = 8;
  constexpr int kSize = 256;
  PolygonMesh mesh = test::torusGrid(kMajor, kMinor);
  for (int i = 0; i < kMajor; ++i)
    for (int j = 0; j < kMinor; ++j)
      for (const auto& [a, b] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
        mesh.attributes.texcoords.emplace_back(
            Vec2d(double(i + a) / kMajor, double(j + b) / kMinor).cast<float>());
  const Conversion conversion =
      convert(imageScene(std::move(mesh), placeImage(kSize)), colorsAt(96));
  const test::SplineTorus torus(kMajor, kMinor);
  const openvdb::Vec3SGrid& color = test::colorOf(conversion);
  std::size_t checked = 0;
  double most = 0;
  for (auto voxel = color.cbeginValueOn(); voxel; ++voxel) {
    const openvdb::Vec3d world = color.indexToWorld(voxel.getCoord());
    const auto [u, v] = torus.nearest(Vec3d(world.x(), world.y(), world.z()));
    const auto fraction = [](double x) { return x - std::floor(x); };
    const Vec2d exact(fraction((u + 0.5) / kMajor), fraction((v + 0.5) / kMinor));
    // Where the image repeats, its first and last texels are blended.
    if (exact.minCoeff() < 1.0 / kSize || exact.maxCoeff() > 1 - 1.0 / kSize) continue;
    ++checked;
    const Vec2d found(placeOf(voxel->x(), kSize), placeOf(voxel->y(), kSize));
    most = std::max(most, (found - exact).cwiseAbs().maxCoeff());
  }
  CHECK(checked > 5000);
  CHECK(most * kSize < 1);  // texel
}

TEST_CASE("seams between islands of an image stay sharp: no colour bleeds", "[color][image]") {
  for (PolygonMesh mesh : {test::cube(), test::dodecahedron()}) {
    for (const bool sharp : {false, true}) {
      CAPTURE(mesh.faceCount(), sharp);
      PolygonMesh laid = mesh;
      const Image image = islands(laid);
      ConvertOptions options = colorsAt(48);
      if (sharp) options.smoothing.crease = CreaseRule{.degrees = 20.0};
      const Conversion conversion = convert(imageScene(laid, image), options);
      std::size_t checked = 0;
      CHECK(bleeding(mesh, test::colorOf(conversion), checked) == 0);
      CHECK(checked > 3000);
    }
  }
}

TEST_CASE("a refined .glb has the colours of the mesh that it was made of",
          "[color][image][shaded]") {
  constexpr int kLevels = 4;
  for (PolygonMesh mesh : {test::cube(), test::dodecahedron()}) {
    for (const bool sharp : {false, true}) {
      CAPTURE(mesh.faceCount(), sharp);
      PolygonMesh laid = mesh;
      const Image image = islands(laid);
      PreparationOptions preparation;
      if (sharp) preparation.smoothing.crease = CreaseRule{.degrees = 20.0};
      const test::TemporaryFolder folder;
      {
        std::ofstream file(folder / "refined.glb", std::ios::binary);
        writeGlb(file, shadedRefinement(imageScene(laid, image), kLevels, preparation, {}).scene);
      }
      ConvertOptions options = colorsAt(48);
      options.until = StopRule{.levels = 0};
      const Conversion conversion = convert(readScene(folder / "refined.glb"), options);
      std::size_t checked = 0;
      const std::size_t wrong = bleeding(mesh, test::colorOf(conversion), checked);
      CHECK(checked > 3000);
      // Faces across a seam have the image of one side, so half of their width is on the other. On
      // a sharp edge both sides are equally near.
      CHECK(wrong <= checked / (sharp ? 100 : 12));
    }
  }
}

TEST_CASE("a flat polygon has its image at the closest point", "[color][image]") {
  constexpr int kSize = 64;
  PolygonMesh mesh = test::meshOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}});
  for (const Vec3d& p : mesh.points)
    mesh.attributes.texcoords.emplace_back(p.head<2>().cast<float>());
  ConvertOptions options = colorsAt(40);
  options.until = StopRule{.levels = 0};
  const Conversion conversion = convert(imageScene(mesh, placeImage(kSize)), options);
  const openvdb::Vec3SGrid& color = test::colorOf(conversion);
  std::size_t checked = 0;
  for (auto voxel = color.cbeginValueOn(); voxel; ++voxel) {
    const openvdb::Vec3d at = color.indexToWorld(voxel.getCoord());
    if (std::min({at.x(), at.y(), 1 - at.x(), 1 - at.y()}) < 1.0 / kSize) continue;
    ++checked;
    CHECK(std::abs(placeOf(voxel->x(), kSize) - at.x()) * kSize < 1);
    CHECK(std::abs(placeOf(voxel->y(), kSize) - at.y()) * kSize < 1);
  }
  CHECK(checked > 1000);
}

TEST_CASE("a voxel that covers many texels has their mean light", "[color][image]") {
  constexpr int kSize = 1024;
  Image checker(kSize, kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const std::uint8_t value = (x + y) % 2 == 0 ? 255 : 0;
      checker.at(x, y) = {value, value, value, 255};
    }
  PolygonMesh mesh = test::cube();
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (const auto& [a, b] : {std::pair(0.F, 0.F), {1.F, 0.F}, {1.F, 1.F}, {0.F, 1.F}})
      mesh.attributes.texcoords.emplace_back(a, b);
  const Conversion conversion = convert(imageScene(mesh, checker), colorsAt(32));
  double sum = 0;
  double worst = 0;
  for (auto voxel = test::colorOf(conversion).cbeginValueOn(); voxel; ++voxel) {
    sum += voxel->x();
    worst = std::max(worst, std::abs(voxel->x() - 0.5));
  }
  const auto count = static_cast<double>(test::colorOf(conversion).activeVoxelCount());
  CHECK(sum / count == Approx(0.5).margin(0.01));
  CHECK(worst < 0.1);
}

TEST_CASE("texture coordinates follow corners through repair, splits and creases",
          "[prepare][image]") {
  const auto texcoordAt = [](const Vec3d& p) {
    return Vec2d(0.3 * p.x() + 0.1 * p.y() + 0.2, 0.7 * p.y() - 0.2 * p.z());
  };
  // A notched prism whose caps have holes; a T-junction; vertices of its own for each face.
  const char* const kFile =
      "v 0 0 0\nv 3 0 0\nv 3 2 0\nv 2 2 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
      "v 0 0 1\nv 3 0 1\nv 3 2 1\nv 2 2 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
      "v 1.2 0.3 0\nv 1.8 0.3 0\nv 1.8 0.6 0\nv 1.2 0.6 0\nv 1.5 0 1\nv 1.5 0 0\n"
      "f 8 7 6 5 4 3 2 22 1 17 20 19 18 17 1\nf 9 21 10 11 12 13 14 15 16\n"
      "f 1 2 10 21 9\nf 2 3 11 10\nf 3 4 12 11\nf 4 5 13 12\nf 5 6 14 13\nf 6 7 15 14\n"
      "f 7 8 16 15\nf 8 1 9 16\n";
  PolygonMesh mesh = test::unwelded(parseMesh("a.obj", kFile));
  for (const Index v : mesh.faceVertices)
    mesh.attributes.texcoords.emplace_back(texcoordAt(mesh.points[v]).cast<float>());
  Scene scene;
  scene.objects.push_back({"object", std::move(mesh)});
  for (const bool creases : {false, true}) {
    CAPTURE(creases);
    ObjectPreparation preparation;
    preparation.followsTexcoords = true;
    if (creases) preparation.crease.degrees = 30;
    Progress progress;
    const PreparedObject prepared =
        prepare(scene, scene.objects[0], preparation, MemoryBudget({}), progress);
    const PolygonMesh& base = prepared.base.mesh;
    REQUIRE(prepared.texcoords.size() == base.cornerCount());
    CHECK(base.faceCount() > scene.objects[0].mesh.faceCount());
    double most = 0;
    for (Index c = 0; c < base.cornerCount(); ++c)
      most = std::max(most, (prepared.texcoords[c].cast<double>() -
                             texcoordAt(base.points[base.faceVertices[c]]))
                                .norm());
    CHECK(most < 1e-6);
  }
}

TEST_CASE("OBJ has the texture coordinates, objects, groups and materials of its faces",
          "[io][image]") {
  ReadReport report;
  const PolygonMesh mesh = parseMesh("a.obj",
                                     "mtllib a b.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                     "vt 0 0.25\nvt 0.5 1 0\nf 1 2 3\nusemtl red\no body\n"
                                     "f 1/1 2/2 3/-1\ng left arm\nusemtl  blue sky \n"
                                     "f 1/3/1 3/1 4/2\nusemtl red\nf 2/9 3/1 4/-7\nvt 2 3\n",
                                     report);
  const MeshAttributes& attributes = mesh.attributes;
  CHECK(report.materialFiles == std::vector<std::string>{"a b.mtl"});
  CHECK(attributes.materials.names == std::vector<std::string>{"red", "blue sky"});
  CHECK(attributes.materials.ofFaces == std::vector<Index>{kNone, 0, 1, 0});
  CHECK(attributes.objects.names == std::vector<std::string>{"body"});
  CHECK(attributes.objects.ofFaces == std::vector<Index>{kNone, 0, 0, 0});
  CHECK(attributes.groups.names == std::vector<std::string>{"left arm"});
  CHECK(attributes.groups.ofFaces == std::vector<Index>{kNone, kNone, 0, 0});
  REQUIRE(attributes.texcoords.size() == 12);
  const Vec2f none = Vec2f::Constant(std::numeric_limits<float>::quiet_NaN());
  const std::vector<Vec2f> expected = {none,      none,      none,       {0, 0.25F},
                                       {0.5F, 1}, {0.5F, 1}, {2, 3},     {0, 0.25F},
                                       {0.5F, 1}, none,      {0, 0.25F}, none};
  for (std::size_t c = 0; c < expected.size(); ++c) {
    CAPTURE(c);
    CHECK((attributes.texcoords[c] == expected[c] ||
           (attributes.texcoords[c].hasNaN() && expected[c].hasNaN())));
  }
  CHECK_THAT(lossText(report), Contains("2 texture coordinates"));
}

TEST_CASE("materials colour the faces; what is missing gives one warning", "[io][image]") {
  const test::TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder.path() / name, std::ios::binary) << text;
  };
  std::string obj = "mtllib cube.mtl\n";
  for (const Vec3d& p : test::cube().points) {
    std::ostringstream line;
    line << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
    obj += line.str();
  }
  obj += "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
  const PolygonMesh cube = test::cube();
  for (Index f = 0; f < 6; ++f) {
    obj += f % 2 == 0 ? "usemtl even\nf" : "usemtl odd\nf";
    for (Index i = 0; i < 4; ++i)
      obj += " " + std::to_string(cube.face(f)[i] + 1) + "/" + std::to_string(i + 1);
    obj += "\n";
  }
  write("cube.obj", obj);
  write("cube.mtl", "newmtl even\nKd 1 0 0\nmap_Kd missing.png\nnewmtl odd\nKd 0 0.5 0\n");
  const Scene scene = readScene(folder.path() / "cube.obj");
  CHECK(scene.files.size() == 2);
  const Conversion conversion = convert(scene, colorsAt(24));
  std::size_t red = 0;
  std::size_t green = 0;
  for (auto voxel = test::colorOf(conversion).cbeginValueOn(); voxel; ++voxel) {
    red += *voxel == openvdb::Vec3f(1, 0, 0);
    green += *voxel == openvdb::Vec3f(0, 0.5F, 0);
  }
  CHECK(red > 100);
  CHECK(green > 100);
  CHECK(red + green == test::colorOf(conversion).activeVoxelCount());
  REQUIRE(conversion.report.warnings.size() == 1);
  CHECK_THAT(conversion.report.warnings[0], Contains("missing.png"));

  Image image(2, 2);
  for (Pixel& pixel : image.pixels) pixel = {0, 0, 255, 255};
  write("missing.png", pngOf(image));
  const Conversion found = convert(scene, colorsAt(24));
  CHECK(found.report.warnings.empty());
  CHECK(found.report.inputHash != conversion.report.inputHash);
  std::size_t blue = 0;
  for (auto voxel = test::colorOf(found).cbeginValueOn(); voxel; ++voxel)
    blue += *voxel == openvdb::Vec3f(0, 0, 1);
  CHECK(blue == red);

  ConvertOptions replaced = colorsAt(24);
  replaced.texture = parseTexture("image:file=" + (folder.path() / "missing.png").string());
  const Conversion all = convert(scene, replaced);
  for (auto voxel = test::colorOf(all).cbeginValueOn(); voxel; ++voxel)
    CHECK(*voxel == openvdb::Vec3f(0, 0, 1));
}

TEST_CASE("an image of several materials is read once, whether it can be or not", "[image]") {
  PolygonMesh mesh = test::cube();
  for (Index c = 0; c < mesh.cornerCount(); ++c)
    mesh.attributes.texcoords.emplace_back(0.5F, static_cast<float>(c % 2));
  Scene scene = imageScene(mesh, Image(512, 512));
  MeshAttributes& attributes = scene.objects[0].mesh.attributes;
  attributes.materials = {{"a", "b", "c"}, {0, 0, 1, 1, 2, 2}};
  attributes.looks.resize(3, attributes.looks[0]);
  ConvertOptions options = colorsAt(16);
  options.run.maxMemory = 10U << 20U;  // an image takes 1 MiB; three do not fit beside the rest
  CHECK(convert(scene, options).report.warnings.empty());
  options.run.maxMemory = 900U << 10U;
  CHECK_THROWS_WITH(convert(scene, options),
                    Contains("skin.png: the image needs") && Contains("raise --max-memory"));

  options.run.maxMemory = 0;
  for (Material& look : attributes.looks) look.image->content = nullptr;  // there is no such file
  const std::vector<std::string> once = convert(scene, options).report.warnings;
  REQUIRE(once.size() == 1);
  CHECK_THAT(once[0], Contains("skin.png: no such file") && !Contains("more image"));
  attributes.looks[1].image->file = "other.png";
  const std::vector<std::string> twice = convert(scene, options).report.warnings;
  REQUIRE(twice.size() == 1);
  CHECK_THAT(twice[0], Contains("skin.png: no such file") && Contains("(and 1 more image)"));
}

TEST_CASE("all missing material files give one warning", "[io][image]") {
  const test::TemporaryFolder folder;
  const auto warningsOf = [&](const std::string& libraries) {
    const Scene scene = readScene(
        folder.write("a.obj", libraries + "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"));
    std::vector<std::string> warnings = convert(scene, colorsAt(8)).report.warnings;
    std::erase_if(warnings, [](const auto& text) { return text.find(".mtl") == text.npos; });
    REQUIRE(warnings.size() == 1);
    return warnings[0];
  };
  CHECK_THAT(warningsOf("mtllib a.mtl\nmtllib b.mtl c.mtl\n"),
             Contains("a.mtl: no such file") && Contains("its materials are not used") &&
                 Contains("(and 2 more problems)"));
  CHECK_THAT(warningsOf("mtllib a.mtl\nmtllib a.mtl\nmtllib a.mtl a.mtl\n"),
             !Contains("more problem"));
}

TEST_CASE("with alpha cut, voxels whose closest point is transparent are left out", "[image]") {
  // The image is opaque in its lower half only.
  Image image(8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      image.at(x, y) = {200, 100, 50, static_cast<std::uint8_t>(y < 4 ? 0 : 255)};
  PolygonMesh mesh = test::cube();
  for (const Index v : mesh.faceVertices)
    mesh.attributes.texcoords.emplace_back(0.5F, static_cast<float>(mesh.points[v].z() / 2 + 0.5));
  ConvertOptions options = colorsAt(40);
  options.grids = std::vector{GridKind::kMask};
  options.smoothing.crease = CreaseRule{.degrees = 20.0};
  Scene scene = imageScene(mesh, image);
  scene.objects[0].mesh.attributes.looks[0].image->clamp = true;
  const Conversion whole = convert(scene, options);
  options.volume.alpha = Alpha::kCut;
  const Conversion cut = convert(scene, options);
  std::size_t expected = 0;
  for (auto voxel = test::maskOf(whole).cbeginValueOn(); voxel; ++voxel) {
    const double z = test::maskOf(whole).indexToWorld(voxel.getCoord()).z();
    if (std::abs(z) < 1e-3) continue;
    CHECK(test::maskOf(cut).tree().isValueOn(voxel.getCoord()) == (z < 0));
    expected += z < 0;
  }
  CHECK(expected > 1000);
  CHECK(cut.report.activeVoxels == test::maskOf(cut).activeVoxelCount());

  CHECK(cut.report.warnings.empty());

  Scene clear = imageScene(mesh, Image(1, 1));
  clear.objects[0].mesh.attributes.looks[0].opacity = 0.25;
  const Conversion nothing = convert(clear, options);
  CHECK(test::maskOf(nothing).activeVoxelCount() == 0);
  REQUIRE(nothing.report.warnings.size() == 1);
  CHECK_THAT(nothing.report.warnings[0], Contains("--alpha cut left no voxel"));

  options.volume.fill = Fill::kSolid;
  options.grids = std::vector{GridKind::kDensity};
  CHECK_THROWS_AS(convert(scene, options), UsageError);
  options.volume.fill = Fill::kSurface;
  options.volume.edge = Edge::kSoft;
  CHECK_THROWS_WITH(convert(scene, options), Contains("--edge hard"));
}

TEST_CASE("texture coordinates of any size are read; those that are no numbers are counted",
          "[io][image]") {
  const auto check = [](const char* file, const std::string& content) {
    CAPTURE(file);
    ReadReport report;
    const PolygonMesh mesh = parseMesh(file, content, report);
    REQUIRE(mesh.attributes.texcoords.size() == 3);
    CHECK(mesh.attributes.texcoords[0] == Vec2f(1e30F, -1e15F));
    CHECK_FALSE(mesh.attributes.texcoords[1].allFinite());  // 1e200 is too large for a float
    CHECK(mesh.attributes.texcoords[2] == Vec2f(0, 1));
    CHECK_THAT(lossText(report),
               Contains("ignored 1 texture coordinate not finite or missing in the file"));
  };
  check("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1e30 -1e15\nvt 1e200 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  check("a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty double s\nproperty double t\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n"
        "0 0 0 1e30 -1e15\n1 0 0 1e200 0\n0 1 0 0 1\n3 0 1 2\n");
}

TEST_CASE("PLY has texture coordinates and images as MeshLab writes them", "[io][image]") {
  const std::string header =
      "ply\nformat ascii 1.0\ncomment TextureFile a skin.png\ncomment TextureFile b.png\n"
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 3\nproperty list uchar int vertex_indices\n"
      "property list uchar float texcoord\nproperty int texnumber\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const PolygonMesh mesh = parseMesh("f/a.ply", header +
                                                    "4 0 1 2 3 8 0 0.5 1 2 3 4 5 6 1\n"
                                                    "3 0 1 2 0 -1\n3 2 1 0 6 9 8 7 6 5 4 0\n");
  const MeshAttributes& attributes = mesh.attributes;
  REQUIRE(attributes.texcoords.size() == 10);
  CHECK(attributes.texcoords[0] == Vec2f(0, 0.5F));
  CHECK(attributes.texcoords[3] == Vec2f(5, 6));
  CHECK(std::isnan(attributes.texcoords[4][0]));
  CHECK(attributes.texcoords[9] == Vec2f(5, 4));
  CHECK(attributes.materials.names == std::vector<std::string>{"a skin.png", "b.png"});
  CHECK(attributes.materials.ofFaces == std::vector<Index>{1, kNone, 0});
  REQUIRE(attributes.looks.size() == 2);
  CHECK(attributes.looks[0].image->file == "f/a skin.png");
  CHECK_FALSE(attributes.looks[0].multiplies);
  CHECK_THROWS_WITH(parseMesh("a.ply", header + "3 0 1 2 4 0 1 2 3 0\n"),
                    Contains("a.ply:18: face 0: texcoord has 4 numbers; expected 2 for each of the "
                             "3 corners"));
  CHECK_THROWS_WITH(parseMesh("a.ply", header + "3 0 1 2 6 0 1 2 3 4 5 0.5\n"),
                    Contains("whole number"));
}

TEST_CASE("PLY has texture coordinates of points, by every name", "[io][image]") {
  for (const auto& [u, v] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
    const PolygonMesh mesh =
        parseMesh("a.ply",
                  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                  "property float z\nproperty float " +
                      std::string(u) + "\nproperty double " + v +
                      "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                      "0 0 0 0.5 1\n1 0 0 0.25 2\n0 1 0 nan 3\n3 1 0 2\n");
    REQUIRE(mesh.attributes.texcoords.size() == 3);
    CHECK(mesh.attributes.texcoords[0] == Vec2f(0.25F, 2));
    CHECK(mesh.attributes.texcoords[1] == Vec2f(0.5F, 1));
    CHECK_FALSE(mesh.attributes.texcoords[2].allFinite());
    CHECK(mesh.attributes.looks.empty());
  }
}

TEST_CASE("a textured GLB, PLY and OBJ with MTL of one model have the same colours",
          "[io][image][gltf]") {
  // A cube; each side is a quarter of the image, turned differently: two triangles.
  const PolygonMesh cube = test::cube();
  std::vector<float> points, texcoords, upTexcoords;
  std::string obj = "mtllib a.mtl\nusemtl skin\n", ply, faces, coordinates;
  std::size_t vertices = 0;
  for (Index f = 0; f < cube.faceCount(); ++f) {
    for (const std::size_t i : {0U, 1U, 2U, 0U, 2U, 3U}) {
      const Vec3d point = cube.points[cube.face(f)[i]];
      const Vec2f corner(static_cast<float>((i + f) / 2 % 2),
                         static_cast<float>((i + f + 1) / 2 % 2));
      const Vec2f uv = 0.5F * corner + Vec2f(f % 2 == 0 ? 0 : 0.5F, f % 3 == 0 ? 0 : 0.25F);
      std::ostringstream v, t;
      v << point[0] << ' ' << point[1] << ' ' << point[2] << '\n';
      t << uv[0] << ' ' << uv[1];
      obj += "v " + v.str() + "vt " + t.str() + "\n";
      ply += v.str();
      coordinates += " " + t.str();
      for (const double x : point) points.push_back(static_cast<float>(x));
      texcoords.insert(texcoords.end(), {uv[0], 1 - uv[1]});
      if (++vertices % 3 != 0) continue;
      obj += "f";
      faces += "3";
      for (std::size_t k = vertices - 3; k < vertices; ++k) {
        obj += " " + std::to_string(k + 1) + "/" + std::to_string(k + 1);
        faces += " " + std::to_string(k);
      }
      obj += "\n";
      faces += " 6" + coordinates + "\n";
      coordinates.clear();
    }
  }
  const std::string png = pngOf(placeImage(32));
  test::GltfBuffer buffer;
  buffer.add(5126, 3, points).add(5126, 2, texcoords).addBytes(png);
  const std::string glb = buffer.binary(
      test::oneMesh(R"("attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0)") +
      R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)"
      R"("textures":[{"source":0}],"images":[{"bufferView":2,"mimeType":"image/png"}])");
  const test::TemporaryFolder folder;
  folder.write("skin.png", png);
  folder.write("a.mtl", "newmtl skin\nmap_Kd skin.png\n");
  const std::string count = std::to_string(vertices);
  const std::string plyFile =
      "ply\nformat ascii 1.0\ncomment TextureFile skin.png\nelement vertex " + count +
      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
      std::to_string(vertices / 3) +
      "\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n" +
      ply + faces;
  const auto colors = [&](const std::string& name, const std::string& content) {
    Conversion conversion = convert(readScene(folder.write(name, content)), colorsAt(32));
    for (const std::string& warning : conversion.report.warnings) UNSCOPED_INFO(warning);
    if (name == "a.glb")
      CHECK(conversion.report.warnings.empty());
    else
      CHECK(conversion.report.warnings == std::vector<std::string>{"a: welded 28 vertices"});
    return test::colorOf(conversion).deepCopy();
  };
  const auto expected = colors("a.obj", obj);
  CHECK(expected->activeVoxelCount() > 1000);
  for (const auto& other : {colors("a.glb", glb), colors("a.ply", plyFile)}) {
    CHECK(other->activeVoxelCount() == expected->activeVoxelCount());
    double most = 0;
    for (auto voxel = expected->cbeginValueOn(); voxel; ++voxel) {
      REQUIRE(other->tree().isValueOn(voxel.getCoord()));
      const openvdb::Vec3s apart = other->tree().getValue(voxel.getCoord()) - *voxel;
      most = std::max(most, static_cast<double>(apart.length()));
    }
    CHECK(most < 1e-5);
  }
}
