// The nearest foot of given voxels, bin by bin.

#include "libvox/foot/nearest_feet.h"

#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/foot/scan_cell.h"
#include "libvox/grid/openvdb.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>

namespace vox {
namespace {

/// The nearest feet so far of the voxels of a bin.
class FeetOfBin {
 public:
  /// Takes the wanted voxels of the bin.
  /// @return whether there are any
  bool begin(const openvdb::MaskTree& voxels, const openvdb::Coord& binOrigin) {
    bool any = false;
    for (unsigned number = 0; number < FootBrick::kLeaves; ++number) {
      const auto* leaf = voxels.probeConstLeaf(FootBrick::leafOrigin(binOrigin, number));
      for (unsigned x = 0; x < 8; ++x)
        wanted_[number][x] =
            leaf == nullptr ? 0 : leaf->getValueMask().getWord<openvdb::Index64>(x);
      any |= leaf != nullptr;
      leaves_[number].found = {};
    }
    return any;
  }

  const BinMask& wanted() const { return wanted_; }

  /// @param handicap  voxels, added to the distances
  void keepNearest(const Feet& feet, const BinnedCell& cell, float handicap) {
    for (std::size_t i = 0; i < feet.count; ++i) {
      LeafFeet& leaf = leaves_[feet.leaf(i)];
      const unsigned voxel = feet.voxelOfLeaf(i);
      const std::uint64_t bit = std::uint64_t{1} << (voxel & 63U);
      std::uint64_t& found = leaf.found[voxel >> 6];
      const float t = feet.t[i] + std::copysign(handicap, feet.t[i]);
      if ((found & bit) != 0 && keyOf(leaf.distance[voxel]) <= keyOf(t)) continue;
      found |= bit;
      leaf.distance[voxel] = t;
      leaf.place[voxel] = {&cell, feet.a[i], feet.b[i]};
    }
  }

  /// Calls visit(number of the leaf, feet) for leaves in which feet were found.
  template <class Visit>
  void forEachLeaf(Visit&& visit) const {
    for (unsigned number = 0; number < FootBrick::kLeaves; ++number) {
      const LeafFeet& leaf = leaves_[number];
      std::uint64_t any = 0;
      for (const std::uint64_t word : leaf.found) any |= word;
      if (any != 0) visit(number, leaf);
    }
  }

 private:
  BinMask wanted_;
  std::array<LeafFeet, FootBrick::kLeaves> leaves_;
};

struct FeetWork {
  FeetOfBin nearest;
  Feet feet;
};

/// The normal of a triangle, of its edge or of its vertex, whichever the foot is on.
const Float3& polygonNormal(const TriangleCell& cell, const std::array<float, 3>& weights) {
  constexpr float kLeast = 1e-6F;
  for (std::size_t i = 0; i < 3; ++i)
    if (weights[i] > 1 - kLeast) return cell.vertexNormals[i];
  for (std::size_t i = 0; i < 3; ++i)
    if (weights[(i + 2) % 3] < kLeast) return cell.edgeNormals[i];
  return cell.normal;
}

}  // namespace

Float3 normalAt(const FootBins& bins, const FootPlace& at) {
  if (at.cell->kind == CellKind::kNewton) {
    const NewtonCell& cell = bins.newton(*at.cell);
    const float in = cell.creaseBias == 0 ? 1 : kBesideCorner;
    const Float3 normal = Jet(cell.surface, in * at.a, in * at.b).normal();
    // At a corner where two sides are parallel, the surface near it has the normal.
    constexpr float kNear = 0.9F;
    if (dot(normal, normal) > 0) return normal;
    return Jet(cell.surface, kNear * at.a, kNear * at.b).normal();
  }
  const TriangleCell& cell = bins.triangle(*at.cell);
  const std::array<float, 3> weights = {1 - at.a - at.b, at.a, at.b};
  if (at.cell->kind == CellKind::kTriangle) return polygonNormal(cell, weights);
  Float3 sum = {};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) sum[k] += weights[i] * cell.vertexNormals[i][k];
  return sum;
}

SurfacePlace placeAt(const FootBins& bins, const FootPlace& at) {
  std::array<float, 2> place = {};
  if (at.cell->kind == CellKind::kNewton) {
    const NewtonCell& cell = bins.newton(*at.cell);
    place = {cell.u + cell.side[0] * at.a, cell.v + cell.side[1] * at.b};
  } else {
    const auto& places = bins.triangle(*at.cell).places;
    for (std::size_t k = 0; k < 2; ++k)
      place[k] = (1 - at.a - at.b) * places[0][k] + at.a * places[1][k] + at.b * places[2][k];
  }
  return {std::clamp(double{place[0]}, 0.0, 1.0), std::clamp(double{place[1]}, 0.0, 1.0)};
}

void forEachFoot(const FootBins& bins, const openvdb::MaskTree& voxels, Progress& progress,
                 double part,
                 const std::function<void(const openvdb::Coord&, const LeafFeet&)>& visit) {
  tbb::enumerable_thread_specific<std::unique_ptr<FeetWork>> works(
      [] { return std::make_unique<FeetWork>(); });
  parallelForEach(bins.count(), 1, [&](std::size_t bin) {
    progress.check();
    FeetWork& work = *works.local();
    const openvdb::Coord origin = bins.originOf(bin);
    progress.done(part / static_cast<double>(bins.count()));
    if (!work.nearest.begin(voxels, origin)) return;
    for (const BinnedCell& cell : bins.cellsOf(bin)) {
      // A surface wins over the curve in which it ends.
      constexpr float kHandicapOfCurve = 0.01F;
      const bool isCurve = cell.kind == CellKind::kNewton && bins.newton(cell).isCurve;
      const auto keep = [&](const Feet& feet) {
        work.nearest.keepNearest(feet, cell, isCurve ? kHandicapOfCurve : 0);
      };
      if (cell.kind != CellKind::kNewton)
        scanFeet(bins.triangle(cell), origin, &work.nearest.wanted(), work.feet, keep);
      else
        scanFeet(bins.newton(cell), origin, &work.nearest.wanted(), work.feet, keep);
    }
    work.nearest.forEachLeaf([&](unsigned number, const LeafFeet& feet) {
      visit(FootBrick::leafOrigin(origin, number), feet);
    });
  });
}

}  // namespace vox
