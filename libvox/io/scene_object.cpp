// An object of a scene file: its mesh, transform, smoothing and texture.

#include "libvox/io/scene_object.h"

#include "libvox/core/error.h"
#include "libvox/io/input_file.h"
#include "libvox/io/read_materials.h"
#include "libvox/io/read_mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <locale>
#include <numbers>
#include <sstream>

namespace vox {
namespace {

namespace fs = std::filesystem;

PolygonMesh readInlineMesh(const SceneText& text, const toml::node& points,
                           const toml::node& faces) {
  PolygonMesh mesh;
  for (const toml::node& point : requireArray(text, points, "points"))
    mesh.points.push_back(requireVector(text, point, "a point"));
  if (mesh.points.empty()) text.fail(points, "points must not be empty");

  std::vector<Index> corners;
  for (const toml::node& face : requireArray(text, faces, "faces")) {
    corners.clear();
    for (const toml::node& corner : requireArray(text, face, "a face"))
      corners.push_back(static_cast<Index>(
          requireInteger(text, corner, "a corner (0-based)", 0, mesh.pointCount() - 1)));
    if (corners.size() < 3) text.fail(face, "a face must have at least 3 corners");
    mesh.addFace(corners);
  }
  if (mesh.faceCount() == 0) text.fail(faces, "faces must not be empty");
  return mesh;
}

struct Transform {
  Eigen::Affine3d map;
  Eigen::Affine3d inverse;
  bool mirrors;  ///< an odd number of scales is negative (the determinant might underflow to 0)
};

Transform readTransform(const SceneText& text, const toml::table& table) {
  requireKnownKeys(text, table, "transform", {"scale", "rotate", "translate"});
  Vec3d scale = Vec3d::Ones();
  Vec3d degrees = Vec3d::Zero();
  Vec3d translate = Vec3d::Zero();
  if (const auto* node = table.get("scale")) {
    if (node->is_number())
      scale.setConstant(requireNumber(text, *node, "scale"));
    else
      scale = requireVector(text, *node, "scale");
    if ((scale.array() == 0).any()) text.fail(*node, "scale must not be 0");
  }
  if (const auto* node = table.get("rotate")) degrees = requireVector(text, *node, "rotate");
  if (const auto* node = table.get("translate"))
    translate = requireVector(text, *node, "translate");

  const Vec3d radians = degrees * (std::numbers::pi / 180);
  const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(radians.z(), Vec3d::UnitZ()) *
                                    Eigen::AngleAxisd(radians.y(), Vec3d::UnitY()) *
                                    Eigen::AngleAxisd(radians.x(), Vec3d::UnitX()))
                                       .toRotationMatrix();
  const Eigen::Affine3d map =
      Eigen::Translation3d(translate) * Eigen::Affine3d(rotation) * Eigen::Scaling(scale);
  const Eigen::Affine3d inverse = Eigen::Scaling(Vec3d(scale.cwiseInverse())) *
                                  Eigen::Affine3d(rotation.transpose()) *
                                  Eigen::Translation3d(-translate);
  return {map, inverse, (scale.array() < 0).count() % 2 == 1};
}

void reverseFaces(PolygonMesh& mesh) {
  const auto reverse = [&](auto& ofCorners) {
    for (Index f = 0; f < mesh.faceCount(); ++f)
      std::reverse(ofCorners.begin() + mesh.faceOffsets[f] + 1,
                   ofCorners.begin() + mesh.faceOffsets[f + 1]);
  };
  reverse(mesh.faceVertices);
  if (!mesh.attributes.texcoords.empty()) reverse(mesh.attributes.texcoords);
}

void transformObject(const SceneText& text, const toml::node& node, SceneObject& object) {
  const Transform transform = readTransform(text, requireTable(text, node, "transform"));
  object.fromWorld = transform.inverse;
  for (Vec3d& point : object.mesh.points) {
    point = transform.map * point;
    if (!(point.cwiseAbs().maxCoeff() <= kMaxCoordinate))
      text.fail(node, "transform moves the object beyond 1e15");
  }
  if (transform.mirrors) reverseFaces(object.mesh);
}

PolygonMesh readObjectMesh(SceneText& text, const toml::table& table, Scene& scene,
                           ReadReport& report) {
  const auto* mesh = table.get("mesh");
  const auto* points = table.get("points");
  const auto* faces = table.get("faces");
  if (faces != nullptr && faces->is_string())
    text.fail(*faces, "faces is a list of faces; for concave faces there is concave_faces");
  if (mesh != nullptr && points == nullptr && faces == nullptr) {
    const fs::path file = text.file.parent_path() / requireString(text, *mesh, "mesh");
    scene.files.push_back(file);
    try {
      PolygonMesh read = readMeshInto(text.hash, file, report);
      scene.files.insert(scene.files.end(), report.companions.begin(), report.companions.end());
      return read;
    } catch (const InputError& error) {
      text.fail(*mesh, std::string("mesh: ") + error.what());
    }
  }
  if (mesh == nullptr && points != nullptr && faces != nullptr)
    return readInlineMesh(text, *points, *faces);
  text.fail(table, "an object needs either mesh, or points and faces");
}

Index readVertex(const SceneText& text, const toml::node& node, Index pointCount) {
  return static_cast<Index>(
      requireInteger(text, node, "a vertex (0-based)", 0, std::int64_t{pointCount} - 1));
}

std::vector<Index> readVertexList(const SceneText& text, const toml::node& node, const char* key,
                                  Index pointCount) {
  std::vector<Index> vertices;
  for (const toml::node& vertex : requireArray(text, node, key))
    vertices.push_back(readVertex(text, vertex, pointCount));
  return vertices;
}

std::vector<PointPair> readEdgeList(const SceneText& text, const toml::node& node,
                                    Index pointCount) {
  std::vector<PointPair> edges;
  for (const toml::node& edge : requireArray(text, node, "crease_edges")) {
    const std::vector<Index> ends = readVertexList(text, edge, "an edge", pointCount);
    if (ends.size() != 2) text.fail(edge, "an edge must be a list of two vertices, [3, 7]");
    edges.push_back({ends[0], ends[1]});
  }
  return edges;
}

/// Reads the value of a key `crease`: 40, "groups" or "40,groups".
CreaseRule readCrease(const SceneText& text, const toml::node& node) {
  std::ostringstream name;
  name.imbue(std::locale::classic());
  name.precision(17);
  if (node.is_number())
    name << requireNumber(text, node, "crease");
  else
    name << requireString(text, node, "crease");
  if (const auto rule = creaseRuleNamed(name.str())) return *rule;
  text.fail(node, std::string("crease must be ") + kAllCreaseRuleNames);
}

SmoothingOptions readSmoothing(const SceneText& text, const toml::table& table, Index pointCount) {
  SmoothingOptions smoothing;
  readNamed(text, table, "boundary", kBoundaryRuleNames, smoothing.boundary);
  readNamed(text, table, "interpolate", kInterpolateNames, smoothing.interpolate);
  readNamed(text, table, "concave_faces", kFaceRuleNames, smoothing.faces);
  if (const auto* node = table.get("interpolate_vertices"))
    smoothing.interpolatedVertices =
        readVertexList(text, *node, "interpolate_vertices", pointCount);
  if (const auto* node = table.get("crease")) smoothing.crease = readCrease(text, *node);
  if (const auto* node = table.get("crease_edges"))
    smoothing.creaseEdges = readEdgeList(text, *node, pointCount);
  if (const auto* node = table.get("corner_vertices"))
    smoothing.cornerVertices = readVertexList(text, *node, "corner_vertices", pointCount);
  return smoothing;
}

/// Value of a texture parameter as the text that setTexture reads: the numbers of a list are joined
/// by ':', the lists of a list by '/'.
std::string textureValue(const SceneText& text, const toml::node& node, const std::string& name) {
  if (node.is_string()) return requireString(text, node, name);
  if (node.is_number()) {
    std::ostringstream number;
    number.imbue(std::locale::classic());
    number.precision(17);
    number << requireNumber(text, node, name);
    return number.str();
  }
  std::string value;
  const toml::array* const list = node.as_array();
  if (list == nullptr) text.fail(node, name + " must be a number, a text or a list of them");
  for (const toml::node& item : *list) {
    const char* const separator = item.is_number() ? ":" : "/";
    value += (value.empty() ? "" : separator) + textureValue(text, item, name);
  }
  return value;
}

/// Reads the value of a key `texture`: "marble", or { kind = "marble", scale = 0.2 }.
TextureSpec readTexture(const SceneText& text, const toml::node& node) {
  const toml::node* at = &node;  // the node that an error is about
  try {
    const auto* table = node.as_table();
    if (table == nullptr) {
      const TextureSpec texture = textureNamed(requireString(text, node, "texture"));
      requireComplete(texture);
      return texture;
    }
    const auto* kind = table->get("kind");
    if (kind == nullptr) text.fail(node, "a texture needs a kind, one of " + allTextureNames());
    at = kind;
    TextureSpec texture = textureNamed(requireString(text, *kind, "kind"));
    for (const auto& [key, value] : *table) {
      if (key.str() == "kind") continue;
      at = &value;
      const std::string name(key.str());
      setTexture(texture, name, textureValue(text, value, name));
    }
    at = kind;
    requireComplete(texture);
    if (!texture.file.empty()) texture.file = (text.file.parent_path() / texture.file).string();
    return texture;
  } catch (const UsageError& error) {
    text.fail(*at, error.what());
  }
}

}  // namespace

