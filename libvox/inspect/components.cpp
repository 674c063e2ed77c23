// Connected components, leaf by leaf. The leaves and tiles of a tree stand in columns along z. The
// voxels of a leaf are divided into connected pieces; the space between two leaves of a column is
// one piece. Neighbouring pieces are united. Space with no leaf above it, or none below it, is
// outside and needs no piece.

#include "libvox/inspect/components.h"

#include "libvox/core/error.h"
#include "libvox/core/forest.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/leaf_words.h"
#include "libvox/grid/openvdb.h"
#include "libvox/inspect/leaf_pieces.h"

#include <openvdb/tools/Morphology.h>

#include <algorithm>
#include <limits>
#include <map>
#include <span>
#include <tuple>
#include <unordered_map>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::MaskTree;
using Leaf = MaskTree::LeafNodeType;

constexpr std::size_t kLeafLog2 = 3;
constexpr std::uint64_t kLeafVoxels = 512;
constexpr LeafWords kAllVoxels = {~0ULL, ~0ULL, ~0ULL, ~0ULL, ~0ULL, ~0ULL, ~0ULL, ~0ULL};

/// Leaves z0..z1 of a column: one leaf, or a run of cubes that hold one value.
struct Entry {
  std::int32_t x, y, z0, z1;     ///< in leaves
  const Leaf* leaf = nullptr;    ///< null: a run
  bool solid = false;            ///< of a run: of active voxels
  std::uint32_t firstPiece = 0;  ///< what of it counts
  std::uint32_t pieceCount = 0;
  std::uint32_t firstWords = 0;  ///< of a leaf: the voxels of its pieces

  bool operator<(const Entry& other) const {
    return std::tie(x, y, z0) < std::tie(other.x, other.y, other.z0);
  }
};

LeafWords wordsOf(const Leaf& leaf, bool active) {
  const LeafWords words = activeWords(leaf);
  return active ? words : complementOf(words);
}

/// Leaves with active voxels, and tiles as runs, column by column.
std::vector<Entry> activeEntries(const MaskTree& tree) {
  std::vector<Entry> entries;
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    if (leaf->isEmpty()) continue;
    const Coord at = leaf->origin() >> kLeafLog2;
    entries.push_back({at.x(), at.y(), at.z(), at.z(), &*leaf});
  }
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(MaskTree::ValueOnCIter::LEAF_DEPTH - 1);
  constexpr std::size_t kMost = std::size_t{1} << 26U;
  for (; tile; ++tile) {
    const openvdb::CoordBBox box = tile.getBoundingBox() >> kLeafLog2;
    if (entries.size() +
            static_cast<std::size_t>(box.dim().x()) * static_cast<std::size_t>(box.dim().y()) >
        kMost)
      throw LimitError("the tiles of the grid are too large to look for components");
    for (std::int32_t x = box.min().x(); x <= box.max().x(); ++x)
      for (std::int32_t y = box.min().y(); y <= box.max().y(); ++y)
        entries.push_back({x, y, box.min().z(), box.max().z(), nullptr, true});
  }
  parallelSort(entries);
  return entries;
}

bool sameColumn(const Entry& a, const Entry& b) {
  return a.x == b.x && a.y == b.y;
}

/// The same with the spaces between them, as runs.
std::vector<Entry> withGaps(const std::vector<Entry>& entries) {
  std::vector<Entry> all;
  all.reserve(2 * entries.size());
  for (const Entry& entry : entries) {
    if (!all.empty() && sameColumn(all.back(), entry) && all.back().z1 + 1 < entry.z0)
      all.push_back({entry.x, entry.y, all.back().z1 + 1, entry.z0 - 1});
    all.push_back(entry);
  }
  return all;
}

/// Pieces of the active or of the inactive voxels, and which of them are connected.
class Pieces {
 public:
  Pieces(std::vector<Entry> entries, bool active)
      : entries_(std::move(entries)),
        active_(active),
        neighbours_(active ? Neighbours::k26 : Neighbours::k6) {
    makePieces();
    findColumns();
    for (const Entry& entry : entries_)
      if (entry.leaf != nullptr)
        uniteLeaf(entry);
      else
        uniteRun(entry);
  }

