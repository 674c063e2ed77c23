#pragma once

#include "libvox/core/types.h"

#include <cstdint>
#include <vector>

namespace vox {

/// Sets of faces that hang together, each face knowing whether it is wound against the root of its
/// set: union-find by size with a bit. O(log F) for each call.
class WindingForest {
 public:
  explicit WindingForest(Index faceCount);

  struct Place {
    Index root;
    bool against;  ///< wound against the root
  };
  Place find(Index f) const;

  /// Whether f and g are of one set, and wound otherwise there than `against` says.
  bool contradicts(Index f, Index g, bool against) const;

  /// Joins the sets of f and g, if they are two. `against`: f and g run through their common edge
  /// in the same direction.
  void unite(Index f, Index g, bool against);

 private:
  std::vector<Index> parent_;
  std::vector<Index> size_;
  std::vector<std::uint8_t> against_;
};

}  // namespace vox
