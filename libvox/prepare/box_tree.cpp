// The tree is split where the middles of the boxes spread most.

#include "libvox/prepare/box_tree.h"

#include "libvox/core/numbered.h"

#include <algorithm>

namespace vox {

BoxTree::BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes)
    : items_(numbered(static_cast<Index>(boxes.size()))) {
  if (!items_.empty()) build(boxes, 0, items_.size());
}

void BoxTree::build(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t begin,
                    std::size_t end) {
  constexpr std::size_t kMostInLeaf = 8;
  const std::size_t n = nodes_.size();
  nodes_.push_back({{}, begin, end, 0});
  Eigen::AlignedBox3d around;
  Eigen::AlignedBox3d middles;
  const auto middleOf = [&](Index item) {
    return Vec3d(boxes[item].min() / 2 + boxes[item].max() / 2);
  };
  for (std::size_t k = begin; k < end; ++k) {
    around.extend(boxes[items_[k]]);
    middles.extend(middleOf(items_[k]));
  }
  nodes_[n].box = around;
  if (end - begin <= kMostInLeaf) return;
  Eigen::Index axis = 0;
  (middles.max() / 2 - middles.min() / 2).maxCoeff(&axis);
  const std::size_t half = begin + (end - begin) / 2;
  const auto at = [&](std::size_t k) { return items_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(begin), at(half), at(end), [&](Index a, Index b) {
    const double x = middleOf(a)[axis];
    const double y = middleOf(b)[axis];
    return x != y ? x < y : a < b;
  });
  build(boxes, begin, half);
  nodes_[n].second = nodes_.size();
  build(boxes, half, end);
}

}  // namespace vox
