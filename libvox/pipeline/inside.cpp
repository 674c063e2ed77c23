// The inside of the objects of a scene.

#include "libvox/pipeline/inside.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/mesh/triangulate.h"
#include "libvox/pipeline/components.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/refined_polygons.h"
#include "libvox/pipeline/sheets.h"
#include "libvox/prepare/gaps.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/volume/fill.h"
#include "libvox/volume/winding.h"

#include <algorithm>
#include <array>
#include <functional>
#include <sstream>
#include <utility>

namespace vox {
namespace {

/// "jack: 2 of its 3 components have no inside; the first, of 42 faces, is open at (1, 0, 0)".
/// Empty if all components have one.
std::string describeOpen(const PreparedSurface& surface,
                         const std::vector<MeshComponent>& components,
                         const GridTransform& transform) {
  const auto hasNoInside = [](const MeshComponent& c) {
    return c.side == MeshComponent::Side::kNoInside;
  };
  const auto count = std::count_if(components.begin(), components.end(), hasNoInside);
  if (count == 0) return {};
  const MeshComponent& first = *std::find_if(components.begin(), components.end(), hasNoInside);
  const bool open = first.boundaryCorner != kNone;
  const PolygonMesh& mesh = surface.base.mesh;
  const Index corner = open ? first.boundaryCorner : mesh.faceOffsets[first.faces[0]];
  const Vec3d at = transform.toWorld(mesh.points[mesh.faceVertices[corner]]);
  std::ostringstream text;
  text << surface.name << ": " << count << " of its " << components.size() << " component"
       << (components.size() == 1 ? "" : "s") << (count == 1 ? " has" : " have")
       << " no inside; the first, of " << first.faces.size() << " face"
       << (first.faces.size() == 1 ? "" : "s") << ", is " << (open ? "open" : "one-sided") << " at "
       << exactPoint(at);
  return text.str();
}

std::vector<Index> facesOf(const std::vector<MeshComponent>& components, MeshComponent::Side side) {
  std::vector<Index> faces;
  for (const MeshComponent& component : components)
    if (component.side == side)
      faces.insert(faces.end(), component.faces.begin(), component.faces.end());
  return faces;
}

/// The polygons of a level cut into triangles, as they are voxelized.
PolygonMesh triangulated(const PolygonMesh& mesh) {
  PolygonMesh cut;
  cut.points = mesh.points;
  FaceTriangulator faces;
  std::vector<std::array<Index, 3>> triangles;
  for (Index f = 0; f < mesh.faceCount(); ++f) faces.add(mesh, f, triangles);
  for (const auto& triangle : triangles) cut.addFace(triangle);
  return cut;
}

/// The base level of some faces.
SubdivisionLevel levelOfFaces(const PreparedSurface& surface, const std::vector<Index>& faces) {
  if (faces.size() == surface.base.mesh.faceCount()) return surface.base;
  const bool extends = surface.base.boundary == BoundaryStage::kExtend;
  return baseLevel(submeshOf(surface.base.mesh, faces),
                   extends ? BoundaryRule::kExtend : BoundaryRule::kFree);
}

void refuseOrWarn(const std::string& noInside, OpenMesh openMesh,
                  std::vector<std::string>& warnings) {
  if (openMesh == OpenMesh::kError)
    throw MeshError(noInside + "; close it, or use --open-mesh " +
                    nameIn(kOpenMeshNames, OpenMesh::kSurface) + " or " +
                    nameIn(kOpenMeshNames, OpenMesh::kUnsigned));
  warnings.push_back(noInside);
}

/// Grids share their inside, but each finds it for itself: the same line may come again.
void addOnce(const std::string& line, std::vector<std::string>& lines) {
  if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
}

std::string describe(const Closure& closure, int width) {
  if (closure.voxelCount == 0)
    return "closed nothing: the voxel surface has no opening narrower than " +
           std::to_string(width) + " voxels that leads to a space as wide as that";
  return "closed " + std::to_string(closure.openings) + " opening" +
         (closure.openings == 1 ? "" : "s") + " of the voxel surface with " +
         std::to_string(closure.voxelCount) + " voxel" + (closure.voxelCount == 1 ? "" : "s");
}

/// Refuses objects of which components have no inside even though openings were closed.
void requireClosed(std::span<const PreparedSurface> surfaces,
                   const std::vector<std::vector<MeshComponent>>& components,
                   const VolumeSettings& settings, const Inside& inside, Progress& progress,
                   std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i].noInside.empty()) continue;
    const auto have = haveInside(surfaces[i], components[i], inside, progress);
    if (std::find(have.begin(), have.end(), false) == have.end()) continue;
    std::vector<std::string> line;
    refuseOrWarn(surfaces[i].noInside + "; --close " + std::to_string(settings.close) +
                     " does not close all of it",
                 settings.openMesh, line);
    addOnce(line.front(), warnings);
  }
}

