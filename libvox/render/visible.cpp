// Which grids to show, and which of their voxels.

#include "libvox/render/visible.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/transform.h"
#include "libvox/options/part_options.h"
#include "libvox/volume/joined_parts.h"

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string_view>

namespace vox {
namespace {

using openvdb::GridBase;
using ScalarGrids = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                      openvdb::Int64Grid, openvdb::BoolGrid>;

bool isLevelSet(const GridBase& grid) {
  return grid.getGridClass() == openvdb::GRID_LEVEL_SET &&
         (grid.isType<openvdb::FloatGrid>() || grid.isType<openvdb::DoubleGrid>());
}

bool isShowable(GridBase& grid) {
  return grid.isType<openvdb::MaskGrid>() || grid.apply<ScalarGrids>([](const auto&) {});
}

/// Rank of a grid that could be shown; lower is better.
std::size_t preference(const GridBase& grid) {
  constexpr std::array<std::string_view, 3> kNames = {"mask", "density", "surface"};
  const auto known = std::find(kNames.begin(), kNames.end(), grid.getName());
  return static_cast<std::size_t>(known - kNames.begin());
}

std::string namesOf(std::span<const GridBase::Ptr> grids) {
  std::string names;
  for (const auto& grid : grids) names += (names.empty() ? "" : ", ") + grid->getName();
  return names;
}

GridBase::Ptr chooseGrid(std::span<const GridBase::Ptr> grids, const std::string& name) {
  if (grids.empty()) throw InputError("there is no grid to show");
  if (!name.empty()) {
    for (const auto& grid : grids) {
      if (grid->getName() != name) continue;
      if (isShowable(*grid)) return grid;
      throw InputError("grid " + name + " is of type " + grid->valueType() +
                       ", which has no surface to show");
    }
    throw InputError("there is no grid " + name + "; there are " + namesOf(grids));
  }
  GridBase::Ptr best;
  for (const auto& grid : grids) {
    if (!isShowable(*grid) || grid->activeVoxelCount() == 0) continue;
    if (!best || preference(*grid) < preference(*best)) best = grid;
  }
  if (best && (*best)[kPartNameMetadata]) return joinedParts(grids);
  if (best) return best;
  throw InputError("no grid of numbers has active voxels to show; there are " + namesOf(grids));
}

/// Calls visit(value) for the active values of a tree.
template <class TreeT, class Visit>
void forActiveValues(const TreeT& tree, Visit&& visit) {
  for (auto value = tree.cbeginValueOn(); value; ++value) visit(*value);
}

template <class TreeT>
double largestValue(const TreeT& tree) {
  double largest = 0;
  forActiveValues(tree, [&](const auto& value) {
    largest = std::max(largest, static_cast<double>(value));  // keeps the first if one is NaN
  });
  return largest;
}

/// The active voxels above a threshold.
template <class TreeT>
openvdb::MaskTree::Ptr solidVoxels(const TreeT& tree, double threshold) {
  const auto isSolid = [&](const auto& value) { return static_cast<double>(value) > threshold; };
  auto solid = std::make_shared<openvdb::MaskTree>(tree, false, true, openvdb::TopologyCopy());
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(TreeT::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
    if (!isSolid(*tile)) solid->addTile(tile.getLevel(), tile.getCoord(), false, false);
  for (auto leaf = solid->beginLeaf(); leaf; ++leaf) {
    const auto* source = tree.probeConstLeaf(leaf->origin());
    for (auto voxel = source->cbeginValueOn(); voxel; ++voxel)
      if (!isSolid(*voxel)) leaf->setValueOff(voxel.pos());
  }
  openvdb::tools::pruneInactive(*solid);
  return solid;
}

openvdb::MaskTree::ConstPtr solidVoxels(const GridBase::Ptr& grid,
                                        std::optional<double> threshold) {
  if (const auto mask = openvdb::gridPtrCast<openvdb::MaskGrid>(grid)) return mask->treePtr();
  openvdb::MaskTree::Ptr solid;
  grid->apply<ScalarGrids>([&](const auto& scalar) {
    constexpr double kPartOfLargest = 0.1;
    const bool isPart = grid->isType<openvdb::Int32Grid>() && grid->getName() == "part";
    const double least = threshold ? *threshold
                         : isPart  ? 0
                                   : kPartOfLargest * largestValue(scalar.tree());
    solid = solidVoxels(scalar.tree(), least);
  });
  if (solid->empty())
    throw InputError("grid " + grid->getName() + " has no active voxel above the threshold" +
                     (threshold ? "; lower it" : " of a tenth of its largest value"));
  return solid;
}

openvdb::FloatGrid::ConstPtr asFloats(const GridBase::Ptr& grid) {
  if (const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid)) return floats;
  return std::make_shared<openvdb::FloatGrid>(*openvdb::gridPtrCast<openvdb::DoubleGrid>(grid));
}

template <class TreeT>
std::vector<openvdb::CoordBBox> boxesOfTree(const TreeT& tree) {
  std::vector<openvdb::CoordBBox> boxes;
  boxes.reserve(tree.leafCount());
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    openvdb::CoordBBox box;
    leaf->evalActiveBoundingBox(box, /*visitVoxels=*/true);
    if (!box.empty()) boxes.push_back(box);
  }
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(TreeT::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    openvdb::CoordBBox box;
    tile.getBoundingBox(box);
    boxes.push_back(box);
  }
  return boxes;
}

void requireLinear(const GridBase& grid) {
  if (!grid.transform().isLinear())
    throw InputError("grid " + grid.getName() +
                     " lies in a frustum; only grids with a linear transform can be shown");
  const double determinant = grid.transform().baseMap()->determinant();
  if (determinant == 0 || !std::isfinite(determinant))
    throw InputError("the transform of grid " + grid.getName() + " is singular");
}

void requireInRange(const std::vector<openvdb::CoordBBox>& boxes, const std::string& name) {
  const auto limit = static_cast<openvdb::Int32>(kMaxIndex);
  for (const auto& box : boxes)
    for (int axis = 0; axis < 3; ++axis)
      if (box.min()[axis] < -limit || box.max()[axis] > limit)
        throw LimitError("grid " + name + " has voxels beyond 2^30 of its origin");
}

/// The grid of vectors with one of two names, if it has the transform of the grid that is shown.
openvdb::Vec3SGrid::ConstPtr vectorsNamed(std::span<const GridBase::Ptr> grids,
                                          std::string_view name, std::string_view otherName,
                                          const GridBase& shown) {
  for (const auto& grid : grids) {
    if (grid->getName() != name && grid->getName() != otherName) continue;
    const auto vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grid);
    if (vectors && vectors->transform() == shown.transform()) return vectors;
  }
  return nullptr;
}

