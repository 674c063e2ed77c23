// From a scene to surfaces in index space.

#include "libvox/pipeline/prepare_scene.h"

#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/core/stopwatch.h"
#include "libvox/mesh/adjacency.h"
#include "libvox/options/voxelize.h"
#include "libvox/pipeline/colors.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/cut.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/inside.h"
#include "libvox/pipeline/object_look.h"
#include "libvox/pipeline/parts.h"
#include "libvox/pipeline/plan.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/work.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <span>
#include <string>
#include <utility>

namespace vox {
namespace {

void moveToIndexSpace(PolygonMesh& mesh, const GridTransform& transform) {
  parallelForEach(mesh.pointCount(), kElementsPerTask,
                  [&](Index v) { mesh.points[v] = transform.toIndex(mesh.points[v]); });
}

/// Warns of boundaries from which the surface shrinks, and of faces that are not joined.
void warnOfBoundary(const std::string& name, const SubdivisionLevel& level, ConvertReport& report) {
  if (!level.seam.empty()) return;  // then the surface is extended, and is no heap of faces
  const std::size_t loops = boundaryLoops(level.mesh, level.adjacency).size();
  if (loops == 0) return;
  constexpr const char* kWhy =
      ": faces are neighbours only where their vertices coincide exactly; --weld joins near ones";
  const bool separate = loops >= level.mesh.faceCount();
  if (level.boundary == BoundaryStage::kPlain)
    report.warnings.push_back(name + " is open: it has " + std::to_string(loops) + " boundary " +
                              (loops == 1 ? "loop" : "loops") + ", from which it shrinks" +
                              (separate ? std::string(" to dots") + kWhy : ""));
  else if (separate && loops > 1)
    report.warnings.push_back(name + " falls apart into " + std::to_string(loops) +
                              " separate faces, each smoothed by itself" + kWhy);
}

bool hasColorGrid(const Request& request) {
  return std::find(request.grids.begin(), request.grids.end(), GridKind::kColor) !=
         request.grids.end();
}

/// Warns of a grid of colours for objects that have none.
void warnOfColors(const Scene& scene, const Request& request, ConvertReport& report) {
  if (!hasColorGrid(request)) return;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const PolygonMesh& mesh = scene.objects[i].mesh;
    if (request.objects[i].texture || !mesh.pointColors.empty() || !mesh.faceColors.empty() ||
        !mesh.attributes.looks.empty())
      return;
  }
  report.warnings.emplace_back(
      "the input has no colours, so the grid color is grey; --texture gives it a pattern");
}

/// Notes what preparation did. Refuses vertices that it moved out of the range of the grid.
void notePreparation(const PreparedObject& prepared, const GridTransform& transform,
                     ObjectReport& part, ConvertReport& report) {
  part.creases = prepared.creases;
  part.interpolation = prepared.interpolation;
  report.warnings.insert(report.warnings.end(), prepared.warnings.begin(), prepared.warnings.end());
  requireInRange(usedBox(prepared.base.mesh), transform, part.name + ", once interpolated,");
}

/// An object, ready to subdivide in index space.
PreparedSurface prepareObject(const Scene& scene, const Request& all, std::size_t i,
                              const GridTransform& transform, const Parts& parts,
                              ImageReader& images, MemoryBudget& budget, Progress& progress,
                              ConvertReport& report, PolygonMesh* usedUp) {
  const SceneObject& object = scene.objects[i];
  const ObjectRequest& request = all.objects[i];
  ObjectReport& part = report.objects.emplace_back();
  part.name = object.name;
  part.inputFaces = object.mesh.faceCount();
  const Index inputCorners = object.mesh.cornerCount();
  progress.begin("prepare", workOfPreparing(object.mesh, request.preparation.interpolates()));
  PreparedObject prepared = prepare(scene, object, request.preparation, budget, progress, usedUp);
  const bool isSmoothed = request.way.until.levels != 0;
  if (isSmoothed) warnOfBoundary(part.name, prepared.base, report);
  notePreparation(prepared, transform, part, report);
  moveToIndexSpace(prepared.base.mesh, transform);
  budget.take(bytesOf(prepared.base), "the prepared meshes", "raise --max-memory");
  PreparedSurface surface{object.name, std::move(prepared.base), request.way, all.surface,
                          placedTexture(request.texture, object, transform.turn)};
  surface.inputCorners = inputCorners;
  if (all.hasLooks() && !surface.texture)
    surface.look = lookOf(object, request.texture, prepared.faceOrigin,
                          std::move(prepared.texcoords), images, report.warnings);
  if (!parts.names.empty())
    for (Index f = 0; f < prepared.faceOrigin.size(); ++f)
      surface.partOfFace.push_back(parts.ofFaces[i][prepared.faceOrigin[f]]);
  return surface;
}

/// The voxels that a request asks for.
/// @throws UsageError  there are none
Region regionOf(const Request& request, const GridTransform& transform) {
  Region region;
  if (request.bounds) region = regionOf(*request.bounds, transform);
  if (region.isEmpty())
    throw UsageError(
        "--bounds: the box holds no centre of a voxel; make it larger, or use smaller "
        "voxels");
  if (const auto& clip = request.clip)
    region = region &
             Region({{(*clip)[0], (*clip)[1], (*clip)[2]}, {(*clip)[3], (*clip)[4], (*clip)[5]}});
  return region;
}

const PageShare& shareOf(const RunPart& part, const std::vector<PageShare>& shares) {
  return shares[static_cast<std::size_t>(part.number - 1)];
}

/// Cuts the region of a scene into the parts of a run, and takes one of them.
std::vector<PageShare> takePart(const RunPart& part, PreparedScene& prepared) {
  std::vector<PageShare> shares = cutInto(part.count, costsOf(prepared.surfaces, prepared.region));
  prepared.region = prepared.region & Region(shareOf(part, shares).range);
  return shares;
}

}  // namespace

