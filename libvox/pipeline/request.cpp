// Command line > object > scene > default.

#include "libvox/pipeline/request.h"

#include "libvox/core/error.h"
#include "libvox/io/write_vdb.h"
#include "libvox/options/option_text.h"
#include "libvox/pipeline/grids.h"

#include <algorithm>
#include <initializer_list>

namespace vox {
namespace {

/// The first value that is set, else the default.
template <class T>
T firstSet(std::initializer_list<std::optional<T>> values, T byDefault = {}) {
  for (const std::optional<T>& value : values)
    if (value) return *value;
  return byDefault;
}

ObjectPreparation preparationOf(const Scene& scene, const SceneObject& object,
                                const PreparationOptions& options) {
  const SmoothingOptions& first = options.smoothing;
  const SmoothingOptions& second = object.smoothing;
  ObjectPreparation result;
  result.boundary = firstSet({first.boundary, second.boundary}, result.boundary);
  // `interpolate` and `interpolatedVertices` are one choice: options that set one replace both.
  const bool byOptions = first.interpolate || first.interpolatedVertices;
  const SmoothingOptions& chosen = byOptions ? first : second;
  result.interpolate = chosen.interpolate.value_or(result.interpolate);
  if (chosen.interpolatedVertices) result.interpolatedVertices = *chosen.interpolatedVertices;
  result.faces = firstSet({first.faces, second.faces}, result.faces);
  result.crease = firstSet({first.crease, second.crease});
  result.creaseEdges = firstSet({first.creaseEdges, second.creaseEdges});
  result.cornerVertices = firstSet({first.cornerVertices, second.cornerVertices});
  result.weldTolerance = firstSet({options.weldTolerance, scene.weldTolerance});
  result.dropComponents =
      firstSet({options.dropComponents, object.dropComponents, scene.dropComponents});
  result.strict = firstSet({options.strict, scene.strict});
  return result;
}

VolumeSettings volumeOf(const VolumeOptions& first, const VolumeOptions& second) {
  VolumeSettings all;
  const auto choose = [&](auto VolumeOptions::*option, auto& setting) {
    setting = firstSet({first.*option, second.*option}, setting);
  };
  choose(&VolumeOptions::fill, all.fill);
  choose(&VolumeOptions::alpha, all.alpha);
  choose(&VolumeOptions::openMesh, all.openMesh);
  choose(&VolumeOptions::close, all.close);
  choose(&VolumeOptions::band, all.band);
  choose(&VolumeOptions::half, all.half);
  choose(&VolumeOptions::target, all.target);
  all.edge =
      firstSet({first.edge, second.edge}, defaultEdge(first.target ? first.target : second.target));
  all.tolerance = first.tolerance ? first.tolerance : second.tolerance;
  all.gain = first.gain ? first.gain : second.gain;
  all.compression = first.compression ? first.compression : second.compression;
  requireValid(all);
  if (all.compression) requireCompression(*all.compression);
  return all;
}

std::vector<GridKind> gridsOf(const Scene& scene, const ConvertOptions& options) {
  std::vector<GridKind> kinds = firstSet({options.grids, scene.grids}, {GridKind::kDensity});
  const bool colored = std::find(kinds.begin(), kinds.end(), GridKind::kColor) != kinds.end();
  if (!options.texture || colored) return kinds;
  if (options.grids) throw UsageError("--texture needs color among --grids");
  kinds.push_back(GridKind::kColor);
  return kinds;
}

/// Decides what parts are, and whether the density is split into them.
void resolveParts(const Scene& scene, const ConvertOptions& options, Request& request) {
  const auto& kinds = request.grids;
  const bool hasDensity = std::find(kinds.begin(), kinds.end(), GridKind::kDensity) != kinds.end();
  // Options may ask for other grids than a scene that splits its density.
  const bool sceneCounts = hasDensity || !options.grids;
  const auto split = options.split || !sceneCounts ? options.split : scene.split;
  request.splits = split.has_value();
  if (!request.hasParts()) return;
  if (split && !hasDensity) throw UsageError("--split splits the grid density; name it in --grids");
  const bool byObject = split == Split::kObject;
  if (byObject && options.partBy.value_or(PartBy::kObject) != PartBy::kObject)
    throw UsageError("--split object and --part-by " + nameIn(kPartByNames, *options.partBy) +
                     " contradict each other; use --split part");
  request.partBy = options.partBy ? options.partBy : scene.partBy;
  if (byObject) request.partBy = PartBy::kObject;
}

/// A surface with holes has no inside, and soft values would end beside them.
void requireCuttable(const Request& request) {
  if (request.volume.alpha == Alpha::kKeep) return;
  if (needsInside(request.grids, request.volume))
    throw UsageError(
        "--alpha cut makes holes, so nothing has an inside; use --fill surface, and leave surface "
        "out of --grids");
  if (request.volume.edge == Edge::kSoft)
    throw UsageError("--alpha cut needs --edge hard (soft is the default of --target blender)");
}

void requirePart(const Request& request) {
  const std::optional<RunPart>& part = request.part;
  if (!part) return;
  if (part->count < 1 || part->count > kMostRunParts || part->number < 1 ||
      part->number > part->count)
    throw UsageError("--part must be I/N, with I from 1 to N, and N at most " +
                     std::to_string(kMostRunParts));
  if (request.splits)
    throw UsageError("--split makes as many grids as parts have voxels; leave it out with --part");
}

std::optional<Box> boundsOf(const std::optional<std::array<double, 6>>& bounds) {
  if (!bounds) return std::nullopt;
  const Box box{Vec3d(bounds->data()), Vec3d(bounds->data() + 3)};
  if (box.empty() || !box.low.allFinite() || !box.high.allFinite())
    throw UsageError(
        "--bounds must be two corners of a box, the low one first: x0,y0,z0,x1,y1,z1 with x0 <= "
        "x1, "
        "y0 <= y1 and z0 <= z1");
  return box;
}

ConversionWay wayOf(const Scene& scene, const SceneObject& object, const ConvertOptions& options) {
  const StopRule until = firstSet({options.until, object.until, scene.until});
  const Voxelize voxelize =
      firstSet({options.voxelize, object.voxelize, scene.voxelize}, Voxelize::kAuto);
  const std::string fault = faultOf(until, voxelize, options.separation);
  if (!fault.empty()) throw UsageError(object.name + ": " + fault);
  return chooseWay(until, voxelize, options.separation);
}

/// The text of the options. The resolution and the bounds are there even if the scene or the
/// default set them, and so are different widths of the band, which tell the values of the level
/// set far off, and a target whose rules differ from those of Blender.
std::string textOf(ConvertOptions options, const Resolution& resolution,
                   const std::optional<std::array<double, 6>>& ofScene,
                   const VolumeSettings& volume) {
  options.voxelSize = resolution.voxelSize;
  options.dim = resolution.dim.value_or(kDefaultDim);
  if (options.voxelSize) options.dim.reset();
  if (!options.bounds) options.bounds = ofScene;
  if (!volume.band.isSymmetric()) options.volume.band = volume.band;
  if (volume.target == Target::kHoudini) options.volume.target = volume.target;
  return optionText(options);
}

}  // namespace

Resolution resolutionOf(const Scene& scene, const ConvertOptions& options) {
  Resolution first{options.voxelSize, options.dim};
  if (options.origin && !options.voxelSize)
    throw UsageError("the origin of a lattice needs its voxel size");
  if (options.origin) first.origin = Vec3d(options.origin->data());
  return first.isSet() ? first : Resolution{scene.voxelSize, scene.dim};
}

GridTransform placedFor(const Request& request, GridTransform transform) {
  transform.turn = request.turn;
  if (!request.resolution.origin) return transform;
  transform.origin = *request.resolution.origin;
  // The file says half a voxel less than where the surface is.
  if (request.volume.target == Target::kBlender34)
    transform.origin.array() += transform.voxelSize / 2;
  return transform;
}

GridTransform transformFor(const Resolution& resolution, const Box& box) {
  if (resolution.voxelSize) return transformForVoxelSize(*resolution.voxelSize);
  return transformForDim(box, resolution.dim.value_or(kDefaultDim));
}

std::vector<ObjectPreparation> preparationsOf(const Scene& scene,
                                              const PreparationOptions& options) {
  std::vector<ObjectPreparation> all;
  for (const SceneObject& object : scene.objects)
    all.push_back(preparationOf(scene, object, options));
  return all;
}

void requirePreparable(const Scene& scene, const PreparationOptions& options) {
  const auto requireOneObject = [&](const auto& list, const char* option, const char* key) {
    if (list && scene.objects.size() > 1)
      throw UsageError(std::string(option) + " needs a scene of one object, not " +
                       std::to_string(scene.objects.size()) + "; use " + key + " in the scene");
  };
  requireOneObject(options.smoothing.interpolatedVertices, "--interpolate-vertices",
                   "interpolate_vertices");
  requireOneObject(options.smoothing.creaseEdges, "--crease-edges", "crease_edges");
  requireOneObject(options.smoothing.cornerVertices, "--corner-vertices", "corner_vertices");
  for (const SceneObject& object : scene.objects) {
    const ObjectPreparation prepared = preparationOf(scene, object, options);
    const bool ofBoundary = prepared.interpolate == Interpolate::kBoundary ||
                            prepared.interpolate == Interpolate::kBoth;
    if (ofBoundary && prepared.boundary == BoundaryRule::kFree)
      throw UsageError(object.name +
                       ": a free boundary cannot be interpolated; use --boundary extend, or "
                       "--interpolate none or interior");
    if (prepared.boundary == BoundaryRule::kFree && prepared.mayCrease())
      throw UsageError(object.name +
                       ": creases need a boundary that the surface reaches; use --boundary extend "
                       "or corners");
  }
}

bool Request::hasLooks() const {
  return volume.alpha == Alpha::kCut ||
         std::find(grids.begin(), grids.end(), GridKind::kColor) != grids.end();
}

bool Request::hasParts() const {
  return splits || std::find(grids.begin(), grids.end(), GridKind::kPart) != grids.end();
}

Request resolve(const Scene& scene, const ConvertOptions& options) {
  Request request(options);
  request.resolution = resolutionOf(scene, options);
  for (const SceneObject& object : scene.objects) {
    ObjectRequest& wanted = request.objects.emplace_back(
        ObjectRequest{preparationOf(scene, object, options), wayOf(scene, object, options),
                      options.texture ? options.texture : object.texture});
    if (wanted.way.until.levels == 0) wanted.preparation.faces = FaceRule::kKeep;  // no smoothing
  }
  request.volume = volumeOf(options.volume, scene.volume);
  const auto& up = options.volume.up ? options.volume.up : scene.volume.up;
  request.turn = turnFor(up, request.volume.target);
  request.bounds = boundsOf(options.bounds ? options.bounds : scene.bounds);
  request.clip = options.clip;
  request.part = options.part;
  request.grids = gridsOf(scene, options);
  resolveParts(scene, options, request);
  requireCuttable(request);
  requirePart(request);
  for (ObjectRequest& object : request.objects)
    object.preparation.followsTexcoords = request.hasLooks();
  request.optionText = textOf(options, request.resolution, scene.bounds, request.volume);
  requirePreparable(scene, options);
  return request;
}

}  // namespace vox
