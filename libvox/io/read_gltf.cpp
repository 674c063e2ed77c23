// glTF 2.0, text (.gltf) and binary (.glb): the meshes of a scene where its nodes place them.
//
// Source: Khronos Group, "glTF 2.0 Specification", 2021.

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/io/gltf_file.h"
#include "libvox/io/gltf_materials.h"
#include "libvox/io/gltf_value.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/point_welder.h"
#include "libvox/io/text_scanner.h"
#include "libvox/io/unique_names.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

namespace vox {
namespace {

constexpr std::uint64_t kTriangles = 4, kStrip = 5, kFan = 6;  // modes; those below have no faces
constexpr std::uint64_t kUnsignedByteType = 5121, kUnsignedShortType = 5123,
                        kUnsignedIntType = 5125, kFloatType = 5126;

constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// A set of triangles of a mesh; at least one.
struct Primitive {
  GltfValue place;
  std::uint64_t mode;
  GltfNumbers points;
  std::pair<std::string, std::string> arrays = {};  // that the points and their colours come from
  std::optional<GltfNumbers> indices = {}, texcoords = {}, colors = {};
  std::optional<Index> material = {};

  std::uint64_t cornerCount() const { return indices ? indices->count : points.count; }
  std::uint64_t triangleCount() const {
    const std::uint64_t corners = cornerCount();
    if (mode == kTriangles) return corners / 3;
    return corners < 3 ? 0 : corners - 2;
  }
  /// True if corners are left over that are no triangle.
  bool isCut() const {
    return mode == kTriangles ? cornerCount() % 3 > 0 : cornerCount() == 1 || cornerCount() == 2;
  }
};

/// A node that has a mesh, and where it is.
struct Instance {
  GltfValue node;
  Eigen::Affine3d toWorld;
};

struct Counts {
  std::uint64_t points = 0;
  std::uint64_t triangles = 0;
};

class GltfReader {
 public:
  GltfReader(std::string_view content, ReadLog& log)
      : file_(content, log.report.file), report_(log.report), materials_(file_, report_) {}

  PolygonMesh read();

 private:
  void checkExtensions() const;
  std::vector<GltfValue> rootNodes() const;
  std::vector<Instance> instances() const;
  const std::vector<Primitive>& primitivesOf(const Instance& instance);
  Primitive primitive(const GltfValue& place);
  std::optional<GltfNumbers> attribute(const Primitive& primitive, const char* name,
                                       int leastComponents, int mostComponents);
  void checkSize(const std::vector<Instance>& all);
  void add(const Instance& instance);
  Index addPoints(const Primitive& primitive, const Eigen::Affine3d& toWorld);
  void addTriangles(const Primitive& primitive, Index firstPoint, bool isMirrored);
  void weldPoints();
  Vec2f texcoordAt(const GltfNumbers& texcoords, Index vertex);
  Vec3f colorAt(const GltfNumbers& colors, std::uint64_t vertex);

