#pragma once

#include "libvox/core/types.h"

#include <span>
#include <vector>

namespace vox {

/// Cuts a cyclic list of vertices into loops wherever it returns to a vertex.
class LoopCutter {
 public:
  explicit LoopCutter(Index pointCount) : place_(pointCount, kNone) {}

  /// Calls visit(loop) for each loop of a face. The vertices of a loop are distinct. A loop of one
  /// corner comes from a repeat (v v), a loop of two from a spike (a b a). Cost linear in the face.
  template <class Visit>
  void cut(std::span<const Index> face, Visit&& visit) {
    for (const Index v : face) {
      if (place_[v] != kNone) {
        visit(std::span<const Index>(path_).subspan(place_[v]));
        shorten(place_[v]);
      }
      place_[v] = static_cast<Index>(path_.size());
      path_.push_back(v);
    }
    visit(std::span<const Index>(path_));
    shorten(0);
  }

 private:
  void shorten(std::size_t size) {
    for (std::size_t k = size; k < path_.size(); ++k) place_[path_[k]] = kNone;
    path_.resize(size);
  }

  std::vector<Index> path_;
  std::vector<Index> place_;  // index of each vertex in path_, or kNone
};

}  // namespace vox
