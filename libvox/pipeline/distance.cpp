// The level set of all objects, component by component.

#include "libvox/pipeline/distance.h"

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/mesh/area.h"
#include "libvox/pipeline/components.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/inside.h"
#include "libvox/pipeline/refine.h"
#include "libvox/volume/level_set.h"

#include <openvdb/tools/Composite.h>

#include <algorithm>
#include <map>
#include <vector>

namespace vox {
namespace {

/// A component of an object.
struct Part {
  std::size_t surface;
  const MeshComponent* component;
  Box box;  // of its control points, which hold the surface; index space, widened by the band

  double volume() const { return (box.high - box.low).prod(); }
};

/// Parts that are made together.
using Batch = std::vector<Part>;

bool overlap(const Box& a, const Box& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

Box boxOf(const PolygonMesh& mesh, const MeshComponent& component, double margin) {
  Box box;
  for (const Index f : component.faces)
    for (const Index v : mesh.face(f)) {
      box.add(mesh.points[v] - Vec3d::Constant(margin));
      box.add(mesh.points[v] + Vec3d::Constant(margin));
    }
  return box;
}

/// Closed parts in the order in which they are united (even batches) and taken out (odd batches). A
/// part that encloses another has a larger box and comes first.
std::map<int, Batch> batchesOf(std::vector<Part> parts) {
  constexpr std::size_t kMostCompared = 20000;
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.volume() > b.volume(); });
  const bool compare = parts.size() <= kMostCompared;
  std::map<int, Batch> batches;
  std::vector<int> numbers;
  for (const Part& part : parts) {
    const int parity = part.component->side == MeshComponent::Side::kIn ? 1 : 0;
    int number = parity;
    for (std::size_t i = 0; compare && i < numbers.size(); ++i)
      if (numbers[i] >= number && overlap(part.box, parts[i].box))
        number = numbers[i] + 1 + (numbers[i] + 1 + parity) % 2;
    numbers.push_back(number);
    batches[number].push_back(part);
  }
  return batches;
}

class SurfaceMaker {
 public:
  SurfaceMaker(std::span<const PreparedSurface> surfaces, const VolumeSettings& settings,
               const openvdb::math::Transform& transform, const MemoryBudget& budget,
               const Progress& progress)
      : surfaces_(surfaces),
        transform_(transform),
        budget_(budget),
        progress_(progress),
        band_(settings.band),
        tolerance_(settings.tolerance) {
    for (const PreparedSurface& surface : surfaces)
      components_.push_back(componentsOf(surface.base));
  }

  /// The closed parts, or the parts without inside.
  std::vector<Part> parts(bool closed) const {
    std::vector<Part> parts;
    for (std::size_t s = 0; s < surfaces_.size(); ++s)
      for (const MeshComponent& component : components_[s])
        if ((component.side != MeshComponent::Side::kNoInside) == closed)
          parts.push_back({s, &component, boxOf(surfaces_[s].base.mesh, component, band_ + 1)});
    return parts;
  }

  openvdb::FloatGrid::Ptr make(const Batch& batch, DistanceTo what) const {
    PolygonMesh polygons;
    double area = 0;
    for (auto begin = batch.begin(); begin != batch.end();) {
      const std::size_t s = begin->surface;
      std::vector<Index> faces;
      for (; begin != batch.end() && begin->surface == s; ++begin)
        faces.insert(faces.end(), begin->component->faces.begin(), begin->component->faces.end());
      const PolygonMesh part = polygonsOf(surfaces_[s], faces, tolerance_, budget_, progress_);
      area += areaOf(part);
      budget_.require(static_cast<std::uint64_t>(2 * static_cast<double>(bytesOf(polygons)) +
                                                 2 * static_cast<double>(bytesOf(part))),
                      "the polygons of the surface", kAdvice);
      append(polygons, part);
    }
    constexpr double kMostBytes = 1e18;
    budget_.require(
        static_cast<std::uint64_t>(std::min(kMostBytes, bytesOfDistances(area, band_).peak)) +
            bytesOf(polygons),
        "the surface grid", kAdvice);
    auto grid =
        distanceGrid(polygons, transform_, band_, what, [this] { return progress_.cancelled(); });
    progress_.check();
    return grid;
  }

  float background() const { return static_cast<float>(band_ * transform_.voxelSize()[0]); }

 private:
  static constexpr const char* kAdvice =
      "use a smaller --band, a larger --tolerance or larger voxels, or raise --max-memory";

  std::span<const PreparedSurface> surfaces_;
  const openvdb::math::Transform& transform_;
  const MemoryBudget& budget_;
  const Progress& progress_;
  double band_;
  double tolerance_;
  std::vector<std::vector<MeshComponent>> components_;
};

}  // namespace

openvdb::FloatGrid::Ptr surfaceGrid(std::span<const PreparedSurface> surfaces,
                                    const VolumeSettings& settings,
                                    const openvdb::math::Transform& transform, MemoryBudget& budget,
                                    const Progress& progress) {
  const SurfaceMaker maker(surfaces, settings, transform, budget, progress);
  openvdb::FloatGrid::Ptr all;
  for (const auto& [number, batch] : batchesOf(maker.parts(true))) {
    const auto grid = maker.make(batch, DistanceTo::kSolid);
    if (!all)
      all = grid;
    else if (number % 2 == 0)
      openvdb::tools::csgUnion(*all, *grid);
    else
      openvdb::tools::csgDifference(*all, *grid);
  }
  const Batch open = maker.parts(false);
  const bool isUnsigned = settings.openMesh == OpenMesh::kUnsigned;
  if (!open.empty()) {
    const auto grid = maker.make(open, isUnsigned ? DistanceTo::kSurface : DistanceTo::kSheet);
    if (!all)
      all = grid;
    else
      openvdb::tools::csgUnion(*all, *grid);
    if (isUnsigned) all->setGridClass(openvdb::GRID_UNKNOWN);
  }
  budget.take(all->memUsage(), "the surface grid", kScatteredAdvice);
  return all;
}

}  // namespace vox
