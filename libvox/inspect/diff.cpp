// Comparison of grids and of .vdb files.

#include "libvox/inspect/diff.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/inspect/compared.h"
#include "libvox/inspect/compared_types.h"
#include "libvox/inspect/nearest_active.h"
#include "libvox/inspect/tree_pair.h"
#include "libvox/io/read_vdb.h"
#include "libvox/io/vdb_index.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <type_traits>
#include <utility>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::Index;
using LeafMask = openvdb::util::NodeMask<3>;

// Counting

/// Differences in a part of two trees.
struct Findings {
  TopologyDiff topology;
  ValueDiff values;
  double squares = 0;
  std::vector<LeafSurplus> leavesOnlyA, leavesOnlyB;
  std::vector<CoordBBox> boxesOnlyA, boxesOnlyB;
};

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void noteFirst(std::optional<VoxelIndex>& first, const VoxelIndex& voxel) {
  if (!first || voxel < *first) first = voxel;
}

void noteFirst(std::optional<VoxelIndex>& first, const std::optional<VoxelIndex>& voxel) {
  if (voxel) noteFirst(first, *voxel);
}

void add(Findings& all, const Findings& part) {
  for (std::size_t i : {0, 1}) all.topology.active[i] += part.topology.active[i];
  all.topology.onlyA += part.topology.onlyA;
  all.topology.onlyB += part.topology.onlyB;
  noteFirst(all.topology.first, part.topology.first);
  all.values.compared += part.values.compared;
  all.values.differing += part.values.differing;
  all.values.largest = std::max(all.values.largest, part.values.largest);
  all.values.inactiveDiffering += part.values.inactiveDiffering;
  noteFirst(all.values.first, part.values.first);
  all.squares += part.squares;
  append(all.leavesOnlyA, part.leavesOnlyA);
  append(all.leavesOnlyB, part.leavesOnlyB);
  append(all.boxesOnlyA, part.boxesOnlyA);
  append(all.boxesOnlyB, part.boxesOnlyB);
}

VoxelIndex indexOf(const Coord& voxel) {
  return {voxel.x(), voxel.y(), voxel.z()};
}

Coord inLeaf(const Coord& origin, Index offset) {
  return origin + openvdb::FloatTree::LeafNodeType::offsetToLocalCoord(offset);
}

std::uint64_t countOn(const LeafMask& mask) {
  return mask.countOn();
}

/// The visitor of TreePair that counts.
template <class Value>
class Counter {
 public:
  Counter(const Tolerance& tolerance, Findings& found) : tolerance_(tolerance), found_(found) {}

  template <class Leaf>
  void leaf(const Coord& origin, const Region<Leaf>& a, const Region<Leaf>& b) {
    const LeafMask inA = activeVoxels(a);
    const LeafMask inB = activeVoxels(b);
    TopologyDiff& topology = found_.topology;
    topology.active[0] += countOn(inA);
    topology.active[1] += countOn(inB);
    if (inA != inB) {
      topology.onlyA += noteSurplus(origin, inA, inB, found_.leavesOnlyA);
      topology.onlyB += noteSurplus(origin, inB, inA, found_.leavesOnlyB);
    }
    if constexpr (std::is_same_v<Leaf, openvdb::MaskTree::LeafNodeType>)
      found_.values.compared += countOn(inA & inB);
    else
      compareValues(origin, a, b, inA, inB);
  }

  template <class Node>
  void constant(const CoordBBox& box, const Region<Node>& a, const Region<Node>& b) {
    const std::uint64_t volume = box.volume();
    TopologyDiff& topology = found_.topology;
    if (a.active) topology.active[0] += volume;
    if (b.active) topology.active[1] += volume;
    if (a.active != b.active) {
      (a.active ? topology.onlyA : topology.onlyB) += volume;
      (a.active ? found_.boxesOnlyA : found_.boxesOnlyB).push_back(box);
      noteFirst(topology.first, indexOf(box.min()));
      return;
    }
    note(differenceOf(a.value, b.value, tolerance_), a.active, volume, box.min());
  }

 private:
  std::uint64_t noteSurplus(const Coord& origin, LeafMask in, const LeafMask& out,
                            std::vector<LeafSurplus>& leaves) {
    in -= out;
    if (in.isOff()) return 0;
    leaves.push_back({origin, in});
    noteFirst(found_.topology.first, indexOf(inLeaf(origin, in.findFirstOn())));
    return countOn(in);
  }

