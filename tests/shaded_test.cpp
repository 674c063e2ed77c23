#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/io/read_mesh.h"
#include "libvox/io/write_glb.h"
#include "libvox/io/write_png.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/shaded_refinement.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/limit_normals.h"
#include "libvox/subdivide/vertex_places.h"
#include "tests/shapes.h"
#include "tests/spline_torus.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <sstream>

using namespace vox;

namespace {

using nlohmann::json;

Scene sceneOf(PolygonMesh mesh) {
  Scene scene;
  scene.objects.push_back({"object", std::move(mesh)});
  return scene;
}

ShadedRefinement shaded(const Scene& scene, int levels, const PreparationOptions& options = {}) {
  return shadedRefinement(scene, levels, options, {});
}

std::string glbOf(const ShadedScene& scene) {
  std::ostringstream stream;
  writeGlb(stream, scene);
  return stream.str();
}

/// A level of a mesh, and where its vertices lie.
struct PlacedLevel {
  SubdivisionLevel level;
  std::vector<VertexPlace> places;
};

PlacedLevel placedLevel(const PolygonMesh& mesh, int levels) {
  PlacedLevel all{baseLevel(mesh), {}};
  for (int k = 0; k < levels; ++k) {
    all.places = nextPlaces(all.level, all.places, k);
    all.level = nextLevel(all.level, imageVertices(all.level));
  }
  return all;
}

/// Blends what the vertices of a mesh have, in the square of a corner, by the law of the square:
/// from the vertex to the middles of two edges and of the face.
Vec2d blended(const SubdivisionLevel& base, const VertexPlace& place,
              const std::function<Vec2d(Index, const Vec2d&)>& near) {
  const auto& mesh = base.mesh;
  const Index c = place.corner;
  const Vec2d here = near(mesh.faceVertices[c], Vec2d::Constant(NAN));
  const auto at = [&](Index corner) { return near(mesh.faceVertices[corner], here); };
  Vec2d mean = Vec2d::Zero();
  const Index f = base.adjacency.cornerFace[c];
  for (Index q = mesh.faceOffsets[f]; q < mesh.faceOffsets[f + 1]; ++q)
    mean += at(q) / mesh.faceSize(f);
  const Vec2d next = (here + at(nextCorner(mesh, base.adjacency, c))) / 2;
  const Vec2d previous = (here + at(previousCorner(mesh, base.adjacency, c))) / 2;
  const double u = place.u;
  const double v = place.v;
  return (1 - u) * (1 - v) * here + u * (1 - v) * next + (1 - u) * v * previous + u * v * mean;
}

/// `value` plus a multiple of `period`, nearest to `to` (unless that is NaN).
double unwrapped(double value, double to, double period) {
  return std::isnan(to) ? value : value + period * std::round((to - value) / period);
}

/// The parts of a .glb file, as its format says, and as numbers.
struct Glb {
  json root;
  std::string bytes;

  explicit Glb(const std::string& file) {
    REQUIRE(file.size() >= 28);
    REQUIRE(file.substr(0, 4) == "glTF");
    CHECK(wordAt(file, 4) == 2);
    CHECK(wordAt(file, 8) == file.size());
    const std::uint32_t textSize = wordAt(file, 12);
    CHECK(file.substr(16, 4) == "JSON");
    CHECK(textSize % 4 == 0);
    root = json::parse(file.substr(20, textSize));
    const std::uint32_t size = wordAt(file, 20 + textSize);
    CHECK(file.substr(24 + textSize, 4) == std::string("BIN\0", 4));
    CHECK(size % 4 == 0);
    bytes = file.substr(28 + textSize);
    CHECK(bytes.size() == size);
    CHECK(root["buffers"][0]["byteLength"] == size);
    for (const json& view : root["bufferViews"]) {
      CHECK(view["byteOffset"].get<std::size_t>() % 4 == 0);
      CHECK(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>() <= size);
    }
  }

  static std::uint32_t wordAt(const std::string& text, std::size_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, text.data() + at, 4);
    return word;
  }

