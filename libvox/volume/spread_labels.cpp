// Labels of the inside of solids, by propagation of the nearest source from voxel to voxel.

#include "libvox/volume/spread_labels.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace vox {
namespace {

using openvdb::Coord;
using LabelLeaf = openvdb::Int32Tree::LeafNodeType;

struct Source {
  Coord at;
  openvdb::Int32 label;
};

constexpr int kBrickSide = 10;  // of a leaf, and one voxel more on all sides

/// The neighbours of a leaf, itself among them: a place for each step of -1, 0 or 1 along each
/// axis.
using Neighbours = std::array<std::uint32_t, 27>;
constexpr std::uint32_t kNoLeaf = std::numeric_limits<std::uint32_t>::max();

constexpr std::size_t stepSlot(int x, int y, int z) {
  return static_cast<std::size_t>((x + 1) * 9 + (y + 1) * 3 + z + 1);
}

/// The numbers of sources of a leaf and of one voxel more on all sides; 0: none.
class Brick {
 public:
  void read(const std::vector<LabelLeaf*>& leaves, const Neighbours& neighbours) {
    std::array<const openvdb::Int32*, 27> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
      if (neighbours[i] != kNoLeaf) values[i] = leaves[neighbours[i]]->buffer().data();
    std::size_t slot = 0;
    for (int x = -1; x <= 8; ++x)
      for (int y = -1; y <= 8; ++y) {
        unsigned row = 0;
        for (int z = -1; z <= 8; ++z) {
          const openvdb::Int32* const from = values[stepSlot(x >> 3, y >> 3, z >> 3)];
          const openvdb::Int32 source =
              from == nullptr ? 0 : from[((x & 7) << 6) + ((y & 7) << 3) + (z & 7)];
          sources_[slot++] = source;
          row |= (source != 0 ? 1U : 0U) << static_cast<unsigned>(z + 1);
        }
        known_[static_cast<std::size_t>((x + 1) * kBrickSide + y + 1)] = row;
      }
  }

  /// The voxels of a row of the leaf that have a neighbour with a source, or have one: a bit for
  /// each.
  unsigned nearKnown(int x, int y) const {
    unsigned any = 0;
    for (int i = x; i <= x + 2; ++i)
      for (int j = y; j <= y + 2; ++j) any |= known_[static_cast<std::size_t>(i * kBrickSide + j)];
    return (any | any >> 1U | any >> 2U) & 0xFFU;
  }

  /// The nearest of the sources of the neighbours of a voxel, which has such neighbours.
  openvdb::Int32 nearest(openvdb::Index offset, const Coord& voxel,
                         const std::vector<Source>& sources) const {
    const int x = static_cast<int>(offset >> 6), y = static_cast<int>(offset >> 3 & 7U),
              z = static_cast<int>(offset & 7U);
    openvdb::Int32 best = 0;
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    openvdb::Int32 last = 0;
    for (int i = x; i <= x + 2; ++i)
      for (int j = y; j <= y + 2; ++j)
        for (int k = z; k <= z + 2; ++k) {
          const openvdb::Int32 source =
              sources_[static_cast<std::size_t>((i * kBrickSide + j) * kBrickSide + k)];
          if (source == 0 || source == last) continue;
          last = source;
          std::int64_t squared = 0;
          for (int axis = 0; axis < 3; ++axis) {
            const std::int64_t step =
                std::int64_t{sources[static_cast<std::size_t>(source) - 1].at[axis]} - voxel[axis];
            squared += step * step;
          }
          if (squared > least || (squared == least && source > best)) continue;
          least = squared;
          best = source;
        }
    return best;
  }

 private:
  std::array<openvdb::Int32, kBrickSide * kBrickSide * kBrickSide> sources_;
  std::array<unsigned, kBrickSide * kBrickSide> known_;  // of each row, the voxels with a source
};

/// A voxel that a layer reaches.
struct Reached {
  std::uint16_t offset;
  openvdb::Int32 source;
};

class Spreading {
 public:
  Spreading(openvdb::Int32Tree& labels, const Progress& progress) : progress_(progress) {
    labels.getNodes(leaves_);
    findSources();
    findNeighbours();
  }

  void run() {
    std::vector<std::uint32_t> changed;
    for (std::uint32_t l = 0; l < leaves_.size(); ++l)
      if (leaves_[l]->onVoxelCount() > left_[l]) changed.push_back(l);
    while (!changed.empty()) changed = layer(changed);
    parallelForEach(leaves_.size(), kGrain, [&](std::size_t l) {
      openvdb::Int32* const values = leaves_[l]->buffer().data();
      for (auto voxel = leaves_[l]->cbeginValueOn(); voxel; ++voxel)
        if (values[voxel.pos()] > 0)
          values[voxel.pos()] = sources_[static_cast<std::size_t>(values[voxel.pos()]) - 1].label;
    });
  }

