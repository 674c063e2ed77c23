// Feet of the voxels of a surface, wherever they are.

#include "libvox/pipeline/feet.h"

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/mesh/triangulate.h"
#include "libvox/pipeline/foot_cells.h"

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <array>

namespace vox {
namespace {

// A foot need not be as near as a distance.
constexpr PieceTolerance kFootTolerance = {.small = 0.02, .large = 0.007};
constexpr float kMoreReach = 4;     // times as far in the next pass
constexpr float kMostReach = 4000;  // voxels

FootSurfaces::Flat flatTriangles(const PolygonMesh& mesh) {
  FootSurfaces::Flat flat;
  flat.triangles.points = mesh.points;
  std::vector<Vec3d> points;
  std::vector<std::array<Index, 3>> triangles;
  TriangulationReport unused;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    points.clear();
    for (const Index v : face) points.push_back(mesh.points[v]);
    triangles.clear();
    triangulate(points, triangles, unused);
    for (const auto& [a, b, c] : triangles) {
      flat.triangles.addFace(std::array{face[a], face[b], face[c]});
      for (const Index corner : {a, b, c}) flat.corners.push_back(mesh.faceOffsets[f] + corner);
    }
  }
  return flat;
}

/// Removes the voxels of a leaf that have a foot.
void removeFound(const openvdb::Coord& origin, const LeafFeet& feet, openvdb::MaskTree& left) {
  auto* leaf = left.probeLeaf(origin);
  auto mask = leaf->getValueMask();
  for (openvdb::Index x = 0; x < 8; ++x) mask.getWord<openvdb::Index64>(x) &= ~feet.found[x];
  leaf->setValueMask(mask);
}

}  // namespace

std::vector<openvdb::Coord> binsOf(const openvdb::MaskTree& voxels) {
  std::vector<openvdb::Coord> bins;
  for (auto leaf = voxels.cbeginLeaf(); leaf; ++leaf)
    if (!leaf->isEmpty()) bins.push_back(leaf->origin() >> kBinLog2);
  std::sort(bins.begin(), bins.end());
  bins.erase(std::unique(bins.begin(), bins.end()), bins.end());
  return bins;
}

FootSurfaces footSurfaces(std::span<const PreparedSurface> surfaces) {
  FootSurfaces all{surfaces, {}, {}};
  std::uint32_t owners = 0;
  for (const PreparedSurface& surface : surfaces) {
    all.flat.push_back(levelOf(surface.way) == 0 ? flatTriangles(surface.base.mesh)
                                                 : FootSurfaces::Flat{});
    all.firstOwners.push_back(owners);
    const std::size_t triangles = all.flat.back().triangles.faceCount();
    owners +=
        static_cast<std::uint32_t>(triangles > 0 ? triangles : surface.base.mesh.cornerCount());
  }
  return all;
}

FootSurfaces::Owner FootSurfaces::ownerOf(const BinnedCell& cell) const {
  const auto next = std::upper_bound(firstOwners.begin(), firstOwners.end(), cell.owner);
  const auto number = static_cast<std::size_t>(next - firstOwners.begin()) - 1;
  const std::uint32_t owner = cell.owner - firstOwners[number];
  if (cell.kind != CellKind::kTriangle) return {number, owner, nullptr};
  const Index* const corners = &flat[number].corners[std::size_t{3} * owner];
  return {number, corners[0], corners};
}

void visitFeet(const FootSurfaces& surfaces, const openvdb::MaskTree& voxels, float firstReach,
               const MemoryBudget& budget, Progress& progress, double part,
               const VisitFeet& visit) {
  constexpr double kPartOfCells = 0.4;
  openvdb::MaskTree left(voxels);
  for (float reach = firstReach; reach <= kMostReach && !left.empty(); reach *= kMoreReach) {
    const CellOptions cellOptions{
        .reach = reach, .polynomials = false, .tolerance = kFootTolerance, .newtonStop = 0.02F};
    FootCells cells(cellOptions, reach > firstReach ? binsOf(left) : std::vector<openvdb::Coord>{},
                    budget);
    for (std::size_t s = 0; s < surfaces.surfaces.size(); ++s) {
      const FootSurfaces::Flat& flat = surfaces.flat[s];
      if (flat.triangles.faceCount() > 0)
        cells.addTriangles(flat.triangles, progress);
      else
        cells.addLimitSurface(surfaces.surfaces[s], {}, {}, progress,
                              kPartOfCells * part / static_cast<double>(surfaces.surfaces.size()));
    }
    const FootBins bins = cells.bins();
    forEachFoot(bins, left, progress, (1 - kPartOfCells) * part,
                [&](const openvdb::Coord& origin, const LeafFeet& feet) {
                  visit(bins, origin, feet);
                  removeFound(origin, feet, left);
                });
    openvdb::tools::pruneInactive(left);
    part = 0;  // the first pass has nearly all of the work
  }
}

}  // namespace vox