  template <class T>
  std::vector<T> numbers(const json& accessor, std::size_t components) const {
    const json& view = root["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t count = accessor["count"].get<std::size_t>() * components;
    CHECK(view["byteLength"] == 4 * count);
    std::vector<T> all(count);
    std::memcpy(all.data(), bytes.data() + view["byteOffset"].get<std::size_t>(), 4 * count);
    return all;
  }
  std::vector<float> floats(const json& number, std::size_t components) const {
    const json& accessor = root["accessors"][number.get<std::size_t>()];
    CHECK(accessor["componentType"] == 5126);
    CHECK(accessor["type"] == "VEC" + std::to_string(components));
    return numbers<float>(accessor, components);
  }
};

/// Checks what the format asks of every set of triangles.
void checkPrimitives(const Glb& glb) {
  for (const json& mesh : glb.root["meshes"])
    for (const json& primitive : mesh["primitives"]) {
      const json& attributes = primitive["attributes"];
      const std::vector<float> positions = glb.floats(attributes["POSITION"], 3);
      const json& accessor = glb.root["accessors"][attributes["POSITION"].get<std::size_t>()];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        float low = positions[axis];
        float high = positions[axis];
        for (std::size_t i = axis; i < positions.size(); i += 3) {
          low = std::min(low, positions[i]);
          high = std::max(high, positions[i]);
        }
        CHECK(accessor["min"][axis].get<float>() == low);
        CHECK(accessor["max"][axis].get<float>() == high);
      }
      const std::vector<float> normals = glb.floats(attributes["NORMAL"], 3);
      REQUIRE(normals.size() == positions.size());
      bool unit = true;
      for (std::size_t i = 0; i < normals.size(); i += 3)
        unit = unit && std::abs(std::hypot(normals[i], normals[i + 1], normals[i + 2]) - 1) < 1e-6F;
      CHECK(unit);
      const json& indices = glb.root["accessors"][primitive["indices"].get<std::size_t>()];
      CHECK(indices["componentType"] == 5125);
      CHECK(indices["type"] == "SCALAR");
      const auto corners = glb.numbers<std::uint32_t>(indices, 1);
      CHECK(corners.size() % 3 == 0);
      std::vector<bool> used(positions.size() / 3, false);
      for (const std::uint32_t v : corners) {
        REQUIRE(v < used.size());
        used[v] = true;
      }
      CHECK(std::all_of(used.begin(), used.end(), [](bool one) { return one; }));
      CHECK(primitive["material"].get<std::size_t>() < glb.root["materials"].size());
    }
}

/// An image of one colour.
std::string pngOf(Pixel color) {
  Image image(2, 2);
  for (Pixel& pixel : image.pixels) pixel = color;
  std::ostringstream stream;
  writePng(stream, image);
  return stream.str();
}

Material imageMaterial(const std::string& name, Pixel color) {
  Material material;
  material.name = name;
  material.image.emplace();
  material.image->file = name + ".png";
  material.image->content = std::make_shared<const std::string>(pngOf(color));
  return material;
}

PolygonMesh readGlb(const std::string& content) {
  const test::TemporaryFolder folder;
  return readMesh(folder.write("a.glb", content));
}

}  // namespace

TEST_CASE("vertices of a torus have the normals of the spline at their places",
          "[shaded][golden]") {
  constexpr int kMajor = 9;
  constexpr int kMinor = 6;
  const int levels = GENERATE(1, 2, 3, 4);
  CAPTURE(levels);
  const PolygonMesh mesh = test::torusGrid(kMajor, kMinor);
  const SubdivisionLevel base = baseLevel(mesh);
  const test::SplineTorus torus(kMajor, kMinor);
  const PlacedLevel placed = placedLevel(mesh, levels);
  const std::vector<Vec3d> normals = limitNormals(placed.level);
  const auto parameters = [&](Index v, const Vec2d& near) {
    return Vec2d(unwrapped(v / kMinor - 0.5, near.x(), kMajor),
                 unwrapped(v % kMinor - 0.5, near.y(), kMinor));
  };
  double farthest = 0;
  double turned = 0;
  for (Index v = 0; v < placed.level.mesh.pointCount(); ++v) {
    const Vec2d at = blended(base, placed.places[v], parameters);
    turned = std::max(turned, (normals[v] - torus.normalAt(at.x(), at.y())).norm());
    farthest = std::max(farthest, (placed.level.mesh.points[v] - torus.at(at.x(), at.y())).norm());
  }
  CHECK(turned < 1e-12);
  CHECK(farthest < 0.25 * std::pow(0.25, levels));  // vertices approach their limit by the square
}