  template <class Leaf>
  void compareValues(const Coord& origin, const Region<Leaf>& a, const Region<Leaf>& b,
                     const LeafMask& inA, const LeafMask& inB) {
    const RegionValues<Leaf> valuesA(a);
    const RegionValues<Leaf> valuesB(b);
    if (valuesA.sameBitsAs(valuesB)) {
      found_.values.compared += countOn(inA & inB);
      return;
    }
    for (Index offset = 0; offset < Leaf::SIZE; ++offset) {
      const bool active = inA.isOn(offset);
      if (active != inB.isOn(offset)) continue;
      note(differenceOf<Value>(valuesA[offset], valuesB[offset], tolerance_), active, 1,
           [&] { return inLeaf(origin, offset); });
    }
  }

  void note(const Difference& difference, bool active, std::uint64_t volume, const Coord& first) {
    note(difference, active, volume, [&] { return first; });
  }

  template <class First>
  void note(const Difference& difference, bool active, std::uint64_t volume, First&& first) {
    ValueDiff& values = found_.values;
    if (!active) {
      if (difference.counts) values.inactiveDiffering += volume;
      return;
    }
    values.compared += volume;
    values.largest = std::max(values.largest, difference.size);
    found_.squares += difference.size * difference.size * static_cast<double>(volume);
    if (!difference.counts) return;
    values.differing += volume;
    noteFirst(values.first, indexOf(first()));
  }

  Tolerance tolerance_;
  Findings& found_;
};

template <class Tree>
NearestActive nearestIn(const Tree& tree) {
  std::vector<ActiveBlock> blocks;
  blocks.reserve(tree.leafCount());
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf)
    blocks.push_back({leaf->getNodeBoundingBox(), &leaf->getValueMask()});
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) blocks.push_back({tile.getBoundingBox(), nullptr});
  return NearestActive(std::move(blocks));
}

template <class Tree>
void measureDistance(const Tree& a, const Tree& b, Findings& found) {
  const auto measure = [&](const Tree& other, const auto& leaves, const auto& boxes) {
    if (leaves.empty() && boxes.empty()) return;
    found.topology.distance =
        std::max(found.topology.distance, largestDistance(leaves, boxes, nearestIn(other)));
  };
  measure(b, found.leavesOnlyA, found.boxesOnlyA);
  measure(a, found.leavesOnlyB, found.boxesOnlyB);
}

/// Differences of all parts, in the order of the parts: threads do not matter.
template <class Tree>
Findings compareTrees(const Tree& a, const Tree& b, const Tolerance& tolerance) {
  const TreePair<Tree> pair(a, b);
  std::vector<Findings> parts(pair.partCount());
  parallelForEach(parts.size(), 1, [&](std::size_t i) {
    Counter<typename Tree::ValueType> counter(tolerance, parts[i]);
    pair.visitPart(i, counter);
  });
  Findings all;
  for (Findings& part : parts) {
    add(all, part);
    part = {};
  }
  if (all.values.compared > 0)
    all.values.rms = std::sqrt(all.squares / static_cast<double>(all.values.compared));
  measureDistance(a, b, all);
  return all;
}

// Everything else

template <class Value>
std::string textOf(const Value& value) {
  std::ostringstream text;
  text.precision(9);
  text << value;
  return text.str();
}

openvdb::Mat4d matrixOf(const openvdb::math::Transform& transform) {
  return transform.baseMap()->getAffineMap()->getMat4();
}

std::string transformText(const openvdb::math::Transform& transform) {
  std::ostringstream text;
  text.precision(15);
  if (!transform.isLinear()) return transform.mapType();
  const openvdb::Mat4d matrix = matrixOf(transform);
  const bool turned = !openvdb::math::isDiagonal(matrix.getMat3());
  text << (turned ? "matrix" : "voxel size");
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      if (turned || row == column) text << ' ' << matrix(row, column);
  text << ", origin at " << matrix(3, 0) << ' ' << matrix(3, 1) << ' ' << matrix(3, 2);
  return text.str();
}

bool sameTransform(const openvdb::math::Transform& a, const openvdb::math::Transform& b) {
  if (!a.isLinear() || !b.isLinear()) return a == b;
  const openvdb::Mat4d x = matrixOf(a);
  const openvdb::Mat4d y = matrixOf(b);
  constexpr double kRounding = 1e-12;
  double largest = 0;
  double difference = 0;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 3; ++column) {
      largest = std::max({largest, std::abs(x(row, column)), std::abs(y(row, column))});
      difference = std::max(difference, std::abs(x(row, column) - y(row, column)));
    }
  return difference <= kRounding * largest;
}