 private:
  static constexpr std::size_t kGrain = 16;

  /// Puts numbers of sources, from 1, in the place of their labels.
  void findSources() {
    left_.resize(leaves_.size());
    for (std::size_t l = 0; l < leaves_.size(); ++l) {
      openvdb::Int32* const values = leaves_[l]->buffer().data();
      for (auto voxel = leaves_[l]->cbeginValueOn(); voxel; ++voxel) {
        openvdb::Int32& value = values[voxel.pos()];
        if (value == 0) {
          ++left_[l];
          continue;
        }
        sources_.push_back({voxel.getCoord(), value});
        if (sources_.size() >= std::size_t{std::numeric_limits<openvdb::Int32>::max()})
          throw LimitError("the surface has too many voxels to label what is inside");
        value = static_cast<openvdb::Int32>(sources_.size());
      }
    }
  }

  void findNeighbours() {
    std::unordered_map<Coord, std::uint32_t> numbers(leaves_.size());
    for (std::uint32_t l = 0; l < leaves_.size(); ++l) numbers[leaves_[l]->origin()] = l;
    neighbours_.resize(leaves_.size());
    parallelForEach(leaves_.size(), kGrain, [&](std::size_t l) {
      for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
          for (int z = -1; z <= 1; ++z) {
            constexpr int kLeaf = LabelLeaf::DIM;
            const auto found =
                numbers.find(leaves_[l]->origin().offsetBy(kLeaf * x, kLeaf * y, kLeaf * z));
            neighbours_[l][stepSlot(x, y, z)] = found == numbers.end() ? kNoLeaf : found->second;
          }
    });
    stamps_.resize(leaves_.size(), 0);
    reached_.resize(leaves_.size());
  }

  /// Reaches one voxel further from the leaves that the last layer changed.
  /// @return  the leaves that this layer changed
  std::vector<std::uint32_t> layer(const std::vector<std::uint32_t>& changed) {
    progress_.check();
    ++stamp_;
    std::vector<std::uint32_t> open;
    for (const std::uint32_t leaf : changed)
      for (const std::uint32_t next : neighbours_[leaf])
        if (next != kNoLeaf && left_[next] > 0 && std::exchange(stamps_[next], stamp_) != stamp_)
          open.push_back(next);
    parallelForEach(open.size(), kGrain, [&](std::size_t i) { reach(open[i]); });
    std::vector<std::uint32_t> next;
    for (const std::uint32_t leaf : open) {
      std::vector<Reached>& voxels = reached_[leaf];
      if (voxels.empty()) continue;
      for (const Reached& voxel : voxels)
        leaves_[leaf]->buffer().data()[voxel.offset] = voxel.source;
      left_[leaf] -= voxels.size();
      voxels = {};
      next.push_back(leaf);
    }
    return next;
  }

  /// Finds the voxels of a leaf that have neighbours with a source.
  void reach(std::uint32_t leaf) {
    Brick brick;
    brick.read(leaves_, neighbours_[leaf]);
    const LabelLeaf& labels = *leaves_[leaf];
    for (int x = 0; x < 8; ++x)
      for (int y = 0; y < 8; ++y)
        for (unsigned left = brick.nearKnown(x, y); left != 0; left &= left - 1) {
          const auto offset = static_cast<openvdb::Index>(x << 6 | y << 3 | std::countr_zero(left));
          if (!labels.isValueOn(offset) || labels.getValue(offset) != 0) continue;
          const openvdb::Int32 source =
              brick.nearest(offset, labels.offsetToGlobalCoord(offset), sources_);
          reached_[leaf].push_back({static_cast<std::uint16_t>(offset), source});
        }
  }

  const Progress& progress_;
  std::vector<LabelLeaf*> leaves_;
  std::vector<Source> sources_;
  std::vector<std::uint64_t> left_;  // of each leaf: active voxels without a source
  std::vector<Neighbours> neighbours_;
  std::vector<std::uint32_t> stamps_;  // of each leaf: the last layer that looked at it
  std::uint32_t stamp_ = 0;
  std::vector<std::vector<Reached>> reached_;  // of each leaf, by the current layer
};

}  // namespace

void spreadLabels(openvdb::Int32Tree& labels, const Progress& progress) {
  Spreading(labels, progress).run();
}

std::uint64_t bytesOfSpreading(std::uint64_t leaves, std::uint64_t sources) {
  constexpr std::uint64_t kOfMap = 48;
  return leaves * (sizeof(LabelLeaf*) + sizeof(Neighbours) + sizeof(std::vector<Reached>) +
                   sizeof(std::uint64_t) + sizeof(std::uint32_t) + kOfMap) +
         2 * sources * sizeof(Source);
}

}  // namespace vox