TEST_CASE("vertices of an open tube have the normals of its curve, at the rims too",
          "[shaded][golden]") {
  constexpr int kAround = 7;
  const int levels = GENERATE(1, 2, 3);
  PolygonMesh mesh = test::tube(kAround, 3);
  for (Vec3d& point : mesh.points) point.head<2>().normalize();
  const PlacedLevel placed = placedLevel(mesh, levels);
  const SubdivisionLevel base = baseLevel(mesh);
  const std::vector<Vec3d> normals = limitNormals(placed.level);
  // Around the tube the vertices lie at the angles of their parameters, by symmetry only at 1/4 of
  // a side; the normal follows from the curve.
  const auto control = [&](int i) {
    const double angle = 2 * std::numbers::pi * i / kAround;
    return Vec2d(std::cos(angle), std::sin(angle));
  };
  const auto parameters = [&](Index v, const Vec2d& near) {
    const Vec3d& point = mesh.points[v];
    const double side = std::atan2(point.y(), point.x()) * kAround / (2 * std::numbers::pi);
    return Vec2d(unwrapped(std::round(side), near.x(), kAround), 0);
  };
  double turned = 0;
  std::size_t onRims = 0;
  for (Index v = 0; v < placed.level.mesh.pointCount(); ++v) {
    const double at = blended(base, placed.places[v], parameters).x() - 0.5;
    const int span = static_cast<int>(std::floor(at));
    const double t = at - span;
    const Vec2d tangent =
        (1 - t) * (control(span + 1) - control(span)) + t * (control(span + 2) - control(span + 1));
    const Vec2d outward = Vec2d(tangent.y(), -tangent.x()).normalized();
    const Vec3d expected(outward.x(), outward.y(), 0);
    const double sign = normals[v].dot(expected) < 0 ? -1 : 1;  // the tube may be wound inward
    turned = std::max(turned, (sign * normals[v] - expected).norm());
    if (placed.places[v].onBoundary) ++onRims;
  }
  CHECK(turned < 1e-9);
  CHECK(onRims == std::size_t{4 * kAround} << (levels - 1));
}

TEST_CASE("places are where the limit surface of a flat grid has its vertices",
          "[shaded][property]") {
  PolygonMesh mesh = test::sheet(6, 5);
  for (Vec3d& point : mesh.points) point.z() = 0;
  const int levels = GENERATE(1, 2, 3);
  const PlacedLevel placed = placedLevel(mesh, levels);
  const SubdivisionLevel base = baseLevel(mesh);
  double farthest = 0;
  std::size_t checked = 0;
  for (Index v = 0; v < placed.level.mesh.pointCount(); ++v) {
    const Vec2d at = blended(base, placed.places[v], [&](Index p, const Vec2d&) -> Vec2d {
      return mesh.points[p].head<2>();
    });
    // The corners of the sheet are rounded; elsewhere the spline reproduces the plane.
    if ((at.x() < 1 || at.x() > 5) && (at.y() < 1 || at.y() > 4)) continue;
    farthest = std::max(farthest, (placed.level.mesh.points[v].head<2>() - at).norm());
    ++checked;
  }
  CHECK(farthest < 1e-12);
  CHECK(checked > placed.places.size() / 3);
}