void compareText(const std::string& what, const std::string& a, const std::string& b,
                 std::vector<TextDiff>& found) {
  if (a != b) found.push_back({what, a, b});
}

std::map<std::string, std::string> textsOf(const openvdb::MetaMap& metadata) {
  std::map<std::string, std::string> texts;
  for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry)
    if (!entry->first.starts_with("file_") && entry->first != openvdb::GridBase::META_GRID_CLASS &&
        entry->first != openvdb::GridBase::META_GRID_NAME)
      texts[entry->first] = entry->second->str();
  return texts;
}

std::vector<TextDiff> diffMetadata(const openvdb::MetaMap& a, const openvdb::MetaMap& b) {
  std::map<std::string, std::pair<std::string, std::string>> texts;
  for (const auto& [key, text] : textsOf(a)) texts[key].first = text;
  for (const auto& [key, text] : textsOf(b)) texts[key].second = text;
  std::vector<TextDiff> found;
  for (const auto& [key, both] : texts) compareText(key, both.first, both.second, found);
  return found;
}

/// All but the voxels and their values.
GridDiff diffHeads(const openvdb::GridBase& a, const openvdb::GridBase& b,
                   const DiffOptions& options) {
  GridDiff diff;
  diff.name = a.getName();
  diff.inA = diff.inB = true;
  compareText("type", a.type(), b.type(), diff.properties);
  compareText("class", openvdb::GridBase::gridClassToString(a.getGridClass()),
              openvdb::GridBase::gridClassToString(b.getGridClass()), diff.properties);
  if (!sameTransform(a.transform(), b.transform()))
    diff.properties.push_back(
        {"transform", transformText(a.transform()), transformText(b.transform())});
  if (options.metadata) diff.metadata = diffMetadata(a, b);
  return diff;
}

FileDiff diffFiles(const VdbFile& a, const VdbFile& b, const DiffOptions& options) {
  FileDiff diff;
  if (options.metadata) diff.metadata = diffMetadata(*a.metadata, *b.metadata);
  forEachPair(a, b, options, [&](const std::string& name, const auto& gridA, const auto& gridB) {
    if (gridA && gridB)
      diff.grids.push_back(diffGrids(*gridA, *gridB, options));
    else
      diff.grids.emplace_back();
    GridDiff& grid = diff.grids.back();
    grid.name = name;
    grid.inA = gridA != nullptr;
    grid.inB = gridB != nullptr;
    const openvdb::GridBase& any = gridA ? *gridA : *gridB;
    if (!gridA || !gridB) grid.topology.active[gridA ? 0 : 1] = any.activeVoxelCount();
  });
  return diff;
}

// Files of libvox, by their bytes

/// Number of active voxels, as a file says it.
std::optional<std::uint64_t> storedVoxelCount(const openvdb::GridBase& head) {
  const auto count =
      head.getMetadata<openvdb::Int64Metadata>(openvdb::GridBase::META_FILE_VOXEL_COUNT);
  if (!count || count->value() < 0) return std::nullopt;
  return static_cast<std::uint64_t>(count->value());
}

/// The difference of two grids that have the same tree; nothing if it takes more than their heads.
std::optional<GridDiff> diffOfSame(const openvdb::GridBase& a, const openvdb::GridBase& b,
                                   const DiffOptions& options) {
  const std::optional<std::uint64_t> count = storedVoxelCount(a);
  if (!count || !a.apply<ComparedTypes>([](const auto&) {})) return std::nullopt;
  GridDiff diff = diffHeads(a, b, options);
  diff.topology.active = {*count, *count};
  diff.topology.allowed = options.voxelTolerance;
  if (a.isType<openvdb::MaskGrid>()) return diff;
  diff.values.emplace();
  diff.values->compared = *count;
  return diff;
}

/// The numbers of the grids of a file by their names; nothing if two have the same name.
std::map<std::string, std::size_t> numbersByName(const VdbIndex& file) {
  std::map<std::string, std::size_t> numbers;
  for (std::size_t i = 0; i < file.grids.size(); ++i)
    if (!numbers.emplace(file.grids[i].descriptor->gridName(), i).second) return {};
  return numbers;
}