PolygonMesh readMeshInto(ContentHash& hash, const fs::path& file, ReadReport& report) {
  requireInputFile(file);
  requireMeshExtension(file);
  const FileContent content = contentsOf(file);
  hash.addFile(content);
  PolygonMesh mesh = parseMesh(file, content, report);
  readMaterials(file, mesh, report);
  for (const std::string& other : report.companions) hash.addFile(contentsOf(other));
  return mesh;
}

void scaleObject(SceneObject& object, double scale, const fs::path& file) {
  for (Vec3d& point : object.mesh.points) {
    point *= scale;
    if (!(point.cwiseAbs().maxCoeff() <= kMaxCoordinate))
      throw InputError(file.string() + ": the scale moves " + object.name + " beyond 1e15");
  }
  object.fromWorld = object.fromWorld * Eigen::Scaling(1 / scale);
}

SceneObject readObject(SceneText& text, const toml::table& table, Scene& scene) {
  requireKnownKeys(text, table, "[[object]]",
                   {"name", "mesh", "points", "faces", "transform", "boundary", "interpolate",
                    "interpolate_vertices", "concave_faces", "crease", "crease_edges",
                    "corner_vertices", "until", "voxelize", "texture", "drop_components"});
  SceneObject object;
  object.name = "object " + std::to_string(scene.objects.size() + 1);
  if (const auto* name = table.get("name")) object.name = requireString(text, *name, "name");
  object.mesh = readObjectMesh(text, table, scene, object.reading);
  if (const auto* transform = table.get("transform")) transformObject(text, *transform, object);
  object.smoothing = readSmoothing(text, table, object.mesh.pointCount());
  if (const auto* until = table.get("until")) object.until = requireStopRule(text, *until);
  readNamed(text, table, "voxelize", kVoxelizeNames, object.voxelize);
  if (const auto* texture = table.get("texture")) object.texture = readTexture(text, *texture);
  if (const auto* drop = table.get("drop_components"))
    object.dropComponents = requireComponentLimit(text, *drop);
  return object;
}

}  // namespace vox