TEST_CASE("places of every shape are distinct, and fill the squares", "[shaded][property]") {
  for (const auto& shapes : {test::shapes(), test::openShapes()})
    for (const test::Shape& shape : shapes) {
      if (shape.name.find("valence 2") != std::string::npos) continue;
      CAPTURE(shape.name);
      const PlacedLevel placed = placedLevel(shape.mesh, 3);
      std::vector<std::array<double, 4>> places;
      std::size_t inside = 0;
      for (const VertexPlace& place : placed.places) {
        if (!place.onBoundary) ++inside;
        places.push_back({double(place.corner), place.u, place.v, double(place.onBoundary)});
        const auto isCentre = [](float x) {
          return std::fmod(8 * x, 2.0F) == 1.0F && x > 0 && x < 1;
        };
        CHECK((place.onBoundary
                   ? (isCentre(place.u) && place.v == 0) || (place.u == 0 && isCentre(place.v))
                   : isCentre(place.u) && isCentre(place.v)));
      }
      std::sort(places.begin(), places.end());
      CHECK(std::adjacent_find(places.begin(), places.end()) == places.end());
      CHECK(inside <= std::size_t{16} * shape.mesh.cornerCount());
      if (shape.closed) CHECK(inside == std::size_t{16} * shape.mesh.cornerCount());
    }
}

TEST_CASE("a flat sheet has its normal everywhere, however it is turned", "[shaded][property]") {
  PolygonMesh mesh = test::sheet(4, 3);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vec3d(1, 2, -1).normalized()).toRotationMatrix();
  for (Vec3d& point : mesh.points) point = turn * Vec3d(point.x(), point.y(), 0) + Vec3d(5, 6, 7);
  PreparationOptions free;
  free.smoothing.boundary = BoundaryRule::kFree;
  for (const PreparationOptions& options : {PreparationOptions(), free})
    for (int levels = 0; levels < 4; ++levels) {
      const ShadedRefinement refined = shaded(sceneOf(mesh), levels, options);
      double turned = 0;
      for (const Vec3f& normal : refined.scene.objects[0].parts[0].normals)
        turned = std::max(turned, (normal.cast<double>() - turn.col(2)).norm());
      CHECK(turned < 1e-6);
    }
}

TEST_CASE("the sides of a cube with sharp edges have their own normals", "[shaded]") {
  PreparationOptions options;
  options.smoothing.crease = CreaseRule{40, false};
  const ShadedRefinement refined = shaded(sceneOf(test::cube()), 3, options);
  const ShadedPart& part = refined.scene.objects[0].parts[0];
  std::size_t off = 0;
  for (std::size_t v = 0; v < part.normals.size(); ++v) {
    int axis = 0;
    if (part.normals[v].cwiseAbs().maxCoeff(&axis) < 1 - 1e-6F) ++off;
    // On this side of the cube, and outward.
    if (std::abs(part.positions[v][axis] - part.normals[v][axis]) > 1e-6F) ++off;
  }
  CHECK(off == 0);
}

TEST_CASE("a .glb file is as its format says, and has the refined mesh", "[shaded][io]") {
  PolygonMesh mesh = test::dodecahedron();
  for (Index v = 0; v < mesh.pointCount(); ++v)
    mesh.pointColors.emplace_back(0.04F * float(v), 1 - 0.04F * float(v), 0.5F);
  for (int levels = 0; levels < 4; ++levels) {
    const ShadedRefinement refined = shaded(sceneOf(mesh), levels);
    const std::string file = glbOf(refined.scene);
    CHECK(glbBytes(refined.scene) == file.size());
    checkPrimitives(Glb(file));
    const PolygonMesh expected = refine(sceneOf(mesh), levels, {}, {}).mesh;
    const PolygonMesh found = readGlb(file);
    CHECK(refined.vertexCount == expected.pointCount());
    Index triangles = 0;
    for (Index f = 0; f < expected.faceCount(); ++f) triangles += expected.faceSize(f) - 2;
    CHECK(found.faceCount() == triangles);
    CHECK(refined.triangleCount == triangles);
    CHECK(test::samePoints(found.points, expected.points, 1e-6));
    REQUIRE(found.pointColors.size() == found.points.size());
    for (const Vec3f& color : found.pointColors) {
      CHECK(std::abs(color[0] + color[1] - 1) < 1e-5F);  // linear: blends keep the sum
      CHECK(color[2] == Approx(0.5F));
    }
    CHECK(file == onThreads(1, [&] { return glbOf(shaded(sceneOf(mesh), levels).scene); }));
  }
}

