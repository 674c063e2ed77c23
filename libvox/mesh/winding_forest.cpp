// Union by size keeps paths short without path compression, so that find is const.

#include "libvox/mesh/winding_forest.h"

#include "libvox/core/numbered.h"

#include <utility>

namespace vox {

WindingForest::WindingForest(Index faceCount)
    : parent_(numbered(faceCount)), size_(faceCount, 1), against_(faceCount, 0) {}

WindingForest::Place WindingForest::find(Index f) const {
  bool against = false;
  for (; parent_[f] != f; f = parent_[f]) against ^= against_[f] != 0;
  return {f, against};
}

bool WindingForest::contradicts(Index f, Index g, bool against) const {
  const Place a = find(f);
  const Place b = find(g);
  return a.root == b.root && (a.against != b.against) != against;
}

void WindingForest::unite(Index f, Index g, bool against) {
  Place a = find(f);
  Place b = find(g);
  if (a.root == b.root) return;
  if (size_[a.root] < size_[b.root]) std::swap(a, b);
  parent_[b.root] = a.root;
  size_[a.root] += size_[b.root];
  against_[b.root] = a.against ^ b.against ^ against;
}

}  // namespace vox