  /// Components other than the outside, by their first voxel.
  std::vector<Component> components() {
    std::map<std::uint32_t, Component> byRoot;
    for (const Entry& entry : entries_)
      for (std::uint32_t i = 0; i < entry.pieceCount; ++i) {
        const std::uint32_t root = sets_.find(entry.firstPiece + i);
        if (root == sets_.find(kOutside) && !active_) continue;
        const auto [voxels, first] = sizeOf(entry, i);
        const auto [found, isNew] = byRoot.try_emplace(root, Component{0, first});
        found->second.voxels += voxels;
        found->second.first = std::min(found->second.first, first);
      }
    std::vector<Component> all;
    for (const auto& [root, component] : byRoot) all.push_back(component);
    std::sort(all.begin(), all.end(),
              [](const Component& a, const Component& b) { return a.first < b.first; });
    return all;
  }

  bool isOutside(const Coord& voxel) {
    const Coord cell = voxel >> kLeafLog2;
    const Entry* const entry = entryAt(columnAt(cell.x(), cell.y()), cell.z());
    if (entry == nullptr) return true;
    const openvdb::Index offset = Leaf::coordToOffset(voxel);
    for (std::uint32_t i = 0; i < entry->pieceCount; ++i)
      if (wordsOf(*entry, i)[offset >> 6U] >> (offset & 63U) & 1U)
        return sets_.find(entry->firstPiece + i) == sets_.find(kOutside);
    return false;
  }

 private:
  static constexpr std::uint32_t kOutside = 0;
  using Column = std::span<const Entry>;

  const LeafWords& wordsOf(const Entry& entry, std::uint32_t piece) const {
    return entry.leaf == nullptr ? kAllVoxels : words_[entry.firstWords + piece];
  }