  GltfFile file_;
  ReadReport& report_;
  GltfMaterials materials_;
  std::map<std::string, std::vector<Primitive>> primitives_;  // of meshes, by place
  PolygonMesh mesh_;
  std::vector<Index> materialOfFaces_;
  FaceSets objects_;
  UniqueNames objectNames_;
};

/// The transform of a node relative to its parent.
Eigen::Affine3d transformOf(const GltfValue& node) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (const auto matrix = node.find("matrix")) {
    const std::vector<double> columns = matrix->numbers(16);
    const Eigen::Map<const Eigen::Matrix4d> all(columns.data());
    constexpr double kTolerance = 1e-6;
    if (!((all.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() < kTolerance))
      matrix->fail("is no affine transform: its last row is not 0 0 0 1");
    transform.affine() = all.topRows<3>();
    return transform;
  }
  if (const auto move = node.find("translation")) {
    const std::vector<double> v = move->numbers(3);
    transform.translate(Vec3d(v[0], v[1], v[2]));
  }
  if (const auto turn = node.find("rotation")) {
    const std::vector<double> q = turn->numbers(4);
    transform.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized());
  }
  if (const auto scale = node.find("scale")) {
    const std::vector<double> v = scale->numbers(3);
    transform.scale(Vec3d(v[0], v[1], v[2]));
  }
  return transform;
}

PolygonMesh GltfReader::read() {
  checkExtensions();
  if (file_.trailingBytes() > 0)
    report_.add(Oddity::kTrailingBytes, 0, ReadReport::kNoElement, file_.trailingBytes());
  const std::vector<Instance> all = instances();
  if (all.empty()) throw InputError(report_.file + ": no faces: no node of the scene has a mesh");
  checkSize(all);
  for (const Instance& instance : all) add(instance);
  if (mesh_.pointColors.empty()) weldPoints();
  MeshAttributes& attributes = mesh_.attributes;
  attributes.objects = std::move(objects_);
  if (!materials_.looks().empty()) {
    attributes.looks = materials_.looks();
    for (const Material& look : attributes.looks) attributes.materials.names.push_back(look.name);
    attributes.materials.ofFaces = std::move(materialOfFaces_);
  }
  report_.companions = file_.companions();
  return std::move(mesh_);
}

/// glTF has a vertex for each set of normal and texture coordinates at a position.
void GltfReader::weldPoints() {
  const auto isFinite = [](const Vec3d& point) { return point.allFinite(); };
  if (!std::all_of(mesh_.points.begin(), mesh_.points.end(), isFinite)) return;
  std::vector<Vec3d> points;
  PointWelder<double> welder(points, mesh_.points.size());
  std::vector<Index> newName(mesh_.points.size());
  for (std::size_t v = 0; v < newName.size(); ++v) newName[v] = welder.indexOf(mesh_.points[v]);
  for (Index& v : mesh_.faceVertices) v = newName[v];
  mesh_.points = std::move(points);
}

void GltfReader::checkExtensions() const {
  const auto required = file_.root().find("extensionsRequired");
  if (!required) return;
  constexpr std::array<std::string_view, 6> kKnown = {
      "KHR_texture_transform", "KHR_mesh_quantization", "KHR_texture_basisu",
      "EXT_texture_webp",      "KHR_lights_punctual",   "KHR_materials_"};
  for (const GltfValue& extension : required->items()) {
    const std::string& name = extension.text();
    if (name == kDraco || name.ends_with("_meshopt_compression"))
      extension.fail("is " + quote(name) +
                     ": the mesh is compressed; export it without compression");
    const bool isKnown = std::any_of(kKnown.begin(), kKnown.end(), [&](std::string_view known) {
      return known.ends_with('_') ? name.starts_with(known) : name == known;
    });
    if (!isKnown)
      extension.fail("is " + quote(name) + ", which is not read; export the model without it");
  }
}

/// The nodes at the top of the default scene; without one, of all scenes; without scenes, of all.
std::vector<GltfValue> GltfReader::rootNodes() const {
  const GltfValue root = file_.root();
  std::vector<GltfValue> scenes;
  if (const auto scene = root.find("scene")) {
    scenes.push_back(file_.item("scenes", *scene));
  } else if (const auto all = root.find("scenes")) {
    scenes = all->items();
  }
  std::vector<bool> isIn(file_.size("nodes"), false);
  std::vector<GltfValue> roots;
  for (const GltfValue& scene : scenes) {
    const auto nodes = scene.find("nodes");
    if (!nodes) continue;
    for (const GltfValue& index : nodes->items()) {
      GltfValue node = file_.item("nodes", index);
      if (isIn[index.whole()]) continue;
      isIn[index.whole()] = true;
      roots.push_back(std::move(node));
    }
  }
  const auto nodes = root.find("nodes");
  if (!scenes.empty() || !nodes) return roots;
  const std::vector<GltfValue> all = nodes->items();
  for (const GltfValue& node : all)
    if (const auto children = node.find("children"))
      for (const GltfValue& child : children->items()) {
        file_.item("nodes", child);
        isIn[child.whole()] = true;
      }
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!isIn[i]) roots.push_back(all[i]);
  return roots;
}

/// The nodes with meshes, each before its children.
std::vector<Instance> GltfReader::instances() const {
  std::vector<Instance> found;
  std::vector<Instance> waiting;
  for (GltfValue& node : rootNodes())
    waiting.push_back({std::move(node), Eigen::Affine3d::Identity()});
  std::reverse(waiting.begin(), waiting.end());
  std::unordered_set<std::string> done;
  while (!waiting.empty()) {
    const Instance next = std::move(waiting.back());
    waiting.pop_back();
    const GltfValue& node = next.node;
    if (!done.insert(node.place()).second) node.fail("is the child of two nodes, or of itself");
    const Eigen::Affine3d toWorld = next.toWorld * transformOf(node);
    const std::size_t first = waiting.size();
    if (const auto children = node.find("children"))
      for (const GltfValue& child : children->items())
        waiting.push_back({file_.item("nodes", child), toWorld});
    std::reverse(waiting.begin() + static_cast<std::ptrdiff_t>(first), waiting.end());
    // A skin places its mesh itself.
    if (node.find("mesh"))
      found.push_back({node, node.find("skin") ? Eigen::Affine3d::Identity() : toWorld});
  }
  return found;
}