/// A colour for each part: hues that differ much between parts with near numbers.
openvdb::Vec3f colorOfPart(openvdb::Int32 part) {
  constexpr double kGoldenPart = 0.6180339887498949;
  constexpr double kLight = 0.7;
  constexpr double kGrey = 0.1;
  const double hue = 6 * std::fmod(kGoldenPart * part, 1.0);
  openvdb::Vec3f color;
  for (int k = 0; k < 3; ++k) {
    const double away = std::abs(std::remainder(hue - 2 * k, 6.0));  // from the hue of channel k
    color[k] = static_cast<float>(kGrey + (kLight - kGrey) * std::clamp(2 - away, 0.0, 1.0));
  }
  return color;
}

/// Colours of the parts of the grid `part`, if it has the transform of the grid that is shown.
openvdb::Vec3SGrid::ConstPtr partColors(std::span<const GridBase::Ptr> grids,
                                        const GridBase& shown) {
  for (const auto& grid : grids) {
    const auto parts = openvdb::gridPtrCast<openvdb::Int32Grid>(grid);
    if (!parts || parts->getName() != "part" || parts->transform() != shown.transform()) continue;
    const auto colors = std::make_shared<openvdb::Vec3STree>(parts->tree(), openvdb::Vec3f(0),
                                                             openvdb::TopologyCopy());
    for (auto value = parts->tree().cbeginValueOn(); value; ++value)
      if (value.isVoxelValue())
        colors->setValueOnly(value.getCoord(), colorOfPart(*value));
      else
        colors->addTile(value.getLevel(), value.getBoundingBox().min(), colorOfPart(*value), true);
    return openvdb::Vec3SGrid::create(colors);
  }
  return nullptr;
}

VisibleGrids look(std::span<const GridBase::Ptr> grids, const VisibleOptions& options) {
  const GridBase::Ptr shown = chooseGrid(grids, options.grid);
  requireLinear(*shown);
  VisibleGrids visible;
  if (isLevelSet(*shown)) {
    if (!shown->hasUniformVoxels())
      throw InputError("level set " + shown->getName() +
                       " has voxels that are no cubes; resample it first");
    visible.levelSet = asFloats(shown);
    visible.levelSet->tree().readNonresidentBuffers();
    visible.boxes = boxesOfTree(visible.levelSet->tree());
  } else {
    visible.voxels = solidVoxels(shown, options.threshold);
    visible.boxes = boxesOfTree(*visible.voxels);
  }
  if (visible.boxes.empty()) throw InputError("grid " + shown->getName() + " has no active voxels");
  requireInRange(visible.boxes, shown->getName());
  visible.toWorld = shown->transformPtr();
  visible.normals = vectorsNamed(grids, "normal", "N", *shown);
  visible.colors = vectorsNamed(grids, "color", "Cd", *shown);
  if (!visible.colors) visible.colors = partColors(grids, *shown);
  for (const auto& vectors : {visible.normals, visible.colors})
    if (vectors) vectors->tree().readNonresidentBuffers();
  return visible;
}

}  // namespace

std::vector<openvdb::CoordBBox> boxesOf(const openvdb::MaskTree& voxels) {
  return boxesOfTree(voxels);
}

VisibleGrids visibleGrids(std::span<const GridBase::Ptr> grids, const VisibleOptions& options) {
  try {
    return look(grids, options);
  } catch (const openvdb::Exception& wrong) {  // values are read from the file only now
    constexpr std::size_t kMost = 200;
    throw InputError("the grids cannot be read: " + std::string(wrong.what()).substr(0, kMost));
  }
}

}  // namespace vox