  void makePieces() {
    std::vector<std::vector<LeafWords>> found(entries_.size());
    constexpr std::size_t kGrain = 256;
    parallelForEach(entries_.size(), kGrain, [&](std::size_t i) {
      if (entries_[i].leaf == nullptr) return;
      for (LeafWords left = vox::wordsOf(*entries_[i].leaf, active_); left != LeafWords{};)
        found[i].push_back(takePiece(left, neighbours_));
    });
    std::uint64_t pieces = 1;  // piece 0 is the outside
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      Entry& entry = entries_[i];
      entry.firstPiece = static_cast<std::uint32_t>(pieces);
      entry.firstWords = static_cast<std::uint32_t>(words_.size());
      words_.insert(words_.end(), found[i].begin(), found[i].end());
      entry.pieceCount = static_cast<std::uint32_t>(found[i].size());
      if (entry.leaf == nullptr) entry.pieceCount = entry.solid == active_ ? 1 : 0;
      found[i] = {};
      pieces += entry.pieceCount;
      if (pieces > std::numeric_limits<std::uint32_t>::max())
        throw LimitError("the grid has too many pieces to look for components");
    }
    sets_ = Forest(pieces);
  }

  static std::uint64_t keyOf(std::int32_t x, std::int32_t y) {
    return std::uint64_t{static_cast<std::uint32_t>(x)} << 32U | static_cast<std::uint32_t>(y);
  }

  void findColumns() {
    for (std::size_t begin = 0; begin < entries_.size();) {
      std::size_t end = begin + 1;
      while (end < entries_.size() && sameColumn(entries_[begin], entries_[end])) ++end;
      columns_[keyOf(entries_[begin].x, entries_[begin].y)] = {begin, end - begin};
      begin = end;
    }
  }

  Column columnAt(std::int32_t x, std::int32_t y) const {
    const auto found = columns_.find(keyOf(x, y));
    if (found == columns_.end()) return {};
    return Column(entries_).subspan(found->second.first, found->second.second);
  }

  /// The first one of a column that does not end before z.
  static Column::iterator from(Column column, std::int32_t z) {
    return std::lower_bound(column.begin(), column.end(), z,
                            [](const Entry& entry, std::int32_t at) { return entry.z1 < at; });
  }

  static const Entry* entryAt(Column column, std::int32_t z) {
    const auto entry = from(column, z);
    return entry != column.end() && entry->z0 <= z ? &*entry : nullptr;
  }

  bool isStep(int dx, int dy, int dz) const {
    const int sum = std::abs(dx) + std::abs(dy) + std::abs(dz);
    return neighbours_ == Neighbours::k26 ? sum > 0 : sum == 1;
  }

  void uniteLeaf(const Entry& entry) {
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        if (!isStep(dx, dy, 0) && !isStep(dx, dy, 1)) continue;
        const Column column = columnAt(entry.x + dx, entry.y + dy);
        for (int dz = -1; dz <= 1; ++dz)
          if (isStep(dx, dy, dz))
            uniteLeafWith(entry, {dx, dy, dz}, entryAt(column, entry.z0 + dz));
      }
  }

  void uniteLeafWith(const Entry& entry, const Coord& d, const Entry* other) {
    if (other == nullptr && active_) return;
    // Two leaves find each other twice; one of the times is enough.
    if (other != nullptr && other->leaf != nullptr && d < Coord(0, 0, 0)) return;
    for (std::uint32_t i = 0; i < entry.pieceCount; ++i) {
      const LeafWords& words = wordsOf(entry, i);
      if (other == nullptr) {
        if (touch(words, d, kAllVoxels, neighbours_)) sets_.unite(entry.firstPiece + i, kOutside);
        continue;
      }
      for (std::uint32_t j = 0; j < other->pieceCount; ++j)
        if (touch(words, d, wordsOf(*other, j), neighbours_))
          sets_.unite(entry.firstPiece + i, other->firstPiece + j);
    }
  }

  /// Unites a run with the runs beside it. Leaves are united with runs where the leaves are
  /// visited.
  void uniteRun(const Entry& run) {
    if (run.pieceCount == 0) return;
    const int wide = neighbours_ == Neighbours::k26 ? 1 : 0;
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        if (!isStep(dx, dy, 0) && (dx != 0 || dy != 0)) continue;
        const Column column = columnAt(run.x + dx, run.y + dy);
        const int more = dx == 0 && dy == 0 ? 1 : wide;
        if (!active_ && (column.empty() || run.z0 < column.front().z0 || run.z1 > column.back().z1))
          sets_.unite(run.firstPiece, kOutside);
        for (auto other = from(column, run.z0 - more);
             other != column.end() && other->z0 <= run.z1 + more; ++other)
          if (other->leaf == nullptr && other->pieceCount > 0)
            sets_.unite(run.firstPiece, other->firstPiece);
      }
  }

  std::pair<std::uint64_t, VoxelIndex> sizeOf(const Entry& entry, std::uint32_t piece) const {
    Coord first = Coord(entry.x, entry.y, entry.z0) << kLeafLog2;
    if (entry.leaf == nullptr)
      return {kLeafVoxels * static_cast<std::uint64_t>(entry.z1 - entry.z0 + 1),
              {first.x(), first.y(), first.z()}};
    const LeafWords& words = wordsOf(entry, piece);
    first += firstOf(words);
    return {countOf(words), {first.x(), first.y(), first.z()}};
  }

  std::vector<Entry> entries_;
  bool active_;
  Neighbours neighbours_;
  std::vector<LeafWords> words_;
  Forest sets_{0};
  std::unordered_map<std::uint64_t, std::pair<std::size_t, std::size_t>> columns_;
};

}  // namespace

struct Cavities::Labels {
  Pieces pieces;
};

std::vector<Component> activeComponents(const MaskTree& voxels) {
  return Pieces(activeEntries(voxels), true).components();
}

Cavities::Cavities(const MaskTree& voxels)
    : labels_(new Labels{Pieces(withGaps(activeEntries(voxels)), false)}),
      enclosed_(labels_->pieces.components()) {}

Cavities::~Cavities() = default;

bool Cavities::isOutside(const VoxelIndex& voxel) const {
  return labels_->pieces.isOutside({voxel[0], voxel[1], voxel[2]});
}

std::vector<Component> leakingSpaces(const MaskTree& voxels, std::uint64_t leastVoxels) {
  MaskTree thick(voxels);
  openvdb::tools::dilateActiveValues(thick, 1, openvdb::tools::NN_FACE_EDGE_VERTEX);
  const Cavities before(voxels);
  std::vector<Component> leaking;
  const Cavities after(thick);
  for (const Component& space : after.enclosed())
    if (space.voxels >= leastVoxels && before.isOutside(space.first)) leaking.push_back(space);
  return leaking;
}

}  // namespace vox