bool hasCavity(const std::vector<MeshComponent>& components) {
  return std::any_of(components.begin(), components.end(),
                     [](const MeshComponent& c) { return c.side == MeshComponent::Side::kIn; });
}

}  // namespace

PolygonMesh trianglesNear(const PreparedSurface& surface, const std::vector<Index>& faces,
                          double tolerance, const MemoryBudget& budget, const Progress& progress) {
  if (faces.empty()) return {};
  if (levelOf(surface.way)) return trianglesOfLevel(surface, faces, budget, progress);
  Progress unwatched;
  const TriangleSoup soup = triangleSoup(
      levelOfFaces(surface, faces), StopRule{.flatness = tolerance}, surface.options, unwatched);
  PolygonMesh mesh;
  mesh.points = soup.points;
  for (const auto& triangle : soup.triangles) mesh.addFace(triangle);
  return mesh;
}

PolygonMesh trianglesOfLevel(const PreparedSurface& surface, const std::vector<Index>& faces,
                             const MemoryBudget& budget, const Progress& progress) {
  progress.check();
  Progress unwatched;
  return triangulated(
      subdividedWithin(budget, levelOfFaces(surface, faces), *levelOf(surface.way), unwatched)
          .mesh);
}

void requireInside(PreparedSurface& surface, const VolumeSettings& settings,
                   const GridTransform& transform, const std::function<std::string()>& describeGaps,
                   std::vector<std::string>& warnings) {
  surface.noInside = describeOpen(surface, componentsOf(surface.base), transform);
  if (surface.noInside.empty()) return;
  const std::string gaps = describeGaps();
  if (!gaps.empty()) surface.noInside += "; " + gaps;
  if (settings.close == 0) refuseOrWarn(surface.noInside, settings.openMesh, warnings);
}

Solid solidOf(const openvdb::MaskTree& active, std::span<const PreparedSurface> surfaces,
              const VolumeSettings& settings, const MemoryBudget& budget, Progress& progress,
              std::vector<std::string>& warnings) {
  std::vector<std::vector<MeshComponent>> components;
  for (const PreparedSurface& surface : surfaces) components.push_back(componentsOf(surface.base));
  constexpr double kTolerance = 0.25;  // voxels
  AreCavities areCavities;
  const auto areInCavities = [&](std::span<const openvdb::Coord> voxels) {
    std::vector<int> inward(voxels.size(), 0);
    std::vector<int> outward(voxels.size(), 0);
    for (std::size_t i = 0; i < surfaces.size(); ++i)
      for (const auto& [side, sum] : {std::pair(MeshComponent::Side::kIn, &inward),
                                      std::pair(MeshComponent::Side::kOut, &outward)}) {
        const PolygonMesh polygons =
            trianglesNear(surfaces[i], facesOf(components[i], side), kTolerance, budget, progress);
        const std::vector<int> windings = windingNumbers(polygons, voxels);
        std::transform(sum->begin(), sum->end(), windings.begin(), sum->begin(), std::plus<>());
      }
    std::vector<bool> cavities(voxels.size());
    for (std::size_t v = 0; v < voxels.size(); ++v)
      cavities[v] = inward[v] < 0 && outward[v] + inward[v] <= 0;
    return cavities;
  };
  if (std::any_of(components.begin(), components.end(), hasCavity)) areCavities = areInCavities;
  progress.check();
  const bool closes = settings.close > 0 &&
                      std::any_of(surfaces.begin(), surfaces.end(),
                                  [](const PreparedSurface& s) { return !s.noInside.empty(); });
  if (!closes) return {filled(active, areCavities)};
  budget.require(bytesOfClosing(active, settings.close), "closing openings",
                 "use a smaller --close or larger voxels, or raise --max-memory");
  Solid solid{nullptr, closureOf(active, settings.close)};
  addOnce(describe(solid.closure, settings.close), warnings);
  openvdb::MaskTree tight(active);
  if (solid.closure.voxels) tight.topologyUnion(*solid.closure.voxels);
  solid.voxels = filled(tight, areCavities);
  requireClosed(surfaces, components, settings, {&active, solid.voxels.get()}, progress, warnings);
  return solid;
}

}  // namespace vox