TEST_CASE("faces with images of their own keep to their islands", "[shaded][io]") {
  // Face f has the island u in [f, f + 1], and every other face has another material.
  PolygonMesh mesh = test::dodecahedron();
  mesh.attributes.looks = {imageMaterial("red", {255, 0, 0, 255}),
                           imageMaterial("blue", {0, 0, 255, 255})};
  mesh.attributes.materials.names = {"red", "blue"};
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    mesh.attributes.materials.ofFaces.push_back(f % 2);
    for (Index i = 0; i < mesh.faceSize(f); ++i) {
      const double angle = 2 * std::numbers::pi * i / mesh.faceSize(f);
      mesh.attributes.texcoords.emplace_back(float(f) + 0.5F + 0.5F * float(std::cos(angle)),
                                             0.5F + 0.5F * float(std::sin(angle)));
    }
  }
  for (int levels = 0; levels < 4; ++levels) {
    CAPTURE(levels);
    const ShadedRefinement refined = shaded(sceneOf(mesh), levels);
    const std::string file = glbOf(refined.scene);
    const Glb glb(file);
    checkPrimitives(glb);
    CHECK(glb.root["images"].size() == 2);
    const PolygonMesh found = readGlb(file);
    REQUIRE(found.attributes.looks.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
      REQUIRE(found.attributes.looks[i].image);
      CHECK(*found.attributes.looks[i].image->content == *mesh.attributes.looks[i].image->content);
      CHECK(found.attributes.looks[i].name == mesh.attributes.looks[i].name);
    }
    REQUIRE(found.attributes.texcoords.size() == found.cornerCount());
    std::vector<Vec2d> sums(mesh.faceCount(), Vec2d::Zero());
    for (Index f = 0; f < found.faceCount(); ++f) {
      std::array<Vec2f, 3> uv;
      for (Index i = 0; i < 3; ++i) uv[i] = found.attributes.texcoords[found.faceOffsets[f] + i];
      const auto island = static_cast<Index>(std::floor((uv[0] + uv[1] + uv[2]).x() / 3));
      REQUIRE(island < mesh.faceCount());
      const Index image = found.attributes.materials.ofFaces[f];
      CHECK(image == island % 2);
      for (const Vec2f& one : uv)
        CHECK((one - Vec2f(float(island) + 0.5F, 0.5F)).norm() < 0.5F + 1e-5F);
      const Vec2f a = uv[1] - uv[0];
      const Vec2f b = uv[2] - uv[0];
      sums[island].x() += 0.5 * double(a.x() * b.y() - a.y() * b.x());
    }
    // The triangles cover a whole island once: its pentagon has this area.
    const double area = 5 * 0.125 * std::sin(2 * std::numbers::pi / 5);
    for (const Vec2d& sum : sums) CHECK(sum.x() == Approx(area).epsilon(levels == 0 ? 1e-5 : 0.7));
    double all = 0;
    for (const Vec2d& sum : sums) all += sum.x();
    if (levels == 3) CHECK(all == Approx(12 * area).epsilon(0.12));
  }
}

TEST_CASE("texture coordinates that agree at the edges stay one sheet", "[shaded]") {
  PolygonMesh mesh = test::sheet(4, 4);
  for (const Index v : mesh.faceVertices)
    mesh.attributes.texcoords.emplace_back(mesh.points[v].head<2>().cast<float>());
  const ShadedRefinement refined = shaded(sceneOf(mesh), 2);
  const PolygonMesh polygons = refine(sceneOf(mesh), 2, {}, {}).mesh;
  CHECK(refined.vertexCount == polygons.pointCount());  // no vertex is there twice
  CHECK(refined.scene.objects[0].parts[0].texcoords.size() == polygons.pointCount());
}