/// Grids of two sound files of libvox that have the same trees.
std::map<std::string, GridDiff> sameTrees(const VdbIndex& a, const VdbIndex& b,
                                          const DiffOptions& options) {
  const std::map<std::string, std::size_t> numbersB = numbersByName(b);
  std::map<std::string, GridDiff> same;
  for (const auto& [name, i] : numbersByName(a)) {
    const auto found = numbersB.find(name);
    if (found == numbersB.end() || !isChosen(name, options)) continue;
    if (!haveSameTree(a, i, b, found->second)) continue;
    const std::optional<GridDiff> diff =
        diffOfSame(*a.grids[i].head, *b.grids[found->second].head, options);
    if (diff) same.emplace(name, *diff);
  }
  return same;
}

/// Whether these are all grids of a file that are to be compared.
bool areAll(const std::map<std::string, GridDiff>& grids, const VdbIndex& file,
            const DiffOptions& options) {
  return std::all_of(file.grids.begin(), file.grids.end(), [&](const VdbIndexGrid& grid) {
    const std::string& name = grid.descriptor->gridName();
    return grids.contains(name) || !isChosen(name, options);
  });
}

/// The options for all grids but some, which are no longer asked for by name.
DiffOptions without(const std::map<std::string, GridDiff>& grids, DiffOptions options) {
  std::erase_if(options.onlyGrids, [&](const std::string& name) { return grids.contains(name); });
  return options;
}

}  // namespace

bool FileDiff::same() const {
  return metadata.empty() &&
         std::all_of(grids.begin(), grids.end(), [](const GridDiff& grid) { return grid.same(); });
}

GridDiff diffGrids(const openvdb::GridBase& a, const openvdb::GridBase& b,
                   const DiffOptions& options) {
  const Tolerance tolerance(options);
  GridDiff diff = diffHeads(a, b, options);
  const auto take = [&](TopologyDiff topology) {
    diff.topology = std::move(topology);
    diff.topology.allowed = options.voxelTolerance;
  };
  if (a.type() != b.type()) {
    take(compareTrees(*topologyOf(a), *topologyOf(b), tolerance).topology);
    return diff;
  }
  const bool known = a.apply<ComparedTypes>([&](const auto& typedA) {
    using Grid = std::decay_t<decltype(typedA)>;
    const auto& typedB = static_cast<const Grid&>(b);
    const Findings found = compareTrees(typedA.tree(), typedB.tree(), tolerance);
    take(found.topology);
    if constexpr (!std::is_same_v<Grid, openvdb::MaskGrid>) {
      diff.values = found.values;
      if (!differenceOf(typedA.background(), typedB.background(), tolerance).counts) return;
      diff.values->backgroundDiffers = true;
      compareText("background", textOf(typedA.background()), textOf(typedB.background()),
                  diff.properties);
    }
  });
  if (!known) refuseType(a);
  return diff;
}

FileDiff diffVdb(const std::filesystem::path& a, const std::filesystem::path& b,
                 const DiffOptions& options) {
  const Tolerance checked(options);
  const bool ownA = isSoundOwnVdb(a);
  const bool ownB = isSoundOwnVdb(b);
  if (!ownA || !ownB) {
    const VdbFile fileA = readVdb(a);
    const VdbFile fileB = readVdb(b);
    return diffFiles(fileA, fileB, options);
  }
  const VdbIndex indexA = readVdbIndex(a);
  const VdbIndex indexB = readVdbIndex(b);
  const std::map<std::string, GridDiff> same = sameTrees(indexA, indexB, options);
  const DiffOptions others = without(same, options);
  FileDiff diff;
  if ((others.onlyGrids.empty() || options.gridsMayLack) && areAll(same, indexA, options) &&
      areAll(same, indexB, options)) {
    if (options.metadata) diff.metadata = diffMetadata(*indexA.metadata, *indexB.metadata);
  } else {
    const auto wants = [&](const std::string& name) {
      return isChosen(name, options) && !same.contains(name);
    };
    const VdbFile fileA = readOwnVdb(a, wants);
    const VdbFile fileB = readOwnVdb(b, wants);
    diff = diffFiles(fileA, fileB, others);
  }
  for (const auto& [name, grid] : same) diff.grids.push_back(grid);
  std::sort(diff.grids.begin(), diff.grids.end(),
            [](const GridDiff& x, const GridDiff& y) { return x.name < y.name; });
  return diff;
}

}  // namespace vox
