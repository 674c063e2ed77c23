// OpenVDB nodes that all threads write to, with a lock per page.

#include "libvox/grid/active_voxels.h"

#include "libvox/core/error.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace vox {
namespace {

using Leaf = openvdb::MaskTree::LeafNodeType;
using Upper = openvdb::MaskTree::RootNodeType::ChildNodeType;

/// Bytes that the heap needs for an object beyond its size.
constexpr std::uint64_t kHeapOverhead = 16;

/// New leaves of a page are added to the account in groups of this size. (A page itself takes as
/// much memory as hundreds of leaves.)
constexpr std::uint32_t kLeavesPerAccount = 16;

}  // namespace

ActiveVoxels::~ActiveVoxels() {
  for (auto& [origin, page] : pages_) delete page.node;
}

void ActiveVoxels::account(std::uint64_t bytes) {
  const std::uint64_t total = memoryBytes_.fetch_add(bytes, std::memory_order_relaxed) + bytes;
  if (memoryLimit_ > 0 && total > memoryLimit_)
    throw LimitError(
        "the grid needs more than the " + formatBytes(memoryLimit_) +
        " that are left for it: the surface is large, or scattered over much space; use "
        "larger voxels, or raise --max-memory");
}

ActiveVoxels::Page& ActiveVoxels::pageOf(const openvdb::Coord& voxel) {
  const openvdb::Coord origin = (voxel >> kPageLog2) << kPageLog2;
  const auto found = pages_.find(origin);
  if (found != pages_.end()) return found->second;
  return pages_
      .emplace(std::piecewise_construct, std::forward_as_tuple(origin), std::forward_as_tuple())
      .first->second;
}

void ActiveVoxels::add(std::span<PageLeaf> leaves) {
  while (!leaves.empty()) {
    Page& page = *leaves[0].page;
    const auto others = std::partition(leaves.begin(), leaves.end(),
                                       [&](const PageLeaf& leaf) { return leaf.page == &page; });
    const tbb::spin_mutex::scoped_lock lock(page.lock);
    for (const PageLeaf& leaf : leaves.first(static_cast<std::size_t>(others - leaves.begin()))) {
      const LeafWords words = region_.within(leaf.words, leaf.origin);
      if (region_.isAll() || words != LeafWords{}) addToPage(page, leaf.origin, words);
    }
    leaves = leaves.subspan(static_cast<std::size_t>(others - leaves.begin()));
  }
}

/// Precondition: the caller holds the lock of the page.
void ActiveVoxels::addToPage(Page& page, const openvdb::Coord& leafOrigin, const LeafWords& words) {
  if (page.node == nullptr) {
    account(sizeof(PageNode) + kHeapOverhead);
    if (uppers_.insert((leafOrigin >> kUpperLog2) << kUpperLog2).second)
      account(sizeof(Upper) + kHeapOverhead);
    page.node = new PageNode((leafOrigin >> kPageLog2) << kPageLog2, false);
  }
  Leaf* leaf = page.node->probeLeaf(leafOrigin);
  if (leaf == nullptr) {
    if (++page.newLeaves == kLeavesPerAccount) {
      account(kLeavesPerAccount * (sizeof(Leaf) + kHeapOverhead));
      page.newLeaves = 0;
    }
    leaf = new Leaf(leafOrigin, false);
    page.node->addLeaf(leaf);
  }
  page.voxels += mergeLeaf(leaf->buffer().data(), words);
}

std::uint64_t ActiveVoxels::countVoxels() const {
  std::uint64_t count = 0;
  for (const auto& [origin, page] : pages_) count += page.voxels;
  return count;
}

openvdb::MaskTree::Ptr ActiveVoxels::takeTree() {
  auto tree = std::make_shared<openvdb::MaskTree>();
  for (auto& [origin, page] : pages_) {
    if (page.node == nullptr) continue;
    Upper* upper = tree->probeNode<Upper>(origin);
    if (upper == nullptr) {
      upper = new Upper(origin, false);
      tree->root().addChild(upper);
    }
    upper->addChild(std::exchange(page.node, nullptr));
  }
  pages_.clear();
  uppers_.clear();
  memoryBytes_ = 0;
  return tree;
}

}  // namespace vox