PreparedScene prepareScene(const Scene& scene, const Request& request, Progress& progress,
                           ConvertReport& report, Scene* usedUp) {
  report.threads = tbb::this_task_arena::max_concurrency();
  PreparedScene prepared{MemoryBudget(request.run.maxMemory)};
  MemoryBudget& budget = prepared.budget;
  for (const SceneObject& object : scene.objects)
    budget.take(bytesOf(object.mesh), "the input", "raise --max-memory");

  if (request.volume.tolerance)
    report.warnings.push_back("the tolerance has no effect any more; leave it out");
  warnOfColors(scene, request, report);
  std::vector<ObjectPreparation> preparations;
  for (const ObjectRequest& object : request.objects) preparations.push_back(object.preparation);
  const Box box = boxOf(scene, preparations);
  GridTransform& transform = prepared.transform;
  transform = placedFor(request, transformFor(request.resolution, box));
  requireInRange(box, transform);
  prepared.region = regionOf(request, transform);
  report.voxelSize = transform.voxelSize;
  prepared.areas = areasOf(scene, transform, progress);
  plan(scene, request, prepared.areas, progress);
  std::vector<PageShare> shares;
  {
    const StageTimer timer(report.prepareSeconds);
    ImageReader images(budget);
    Parts parts;
    if (request.hasParts())
      parts = partsOf(scene, request.partBy ? *request.partBy : defaultPartBy(scene));
    const bool needsInput = needsInside(request.grids, request.volume);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
      const bool isUsedUp =
          usedUp != nullptr && !needsInput && !request.objects[i].preparation.followsTexcoords;
      prepared.surfaces.push_back(prepareObject(scene, request, i, transform, parts, images, budget,
                                                progress, report,
                                                isUsedUp ? &usedUp->objects[i].mesh : nullptr));
    }
    report.inputHash = images.hashWith(scene.inputHash);
    if (request.part) shares = takePart(*request.part, prepared);
    for (PreparedSurface& surface : prepared.surfaces)
      surface.region = request.spreadsParts() ? Region{} : prepared.region.grown(kMarginOfFeet);
    prepared.partNames = std::move(parts.names);
  }
  if (needsInside(request.grids, request.volume))
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
      requireInside(
          prepared.surfaces[i], request.volume, transform,
          [&] { return gapsOf(scene.objects[i], preparations[i]); }, report.warnings);
  const double share = request.part ? shareOf(*request.part, shares).cost : 1;
  prepared.estimate = estimateGrids(prepared.surfaces, request.grids, request.volume,
                                    prepared.region, share, cutsLevelSets(shares));
  prepared.estimate.shares = std::move(shares);
  prepared.estimate.voxelSize = report.voxelSize;
  prepared.estimate.refusal = refusalOf(prepared.estimate, box.longestSide(), budget);
  return prepared;
}

}  // namespace vox
