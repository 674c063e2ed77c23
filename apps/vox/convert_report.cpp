// The report of vox convert, as JSON and as text.

#include "apps/vox/convert_report.h"

#include "apps/vox/counted.h"
#include "apps/vox/json.h"
#include "libvox/core/memory.h"
#include "libvox/core/version.h"
#include "libvox/grid/openvdb.h"
#include "libvox/options/voxelize.h"

#include <openvdb/tools/Count.h>

#include <sstream>

namespace vox::app {
namespace {

double perVoxel(const ObjectReport& object) {
  return static_cast<double>(object.vertices) / static_cast<double>(object.activeVoxels);
}

Json toJson(const ObjectReport& object) {
  Json levels = Json::object();
  for (std::size_t level = 0; level < object.verticesOfLevel.size(); ++level)
    if (object.verticesOfLevel[level] > 0)
      levels[std::to_string(level)] = object.verticesOfLevel[level];
  const InterpolationReport& interpolation = object.interpolation;
  return {{"name", object.name},
          {"input_faces", object.inputFaces},
          {"submeshes", object.submeshes},
          {"voxelized", object.byPolygons ? "polygons" : "vertices"},
          {"until", object.byPolygons ? Json(stopRuleName(object.until)) : Json("voxel")},
          {"levels", object.levels},
          {"vertices", object.vertices},
          {"vertices_of_level", levels},
          {"triangles", object.polygons.triangles},
          {"fanned_polygons", object.polygons.fanned},
          {"active_voxels", object.activeVoxels},
          // Infinite if earlier objects have all of its voxels: null in JSON.
          {"vertices_per_voxel", perVoxel(object)},
          {"creases",
           {{"sharp_edges", object.creases.sharpEdges},
            {"corner_vertices", object.creases.cornerVertices},
            {"darts", object.creases.darts}}},
          {"interpolation",
           {{"boundary_vertices", interpolation.boundaryVertices},
            {"interior_vertices", interpolation.lift.vertices},
            {"iterations", interpolation.lift.iterations},
            {"residual", interpolation.lift.residual}}}};
}

Json bandJson(const std::optional<BandWidths>& band) {
  if (!band) return nullptr;
  return band->isSymmetric() ? Json(band->out) : Json{band->in, band->out};
}

Json toJson(const VolumeOptions& volume) {
  return {{"fill", orNull(kFillNames, volume.fill)},
          {"edge", orNull(kEdgeNames, volume.edge)},
          {"alpha", orNull(kAlphaNames, volume.alpha)},
          {"gain", orNull(volume.gain)},
          {"open_mesh", orNull(kOpenMeshNames, volume.openMesh)},
          {"close", orNull(volume.close)},
          {"band", bandJson(volume.band)},
          {"tolerance", orNull(volume.tolerance)},
          {"half", orNull(volume.half)},
          {"compression", orNull(kCompressionNames, volume.compression)},
          {"target", orNull(kTargetNames, volume.target)},
          {"up", orNull(kUpAxisNames, volume.up)}};
}

/// The options that were given; null if the scene or the default decided.
Json optionsJson(const FinishedRun& run) {
  const ConvertOptions& options = run.options;
  const SmoothingOptions& smoothing = options.smoothing;
  const auto orNull = [](const auto& value) { return value ? Json(*value) : Json(); };
  Json json = {
      {"scale", orNull(options.scale)},
      {"dim", orNull(options.dim)},
      {"voxel_size", orNull(options.voxelSize)},
      {"origin", orNull(options.origin)},
      {"bounds", orNull(options.bounds)},
      {"clip", orNull(options.clip)},
      {"boundary",
       smoothing.boundary ? Json(nameIn(kBoundaryRuleNames, *smoothing.boundary)) : Json()},
      {"interpolate",
       smoothing.interpolate ? Json(nameIn(kInterpolateNames, *smoothing.interpolate)) : Json()},
      {"interpolate_vertices", orNull(smoothing.interpolatedVertices)},
      {"faces", smoothing.faces ? Json(nameIn(kFaceRuleNames, *smoothing.faces)) : Json()},
      {"crease", smoothing.crease ? Json(creaseRuleName(*smoothing.crease)) : Json()},
      {"crease_edges", orNull(smoothing.creaseEdges)},
      {"corner_vertices", orNull(smoothing.cornerVertices)},
      {"weld", orNull(options.weldTolerance)},
      {"drop_components",
       options.dropComponents ? Json(componentLimitText(*options.dropComponents)) : Json()},
      {"strict", orNull(options.strict)},
      {"until", options.until ? Json(stopRuleName(*options.until)) : Json()},
      {"voxelize", options.voxelize ? Json(nameIn(kVoxelizeNames, *options.voxelize)) : Json()},
      {"separating", options.separation == Separation::k26 ? 26 : 6},
      {"grids", options.grids ? Json(namesOf(run.conversion)) : Json()},
      {"part_by", vox::app::orNull(kPartByNames, options.partBy)},
      {"split", vox::app::orNull(kSplitNames, options.split)},
      {"texture", options.texture ? Json(textureText(*options.texture)) : Json()},
      {"localize", nameIn(kLocalizeNames, options.surface.localize)},
      {"submesh_faces", options.surface.submeshFaces},
      {"threads", options.run.threads > 0 ? Json(options.run.threads) : Json()},
      {"max_memory", options.run.maxMemory > 0 ? Json(options.run.maxMemory) : Json()}};
  json.update(toJson(options.volume));
  return json;
}

Json memoryJson(const Conversion& conversion) {
  Json grids = Json::object();
  const std::vector<std::string> names = namesOf(conversion);
  const std::vector<std::uint64_t> bytes = memoryOf(conversion);
  for (std::size_t i = 0; i < names.size(); ++i) grids[names[i]] = bytes[i];
  return {{"peak_resident_bytes", peakMemory()}, {"grid_bytes", grids}};
}

std::string levelsText(const ObjectReport& object) {
  std::ostringstream text;
  for (std::size_t level = 0; level < object.verticesOfLevel.size(); ++level)
    if (object.verticesOfLevel[level] > 0)
      text << (text.tellp() > 0 ? ", " : "") << level << ": " << object.verticesOfLevel[level];
  return text.str();
}

std::string objectText(const ObjectReport& object) {
  std::ostringstream text;
  text << object.name << ": " << counted(object.inputFaces, "face") << ", ";
  if (!object.byPolygons && object.vertices == 0) {
    text << "not voxelized: the level set is measured from the surface itself";
    return text.str();
  }
  if (object.submeshes > 0) text << counted(object.submeshes, "submesh", "submeshes") << ", ";
  if (object.byPolygons)
    text << object.polygons.triangles << " triangles after " << object.levels << " levels (until "
         << stopRuleName(object.until) << "), ";
  else
    text << object.vertices << " vertices (by level " << levelsText(object) << "), ";
  text << object.activeVoxels << " active voxels";
  if (object.activeVoxels > 0 && object.vertices > 0)
    text << ", " << perVoxel(object) << " vertices per voxel";
  return text.str();
}

/// What a grid holds.
std::string gridText(const openvdb::GridBase& grid) {
  std::ostringstream text;
  text << "grid " << grid.getName() << ": " << counted(grid.activeVoxelCount(), "active voxel");
  if (const auto* numbers = dynamic_cast<const openvdb::FloatGrid*>(&grid)) {
    const auto range = openvdb::tools::minMax(numbers->tree());
    text << (grid.getGridClass() == openvdb::GRID_FOG_VOLUME ? ", values" : ", distances")
         << " from " << range.min() << " to " << range.max();
  }
  return text.str();
}

std::string creaseText(const ObjectReport& object) {
  std::ostringstream text;
  text << object.name << ": " << counted(object.creases.sharpEdges, "sharp edge") << ", "
       << counted(object.creases.cornerVertices, "corner vertex", "corner vertices") << ", "
       << counted(object.creases.darts, "dart");
  return text.str();
}

std::string interpolationText(const ObjectReport& object) {
  const InterpolationReport& done = object.interpolation;
  std::ostringstream text;
  text << object.name << ": interpolates " << done.boundaryVertices << " boundary and "
       << done.lift.vertices << " interior vertices, " << done.lift.iterations
       << " iterations, off by at most " << done.lift.residual << " world units";
  return text.str();
}

}  // namespace

std::string reportJson(const FinishedRun& run) {
  const ConvertReport& report = run.conversion.report;
  Json files = Json::array();
  for (const auto& file : run.scene.files) files.push_back(file.string());
  Json objects = Json::array();
  for (const ObjectReport& object : report.objects) objects.push_back(toJson(object));
  const Json json = {{"vox_version", version()},
                     {"input", files},
                     {"input_hash", run.conversion.report.inputHash},
                     {"output", run.output},
                     {"options", optionsJson(run)},
                     {"threads", report.threads},
                     {"voxel_size", report.voxelSize},
                     {"grids", namesOf(run.conversion)},
                     {"active_voxels", report.activeVoxels},
                     {"objects", objects},
                     {"seconds",
                      {{"read", run.readSeconds},
                       {"prepare", report.prepareSeconds},
                       {"surface", report.surfaceSeconds},
                       {"grids", report.gridsSeconds},
                       {"write", run.writeSeconds}}},
                     {"memory", memoryJson(run.conversion)},
                     {"warnings", report.warnings}};
  return textOf(json) + '\n';
}

std::vector<std::string> reportLines(const FinishedRun& run) {
  const ConvertReport& report = run.conversion.report;
  std::vector<std::string> lines;
  for (const ObjectReport& object : report.objects) {
    lines.push_back(objectText(object));
    if (object.creases.sharpEdges + object.creases.cornerVertices > 0)
      lines.push_back(creaseText(object));
    if (object.interpolation.boundaryVertices + object.interpolation.lift.vertices > 0)
      lines.push_back(interpolationText(object));
  }
  std::ostringstream times;
  times << "seconds on " << report.threads << (report.threads == 1 ? " thread" : " threads")
        << ": read " << run.readSeconds << ", prepare " << report.prepareSeconds << ", surface "
        << report.surfaceSeconds << ", grids " << report.gridsSeconds << ", write "
        << run.writeSeconds;
  lines.push_back(times.str());
  for (std::size_t i = 0; i < run.conversion.grids.size(); ++i)
    lines.push_back(gridText(*run.conversion.grids[i]));
  std::string memory = "memory: peak " + formatBytes(peakMemory());
  const std::vector<std::string> names = namesOf(run.conversion);
  const std::vector<std::uint64_t> bytes = memoryOf(run.conversion);
  for (std::size_t i = 0; i < names.size(); ++i)
    memory += ", " + names[i] + " " + formatBytes(bytes[i]);
  lines.push_back(memory);
  return lines;
}

}  // namespace vox::app
