#pragma once

#include "libvox/core/memory.h"
#include "libvox/core/types.h"
#include "libvox/grid/merge_leaf.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/region.h"

#include <tbb/concurrent_unordered_map.h>
#include <tbb/concurrent_unordered_set.h>
#include <tbb/spin_mutex.h>

#include <atomic>
#include <cstdint>
#include <span>

namespace vox {

/// The set of active voxels to which all tasks add. It consists of the OpenVDB nodes that become
/// the tree of the grid, so that nothing is copied or merged at the end. A page is an inner node of
/// 128^3 voxels with a lock of its own; tasks OR whole leaves into it. Order does not matter, so
/// the voxels do not depend on threads. Source: DESIGN section 11.
class ActiveVoxels {
 public:
  /// @param memoryLimit  bytes that the nodes may take; 0: no limit
  /// @param region       voxels outside it are not switched on
  explicit ActiveVoxels(std::uint64_t memoryLimit = 0, const Region& region = {})
      : memoryLimit_(memoryLimit), region_(region) {}
  ~ActiveVoxels();
  ActiveVoxels(const ActiveVoxels&) = delete;
  ActiveVoxels& operator=(const ActiveVoxels&) = delete;

  using PageNode = openvdb::MaskTree::RootNodeType::ChildNodeType::ChildNodeType;

  struct Page {
    tbb::spin_mutex lock;
    PageNode* node = nullptr;
    std::uint32_t newLeaves = 0;  // not yet counted in memoryBytes
    std::uint64_t voxels = 0;     // active voxels
  };

  /// The page of a voxel; made if there is none. The reference is valid until takeTree.
  /// Thread-safe.
  Page& pageOf(const openvdb::Coord& voxel);

  /// Some voxels of one leaf.
  struct PageLeaf {
    Page* page;
    openvdb::Coord origin;
    LeafWords words;
  };

  /// Switches on voxels of some leaves. Locks each page once; reorders the span. Thread-safe.
  /// @throws LimitError  the nodes would take more memory than the limit
  void add(std::span<PageLeaf> leaves);

  const Region& region() const { return region_; }

  /// Changes the memory limit. Not thread-safe.
  void setMemoryLimit(std::uint64_t bytes) { memoryLimit_ = bytes; }

  /// Bytes of the nodes so far, nearly: a page may have up to 15 leaves that are not counted yet.
  std::uint64_t memoryBytes() const { return memoryBytes_; }

  /// Number of active voxels. Cost O(pages). Not thread-safe.
  std::uint64_t countVoxels() const;

  /// Moves all nodes into a tree; leaves this object empty. Not thread-safe.
  openvdb::MaskTree::Ptr takeTree();

 private:
  void account(std::uint64_t bytes);
  void addToPage(Page& page, const openvdb::Coord& leafOrigin, const LeafWords& words);

  static constexpr std::size_t kPageLog2 = 7;
  static constexpr std::size_t kUpperLog2 = 12;
  struct OriginHash {
    std::size_t operator()(const openvdb::Coord& origin) const {
      std::size_t hash = 0;
      for (const auto i : {origin.x(), origin.y(), origin.z()})
        hash = (hash ^ static_cast<std::uint32_t>(i >> kPageLog2)) * 0x9e3779b97f4a7c15ULL;
      return hash ^ hash >> 32U;
    }
  };
  tbb::concurrent_unordered_map<openvdb::Coord, Page, OriginHash> pages_;
  tbb::concurrent_unordered_set<openvdb::Coord, OriginHash>
      uppers_;  // origins of the upper nodes that the tree will need
  std::uint64_t memoryLimit_;
  Region region_;
  std::atomic<std::uint64_t> memoryBytes_{0};
};

}  // namespace vox