const std::vector<Primitive>& GltfReader::primitivesOf(const Instance& instance) {
  const GltfValue mesh = file_.item("meshes", instance.node.at("mesh"));
  const auto [known, isNew] = primitives_.try_emplace(mesh.place());
  if (!isNew) return known->second;
  for (const GltfValue& place : mesh.at("primitives").items()) {
    if (place.wholeOr("mode", kTriangles) < kTriangles) {
      report_.add(Oddity::kNoSurface, 0);
      continue;
    }
    if (place.find("targets")) report_.add(Oddity::kPose, 0);
    Primitive read = primitive(place);
    if (read.isCut()) report_.add(Oddity::kShortFace, 0);
    if (read.triangleCount() > 0) known->second.push_back(std::move(read));
  }
  return known->second;
}

Primitive GltfReader::primitive(const GltfValue& place) {
  if (place.hasExtension(kDraco))
    place.fail(std::string("is compressed (") + kDraco + "); export the model without compression");
  const GltfValue attributes = place.at("attributes");
  const GltfValue position = attributes.at("POSITION");
  Primitive read{.place = place, .mode = place.wholeOr("mode", kTriangles), .points = {}};
  if (read.mode > kFan) place.at("mode").fail("is no mode of glTF");
  read.points = file_.numbersOf(file_.item("accessors", position));
  if (read.points.components != 3) position.fail("is an accessor of other than 3 numbers");
  read.arrays.first = std::to_string(position.whole());
  read.texcoords = attribute(read, "TEXCOORD_0", 2, 2);
  read.colors = attribute(read, "COLOR_0", 3, 4);
  if (read.colors) read.arrays.second = std::to_string(attributes.at("COLOR_0").whole());
  if (const auto indices = place.find("indices")) {
    read.indices = file_.numbersOf(file_.item("accessors", *indices));
    const std::uint64_t type = read.indices->type;
    if (read.indices->components != 1 ||
        (type != kUnsignedByteType && type != kUnsignedShortType && type != kUnsignedIntType))
      indices->fail("is an accessor of other than whole numbers without a sign");
  }
  if (const auto material = place.find("material")) read.material = materials_.numberOf(*material);
  return read;
}

/// Numbers of the vertices of a primitive; nothing if it has none of this name.
std::optional<GltfNumbers> GltfReader::attribute(const Primitive& primitive, const char* name,
                                                 int leastComponents, int mostComponents) {
  const auto index = primitive.place.at("attributes").find(name);
  if (!index) return {};
  GltfNumbers numbers = file_.numbersOf(file_.item("accessors", *index));
  if (numbers.count != primitive.points.count)
    index->fail("has " + std::to_string(numbers.count) + " elements for " +
                std::to_string(primitive.points.count) + " positions");
  if (numbers.components < leastComponents || numbers.components > mostComponents)
    index->fail("is an accessor of " + std::to_string(numbers.components) +
                " numbers for each vertex; expected " + std::to_string(leastComponents));
  if (numbers.type == kUnsignedIntType) index->fail("is an accessor of 32-bit integers");
  return numbers;
}

/// Checks that everything fits into memory before any of it is made: few bytes may place a mesh
/// many times.
void GltfReader::checkSize(const std::vector<Instance>& all) {
  std::map<const void*, Counts> known;
  Counts sum;
  for (const Instance& instance : all) {
    const std::vector<Primitive>& primitives = primitivesOf(instance);
    const auto [counts, isNew] = known.try_emplace(&primitives);
    std::set<std::pair<std::string, std::string>> arrays;
    if (isNew)
      for (const Primitive& primitive : primitives) {
        if (arrays.insert(primitive.arrays).second) counts->second.points += primitive.points.count;
        counts->second.triangles += primitive.triangleCount();
      }
    sum.points += counts->second.points;
    sum.triangles += counts->second.triangles;
    if (std::max(sum.points, 3 * sum.triangles) >= kNone)
      throw InputError(report_.file + ": more than 2^32 - 2 vertices or corners; split the model");
  }
  constexpr std::uint64_t kPointBytes = sizeof(Vec3d) + sizeof(Vec3f);
  constexpr std::uint64_t kTriangleBytes = 3 * (sizeof(Index) + sizeof(Vec2f)) + 3 * sizeof(Index);
  MemoryBudget(0).require(sum.points * kPointBytes + sum.triangles * kTriangleBytes,
                          report_.file + ": the mesh", "split the model");
}