TEST_CASE("colours, materials and images multiply in a .glb as in the grid color", "[shaded][io]") {
  PolygonMesh mesh = test::cube();
  mesh.attributes.materials = {{"one"}, std::vector<Index>(mesh.faceCount(), 0)};
  Material material;
  material.name = "one";
  material.color = {0.25F, 0.5F, 0.75F};
  const auto lookOf = [&](bool hasColors) {
    PolygonMesh all = mesh;
    all.attributes.looks = {material};
    if (hasColors) all.pointColors.assign(all.points.size(), Vec3f(1, 0.5F, 0));
    return shaded(sceneOf(all), 1).scene;
  };
  // A material that does not multiply gives way to the colours of a mesh.
  CHECK(lookOf(false).materials[0].color == material.color);
  CHECK(lookOf(true).materials[0].color == Vec3f::Ones());
  CHECK(lookOf(true).objects[0].parts[0].colors[0].isApprox(Vec3f(1, 0.5F, 0)));
  material.multiplies = true;
  CHECK(lookOf(true).materials[0].color == material.color);
  CHECK(lookOf(true).objects[0].parts[0].colors.size() == 24);
  material.opacity = 0.5;
  const Glb glb(glbOf(lookOf(false)));
  CHECK(glb.root["materials"][0]["alphaMode"] == "BLEND");
  CHECK(glb.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] ==
        json({0.25, 0.5, 0.75, 0.5}));
  // Nothing at all: grey.
  CHECK(shaded(sceneOf(test::cube()), 1).scene.materials[0].color == Vec3f::Constant(kPlainColor));
}

TEST_CASE("a solid texture becomes the colours of vertices", "[shaded]") {
  Scene scene = sceneOf(test::torusGrid(8, 5));
  scene.objects[0].texture = parseTexture("gradient:axis=x,from=-1,to=1,colors=0:0:0/1:1:1");
  const ShadedRefinement refined = shaded(scene, 2);
  const ShadedPart& part = refined.scene.objects[0].parts[0];
  REQUIRE(part.colors.size() == part.positions.size());
  float most = 0;
  for (std::size_t v = 0; v < part.colors.size(); ++v)
    most = std::max(most, std::abs(part.colors[v][0] -
                                   std::clamp(part.positions[v][0] / 2 + 0.5F, 0.0F, 1.0F)));
  CHECK(most < 1e-5F);
}

TEST_CASE("an object far from the origin keeps its shape in floats", "[shaded][io]") {
  const Vec3d far(4e6, -3e7, 0.5);
  const PolygonMesh mesh = test::moved(test::cube(), far);
  const PolygonMesh found = readGlb(glbOf(shaded(sceneOf(mesh), 1).scene));
  const PolygonMesh expected = refine(sceneOf(mesh), 1, {}, {}).mesh;
  CHECK(test::samePoints(found.points, expected.points, 1e-6));
}

TEST_CASE("a .glb of 4 GiB is refused before a byte is written", "[shaded][io][error]") {
  constexpr std::uint64_t kRoom = std::uint64_t{6} << 30U;
  if (availableMemory() < kRoom) return;
  ShadedScene scene = shaded(sceneOf(test::cube()), 0).scene;
  // Memory that is never touched: Eigen's vectors have no value at first.
  scene.objects[0].parts[0].normals = std::vector<Vec3f>((std::size_t{1} << 32U) / sizeof(Vec3f));
  std::ostringstream stream;
  CHECK_THROWS_AS(writeGlb(stream, scene), LimitError);
  CHECK_THROWS_WITH(writeGlb(stream, scene), Catch::Contains("less than 4 GiB"));
  CHECK(stream.str().empty());
}

TEST_CASE("a stream that fails while a .glb is written is an error", "[shaded][io][error]") {
  std::ostringstream stream;
  stream.setstate(std::ios::badbit);
  CHECK_THROWS_AS(writeGlb(stream, shaded(sceneOf(test::cube()), 1).scene), IoError);
}
