#pragma once

#include "libvox/core/types.h"

#include <cstdint>
#include <vector>

namespace vox {

/// Disjoint sets of faces, with one bit per face: whether it is wound against the root of its set.
/// At first each face is a set of its own. Union-find by size; each call costs O(log F).
class WindingForest {
 public:
  explicit WindingForest(Index faceCount);

  struct Place {
    Index root;
    bool against;  ///< wound against the root
  };
  Place find(Index f) const;

  /// Whether f and g are in one set whose bits contradict `against`.
  /// @param against  whether f is wound against g: both run through their common edge in the same
  ///   direction
  bool contradicts(Index f, Index g, bool against) const;

  /// Joins the sets of f and g; does nothing if they are one set.
  /// @param against  as in contradicts
  void unite(Index f, Index g, bool against);

 private:
  std::vector<Index> parent_;
  std::vector<Index> size_;
  std::vector<std::uint8_t> against_;
};

}  // namespace vox
