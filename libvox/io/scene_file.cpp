// Scene files: the paper's display file (section 9) in TOML.

#include "libvox/io/scene_file.h"

#include "libvox/core/error.h"
#include "libvox/core/hash.h"
#include "libvox/io/input_file.h"
#include "libvox/io/read_mesh.h"
#include "libvox/io/text_scanner.h"

#include <Eigen/Geometry>
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <locale>
#include <numbers>
#include <sstream>
#include <string_view>

namespace vox {
namespace {

namespace fs = std::filesystem;

/// A TOML document that knows its file name, for messages.
struct SceneText {
  fs::path file;
  toml::table root;
  ContentHash hash;  ///< of this file and the meshes it names

  [[noreturn]] void fail(const toml::source_region& at, const std::string& what) const {
    throw InputError(file.string() + ":" + std::to_string(at.begin.line) + ":" +
                     std::to_string(at.begin.column) + ": " + what);
  }
  [[noreturn]] void fail(const toml::node& at, const std::string& what) const {
    fail(at.source(), what);
  }
};

/// Reads a mesh and adds the content of its file to a hash.
PolygonMesh readMeshInto(ContentHash& hash, const fs::path& file) {
  requireInputFile(file);
  requireMeshExtension(file);
  const std::string content = contentsOf(file);
  hash.addFile(content);
  return parseMesh(file, content);
}

void requireKnownKeys(const SceneText& scene, const toml::table& table, const std::string& where,
                      std::initializer_list<std::string_view> known) {
  for (const auto& [key, value] : table) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    std::string names;
    for (const auto name : known) names += (names.empty() ? "" : ", ") + std::string(name);
    scene.fail(key.source(),
               "unknown key " + quote(key.str()) + " in " + where + "; known are " + names);
  }
}

const toml::table& requireTable(const SceneText& scene, const toml::node& node,
                                const std::string& name) {
  if (const auto* table = node.as_table()) return *table;
  scene.fail(node, name + " must be a table");
}

const toml::array& requireArray(const SceneText& scene, const toml::node& node,
                                const std::string& name) {
  if (const auto* array = node.as_array()) return *array;
  scene.fail(node, name + " must be an array");
}

std::string requireString(const SceneText& scene, const toml::node& node, const std::string& name) {
  const auto text = node.value_exact<std::string>();
  if (text && text->find('\0') != std::string::npos) scene.fail(node, name + " holds a NUL");
  if (text) return *text;
  scene.fail(node, name + " must be a string");
}

bool requireBoolean(const SceneText& scene, const toml::node& node, const std::string& name) {
  if (const auto* flag = node.as_boolean()) return flag->get();
  scene.fail(node, name + " must be true or false");
}

double requireNumber(const SceneText& scene, const toml::node& node, const std::string& name) {
  if (node.is_number()) {
    const double number = *node.value<double>();
    if (!std::isfinite(number) || std::abs(number) > kMaxCoordinate)
      scene.fail(node, name + " must be finite and at most 1e15 in size");
    return number;
  }
  scene.fail(node, name + " must be a number");
}

std::int64_t requireInteger(const SceneText& scene, const toml::node& node, const std::string& name,
                            std::int64_t low, std::int64_t high) {
  const auto number = node.value_exact<std::int64_t>();
  if (!number) scene.fail(node, name + " must be an integer");
  if (*number < low || *number > high)
    scene.fail(node, name + " must lie between " + std::to_string(low) + " and " +
                         std::to_string(high) + ", not " + std::to_string(*number));
  return *number;
}

Vec3d requireVector(const SceneText& scene, const toml::node& node, const std::string& name) {
  const toml::array& array = requireArray(scene, node, name);
  if (array.size() != 3) scene.fail(node, name + " must have 3 numbers");
  return {requireNumber(scene, array[0], name), requireNumber(scene, array[1], name),
          requireNumber(scene, array[2], name)};
}

[[noreturn]] void failStopRule(const SceneText& scene, const toml::node& node) {
  scene.fail(node,
             "until must be \"voxel\" or { levels = K, diameter = D, angle = DEG, flatness = D }, "
             "some of them");
}

/// until = "voxel" or { levels = 3, diameter = 4, angle = 5, flatness = 0.1 }, some of them
StopRule readStopRule(const SceneText& scene, const toml::node& node) {
  const auto* table = node.as_table();
  StopRule rule;
  if (table == nullptr) {
    if (node.value_exact<std::string>() != stopRuleName(rule)) failStopRule(scene, node);
    return rule;
  }
  requireKnownKeys(scene, *table, "until", {"levels", "diameter", "angle", "flatness"});
  if (const auto* levels = table->get("levels"))
    rule.levels = static_cast<int>(requireInteger(scene, *levels, "levels", 0, kMostLevels));
  const auto read = [&](const char* key, std::optional<double> StopRule::*limit) {
    const auto* value = table->get(key);
    if (value == nullptr) return;
    StopRule alone;
    rule.*limit = alone.*limit = requireNumber(scene, *value, key);
    if (const std::string fault = faultOf(alone); !fault.empty()) scene.fail(*value, fault);
  };
  read("diameter", &StopRule::diameter);
  read("angle", &StopRule::angle);
  read("flatness", &StopRule::flatness);
  if (rule.untilVoxel()) failStopRule(scene, node);
  return rule;
}

Voxelize readVoxelize(const SceneText& scene, const toml::node& node) {
  const std::string name = requireString(scene, node, "voxelize");
  const auto voxelize = voxelizeNamed(name);
  if (!voxelize)
    scene.fail(node, "voxelize must be one of " + allVoxelizeNames() + ", not " + quote(name));
  return *voxelize;
}

// [convert]

std::vector<GridKind> readGrids(const SceneText& scene, const toml::node& node) {
  std::vector<GridKind> grids;
  for (const toml::node& item : requireArray(scene, node, "grids")) {
    const std::string name = requireString(scene, item, "a grid");
    const auto kind = gridNamed(name);
    if (!kind) scene.fail(item, "unknown grid " + quote(name) + "; known are " + allGridNames());
    if (std::find(grids.begin(), grids.end(), *kind) == grids.end()) grids.push_back(*kind);
  }
  if (grids.empty()) scene.fail(node, "grids must name at least one of " + allGridNames());
  return grids;
}

/// A value by its name, if the table has the key.
template <class Enum, std::size_t N>
void readNamed(const SceneText& text, const toml::table& table, const char* key,
               const NameTable<Enum, N>& names, std::optional<Enum>& value) {
  const auto* node = table.get(key);
  if (node == nullptr) return;
  const std::string name = requireString(text, *node, key);
  value = namedIn(names, name);
  if (!value)
    text.fail(*node,
              std::string(key) + " must be one of " + allNamesIn(names) + ", not " + quote(name));
}

VolumeOptions readVolumeOptions(const SceneText& text, const toml::table& table) {
  VolumeOptions volume;
  readNamed(text, table, "fill", kFillNames, volume.fill);
  readNamed(text, table, "open_mesh", kOpenMeshNames, volume.openMesh);
  readNamed(text, table, "compression", kCompressionNames, volume.compression);
  readNamed(text, table, "target", kTargetNames, volume.target);
  readNamed(text, table, "up", kUpAxisNames, volume.up);
  if (const auto* half = table.get("half")) volume.half = requireBoolean(text, *half, "half");
  if (const auto* gain = table.get("gain")) volume.gain = requireNumber(text, *gain, "gain");
  if (const auto* band = table.get("band")) volume.band = requireNumber(text, *band, "band");
  if (const auto* tolerance = table.get("tolerance"))
    volume.tolerance = requireNumber(text, *tolerance, "tolerance");
  return volume;
}

void readConvert(const SceneText& text, const toml::table& table, Scene& scene) {
  requireKnownKeys(text, table, "[convert]",
                   {"dim", "voxel_size", "grids", "fill", "gain", "open_mesh", "band", "tolerance",
                    "half", "compression", "target", "up", "until", "voxelize", "weld", "strict"});
  if (const auto* dim = table.get("dim"))
    scene.dim =
        static_cast<int>(requireInteger(text, *dim, "dim", 1, std::numeric_limits<int>::max()));
  if (const auto* size = table.get("voxel_size")) {
    scene.voxelSize = requireNumber(text, *size, "voxel_size");
    if (!(*scene.voxelSize > 0)) text.fail(*size, "voxel_size must be positive");
    if (scene.dim) text.fail(*size, "dim and voxel_size cannot both be given");
  }
  if (const auto* grids = table.get("grids")) scene.grids = readGrids(text, *grids);
  scene.volume = readVolumeOptions(text, table);
  if (const auto* until = table.get("until")) scene.until = readStopRule(text, *until);
  if (const auto* way = table.get("voxelize")) scene.voxelize = readVoxelize(text, *way);
  if (const auto* weld = table.get("weld")) {
    scene.weldTolerance = requireNumber(text, *weld, "weld");
    if (*scene.weldTolerance < 0) text.fail(*weld, "weld must be 0 or more");
  }
  if (const auto* strict = table.get("strict"))
    scene.strict = requireBoolean(text, *strict, "strict");
}

// [[object]]

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
  bool mirrors;  ///< an odd number of negative scales; the determinant itself may underflow
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
  for (Index f = 0; f < mesh.faceCount(); ++f)
    std::reverse(mesh.faceVertices.begin() + mesh.faceOffsets[f] + 1,
                 mesh.faceVertices.begin() + mesh.faceOffsets[f + 1]);
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

PolygonMesh readObjectMesh(SceneText& text, const toml::table& table, Scene& scene) {
  const auto* mesh = table.get("mesh");
  const auto* points = table.get("points");
  const auto* faces = table.get("faces");
  if (mesh != nullptr && points == nullptr && faces == nullptr) {
    const fs::path file = text.file.parent_path() / requireString(text, *mesh, "mesh");
    scene.files.push_back(file);
    try {
      requireInputFile(file);
      requireMeshExtension(file);
      return readMeshInto(text.hash, file);
    } catch (const InputError& error) {
      text.fail(*mesh, std::string("mesh: ") + error.what());
    }
  }
  if (mesh == nullptr && points != nullptr && faces != nullptr)
    return readInlineMesh(text, *points, *faces);
  text.fail(table, "an object needs either mesh, or points and faces");
}

std::vector<Index> readVertexList(const SceneText& text, const toml::node& node, Index pointCount) {
  std::vector<Index> vertices;
  for (const toml::node& vertex : requireArray(text, node, "interpolate_vertices"))
    vertices.push_back(static_cast<Index>(
        requireInteger(text, vertex, "a vertex (0-based)", 0, std::int64_t{pointCount} - 1)));
  return vertices;
}

SmoothingOptions readSmoothing(const SceneText& text, const toml::table& table, Index pointCount) {
  SmoothingOptions smoothing;
  if (const auto* node = table.get("boundary")) {
    const std::string name = requireString(text, *node, "boundary");
    smoothing.boundary = boundaryRuleNamed(name);
    if (!smoothing.boundary)
      text.fail(*node,
                "boundary must be one of " + allBoundaryRuleNames() + ", not " + quote(name));
  }
  if (const auto* node = table.get("interpolate")) {
    const std::string name = requireString(text, *node, "interpolate");
    smoothing.interpolate = interpolateNamed(name);
    if (!smoothing.interpolate)
      text.fail(*node,
                "interpolate must be one of " + allInterpolateNames() + ", not " + quote(name));
  }
  if (const auto* node = table.get("interpolate_vertices"))
    smoothing.interpolatedVertices = readVertexList(text, *node, pointCount);
  return smoothing;
}

/// A value as parseTexture has it: numbers of a list with : between them, lists of a list with /.
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

/// texture = "marble" or { kind = "marble", scale = 0.2 }
TextureSpec readTexture(const SceneText& text, const toml::node& node) {
  const toml::node* at = &node;  // what is wrong, if anything is
  try {
    const auto* table = node.as_table();
    if (table == nullptr) return textureNamed(requireString(text, node, "texture"));
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
    return texture;
  } catch (const UsageError& error) {
    text.fail(*at, error.what());
  }
}

SceneObject readObject(SceneText& text, const toml::table& table, Scene& scene) {
  requireKnownKeys(text, table, "[[object]]",
                   {"name", "mesh", "points", "faces", "transform", "boundary", "interpolate",
                    "interpolate_vertices", "until", "voxelize", "texture"});
  SceneObject object;
  object.name = "object " + std::to_string(scene.objects.size() + 1);
  if (const auto* name = table.get("name")) object.name = requireString(text, *name, "name");
  object.mesh = readObjectMesh(text, table, scene);
  if (const auto* transform = table.get("transform")) transformObject(text, *transform, object);
  object.smoothing = readSmoothing(text, table, object.mesh.pointCount());
  if (const auto* until = table.get("until")) object.until = readStopRule(text, *until);
  if (const auto* way = table.get("voxelize")) object.voxelize = readVoxelize(text, *way);
  if (const auto* texture = table.get("texture")) object.texture = readTexture(text, *texture);
  return object;
}

/// Refuses dotted keys so deep that the parser, which recurses, would run out of stack.
void requireShallowKeys(const SceneText& text, std::string_view content) {
  constexpr int kMostDots = 1000;
  int dots = 0;
  toml::source_index line = 1;
  for (const char c : content) {
    const bool inKey = std::isalnum(static_cast<unsigned char>(c)) ||
                       std::string_view("_-.\"' \t").find(c) != std::string_view::npos;
    dots = !inKey ? 0 : dots + (c == '.');
    line += c == '\n';
    if (dots > kMostDots) text.fail({{line, 1}, {line, 1}, nullptr}, "a key nested too deeply");
  }
}

void parseToml(const fs::path& file, std::string_view content, SceneText& text) {
  text.file = file;
  text.hash.addFile(content);
  requireShallowKeys(text, content);
  try {
    text.root = toml::parse(content, file.string());
  } catch (const toml::parse_error& wrong) {
    text.fail(wrong.source(), std::string(wrong.description()));
  }
}

}  // namespace

Scene parseScene(const fs::path& file, std::string_view content) {
  SceneText text;
  parseToml(file, content, text);
  Scene scene;
  scene.files.push_back(file);
  requireKnownKeys(text, text.root, "the scene", {"convert", "object"});
  if (const auto* convert = text.root.get("convert"))
    readConvert(text, requireTable(text, *convert, "[convert]"), scene);
  if (const auto* objects = text.root.get("object"))
    for (const toml::node& object : requireArray(text, *objects, "[[object]]"))
      scene.objects.push_back(readObject(text, requireTable(text, object, "[[object]]"), scene));
  if (scene.objects.empty()) throw InputError(file.string() + ": has no [[object]] to convert");
  scene.inputHash = text.hash.hex();
  return scene;
}

Scene readScene(const fs::path& file) {
  if (lowerExtension(file) == ".toml") return parseScene(file, contentsOf(file));
  Scene scene;
  ContentHash hash;
  scene.files.push_back(file);
  scene.objects.push_back({file.stem().string(), readMeshInto(hash, file)});
  scene.inputHash = hash.hex();
  return scene;
}

}  // namespace vox