void GltfReader::add(const Instance& instance) {
  const std::vector<Primitive>& primitives = primitivesOf(instance);
  const bool isMirrored = instance.toWorld.linear().determinant() < 0;
  const Index firstFace = mesh_.faceCount();
  if (instance.node.find("skin")) report_.add(Oddity::kPose, 0);
  std::map<std::pair<std::string, std::string>, Index> firstPoints;  // primitives share arrays
  for (const Primitive& primitive : primitives) {
    const auto [first, isNew] = firstPoints.try_emplace(primitive.arrays);
    if (isNew) first->second = addPoints(primitive, instance.toWorld);
    addTriangles(primitive, first->second, isMirrored);
  }
  if (mesh_.faceCount() == firstFace) return;
  const GltfValue& node = instance.node;
  const std::string meshName = file_.item("meshes", node.at("mesh")).nameOr(node.place());
  objects_.ofFaces.resize(mesh_.faceCount(), static_cast<Index>(objects_.names.size()));
  objects_.names.push_back(objectNames_.given(node.nameOr(meshName)));
}

Index GltfReader::addPoints(const Primitive& primitive, const Eigen::Affine3d& toWorld) {
  const Index first = mesh_.pointCount();
  const GltfNumbers& points = primitive.points;
  for (std::uint64_t i = 0; i < points.count; ++i)
    mesh_.points.emplace_back(toWorld * Vec3d(points.at(i, 0), points.at(i, 1), points.at(i, 2)));
  std::vector<Vec3f>& colors = mesh_.pointColors;
  if (colors.empty() && !primitive.colors) return first;
  colors.resize(first, Vec3f::Ones());
  if (primitive.colors)
    for (std::uint64_t i = 0; i < points.count; ++i)
      colors.push_back(colorAt(*primitive.colors, i));
  colors.resize(mesh_.points.size(), Vec3f::Ones());
  return first;
}

void GltfReader::addTriangles(const Primitive& primitive, Index firstPoint, bool isMirrored) {
  std::vector<Vec2f>& texcoords = mesh_.attributes.texcoords;
  const Vec2f none = Vec2f::Constant(std::numeric_limits<float>::quiet_NaN());
  if (primitive.texcoords) texcoords.resize(mesh_.faceVertices.size(), none);
  const auto vertexAt = [&](std::uint64_t corner) {
    const auto vertex =
        primitive.indices ? static_cast<std::uint64_t>(primitive.indices->at(corner, 0)) : corner;
    if (vertex >= primitive.points.count)
      primitive.place.fail("refers to vertex " + std::to_string(vertex) + " of " +
                           std::to_string(primitive.points.count) + " (numbered from 0)");
    return static_cast<Index>(vertex);
  };
  const std::uint64_t count = primitive.triangleCount();
  for (std::uint64_t i = 0; i < count; ++i) {
    std::array<std::uint64_t, 3> corners = {3 * i, 3 * i + 1, 3 * i + 2};
    if (primitive.mode == kStrip) corners = {i, i + 1 + i % 2, i + 2 - i % 2};
    if (primitive.mode == kFan) corners = {i + 1, i + 2, 0};
    std::array<Index, 3> vertices = {vertexAt(corners[0]), vertexAt(corners[1]),
                                     vertexAt(corners[2])};
    const auto [a, b, c] = vertices;
    // Triangles with a repeated corner only connect parts of a strip: they become no faces.
    if (primitive.mode != kTriangles && (a == b || b == c || c == a)) continue;
    if (isMirrored) std::swap(vertices[1], vertices[2]);
    for (const Index vertex : vertices) {
      mesh_.faceVertices.push_back(firstPoint + vertex);
      if (primitive.texcoords) texcoords.push_back(texcoordAt(*primitive.texcoords, vertex));
    }
    mesh_.faceOffsets.push_back(mesh_.cornerCount());
  }
  if (!texcoords.empty()) texcoords.resize(mesh_.faceVertices.size(), none);
  materialOfFaces_.resize(mesh_.faceCount(), primitive.material.value_or(kNone));
}

Vec2f GltfReader::texcoordAt(const GltfNumbers& texcoords, Index vertex) {
  const Vec2d texcoord(texcoords.at(vertex, 0), 1 - texcoords.at(vertex, 1));
  if (!texcoord.allFinite()) report_.add(Oddity::kUndefinedTexcoord, 0, vertex);
  return texcoord.cast<float>();
}

Vec3f GltfReader::colorAt(const GltfNumbers& colors, std::uint64_t vertex) {
  Vec3f color;
  for (int channel = 0; channel < 3; ++channel) {
    const double value = colors.at(vertex, channel);
    if (value > 1.00001) report_.add(Oddity::kBrightColor, 0, vertex);
    color[channel] = static_cast<float>(value > 0 ? std::min(value, 1.0) : 0.0);  // nan becomes 0
  }
  return color;
}

}  // namespace

PolygonMesh parseGltf(std::string_view content, ReadLog& log) {
  return GltfReader(content, log).read();
}

}  // namespace vox
