// Scene files: the paper's display file (section 9) in TOML.

#include "libvox/io/scene_file.h"

#include "libvox/core/error.h"
#include "libvox/core/hash.h"
#include "libvox/io/input_file.h"
#include "libvox/io/scene_object.h"
#include "libvox/io/scene_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vox {
namespace {

namespace fs = std::filesystem;

std::vector<GridKind> readGrids(const SceneText& text, const toml::node& node) {
  std::vector<GridKind> grids;
  for (const toml::node& item : requireArray(text, node, "grids")) {
    const std::string name = requireString(text, item, "a grid");
    const auto kind = namedIn(kGridNames, name);
    if (!kind)
      text.fail(item, "unknown grid " + quote(name) + "; known are " + allNamesIn(kGridNames));
    if (std::find(grids.begin(), grids.end(), *kind) == grids.end()) grids.push_back(*kind);
  }
  if (grids.empty()) text.fail(node, "grids must name at least one of " + allNamesIn(kGridNames));
  return grids;
}

/// 3, or [2, 5]: inside, outside.
BandWidths readBand(const SceneText& text, const toml::node& node) {
  if (!node.is_array()) return requireNumber(text, node, "band");
  const toml::array& widths = requireArray(text, node, "band");
  if (widths.size() != 2) text.fail(node, "band must be one number, or two: [inside, outside]");
  return {requireNumber(text, widths[0], "band"), requireNumber(text, widths[1], "band")};
}

/// "bounds": the low corner of a box, then the high one.
std::array<double, 6> readBounds(const SceneText& text, const toml::node& node) {
  std::array<double, 6> bounds{};
  const toml::array& numbers = requireArray(text, node, "bounds");
  if (numbers.size() != bounds.size())
    text.fail(node, "bounds must be six numbers: [x0, y0, z0, x1, y1, z1]");
  for (std::size_t i = 0; i < bounds.size(); ++i)
    bounds[i] = requireNumber(text, numbers[i], "bounds");
  for (std::size_t i = 0; i < 3; ++i)
    if (!(bounds[i] <= bounds[i + 3]))
      text.fail(node, "bounds must have its low corner first: [x0, y0, z0, x1, y1, z1]");
  return bounds;
}

VolumeOptions readVolumeOptions(const SceneText& text, const toml::table& table) {
  VolumeOptions volume;
  readNamed(text, table, "fill", kFillNames, volume.fill);
  readNamed(text, table, "edge", kEdgeNames, volume.edge);
  readNamed(text, table, "alpha", kAlphaNames, volume.alpha);
  readNamed(text, table, "open_mesh", kOpenMeshNames, volume.openMesh);
  readNamed(text, table, "compression", kCompressionNames, volume.compression);
  readNamed(text, table, "target", kTargetNames, volume.target);
  readNamed(text, table, "up", kUpAxisNames, volume.up);
  if (const auto* half = table.get("half")) volume.half = requireBoolean(text, *half, "half");
  if (const auto* gain = table.get("gain")) volume.gain = requireNumber(text, *gain, "gain");
  if (const auto* close = table.get("close"))
    volume.close = static_cast<int>(requireInteger(text, *close, "close", 0, kWidestClosing));
  if (const auto* band = table.get("band")) volume.band = readBand(text, *band);
  if (const auto* tolerance = table.get("tolerance"))
    volume.tolerance = requireNumber(text, *tolerance, "tolerance");
  return volume;
}

void readConvert(const SceneText& text, const toml::table& table, Scene& scene) {
  requireKnownKeys(text, table, "[convert]",
                   {"dim",    "voxel_size", "bounds",   "grids",       "fill",
                    "edge",   "alpha",      "gain",     "open_mesh",   "close",
                    "band",   "tolerance",  "half",     "compression", "target",
                    "up",     "until",      "voxelize", "weld",        "drop_components",
                    "strict", "part_by",    "split"});
  if (const auto* dim = table.get("dim"))
    scene.dim =
        static_cast<int>(requireInteger(text, *dim, "dim", 1, std::numeric_limits<int>::max()));
  if (const auto* size = table.get("voxel_size")) {
    scene.voxelSize = requireNumber(text, *size, "voxel_size");
    if (!(*scene.voxelSize > 0)) text.fail(*size, "voxel_size must be positive");
    if (scene.dim) text.fail(*size, "dim and voxel_size cannot both be given");
  }
  if (const auto* bounds = table.get("bounds")) scene.bounds = readBounds(text, *bounds);
  if (const auto* grids = table.get("grids")) scene.grids = readGrids(text, *grids);
  readNamed(text, table, "part_by", kPartByNames, scene.partBy);
  readNamed(text, table, "split", kSplitNames, scene.split);
  scene.volume = readVolumeOptions(text, table);
  if (const auto* until = table.get("until")) scene.until = requireStopRule(text, *until);
  readNamed(text, table, "voxelize", kVoxelizeNames, scene.voxelize);
  if (const auto* weld = table.get("weld")) {
    scene.weldTolerance = requireNumber(text, *weld, "weld");
    if (*scene.weldTolerance < 0) text.fail(*weld, "weld must be 0 or more");
  }
  if (const auto* drop = table.get("drop_components"))
    scene.dropComponents = requireComponentLimit(text, *drop);
  if (const auto* strict = table.get("strict"))
    scene.strict = requireBoolean(text, *strict, "strict");
}

void requireScale(const std::optional<double>& scale) {
  if (scale && !(*scale > 0 && std::isfinite(*scale)))
    throw UsageError("--scale must be a positive number");
}

void scaleAll(Scene& scene, const std::optional<double>& scale) {
  if (!scale) return;
  for (SceneObject& object : scene.objects) scaleObject(object, *scale, scene.files[0]);
}

}  // namespace

Scene parseScene(const fs::path& file, std::string_view content, std::optional<double> scale) {
  requireScale(scale);
  SceneText text(file, content);
  Scene scene;
  scene.files.push_back(file);
  requireKnownKeys(text, text.root, "the scene", {"scale", "convert", "object"});
  if (const auto* node = text.root.get("scale")) {
    const double ofScene = requireNumber(text, *node, "scale");
    if (!(ofScene > 0)) text.fail(*node, "scale must be positive");
    if (!scale) scale = ofScene;
  }
  if (const auto* convert = text.root.get("convert"))
    readConvert(text, requireTable(text, *convert, "[convert]"), scene);
  if (const auto* objects = text.root.get("object"))
    for (const toml::node& object : requireArray(text, *objects, "[[object]]"))
      scene.objects.push_back(readObject(text, requireTable(text, object, "[[object]]"), scene));
  if (scene.objects.empty()) throw InputError(file.string() + ": has no [[object]] to convert");
  scaleAll(scene, scale);
  scene.inputHash = text.hash.hex();
  return scene;
}

Scene readScene(const fs::path& file, std::optional<double> scale) {
  if (lowerExtension(file) == ".toml") return parseScene(file, contentsOf(file), scale);
  requireScale(scale);
  Scene scene;
  ContentHash hash;
  scene.files.push_back(file);
  SceneObject& object = scene.objects.emplace_back();
  object.name = file.stem().string();
  object.mesh = readMeshInto(hash, file, object.reading);
  const std::vector<std::string>& others = object.reading.companions;
  scene.files.insert(scene.files.end(), others.begin(), others.end());
  scaleAll(scene, scale);
  scene.inputHash = hash.hex();
  return scene;
}

}  // namespace vox
