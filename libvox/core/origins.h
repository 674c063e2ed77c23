#pragma once

#include "libvox/core/numbered.h"
#include "libvox/core/types.h"

#include <utility>
#include <vector>

namespace vox {

/// The elements of an input that the elements of a result come from. Takes no memory while each
/// element comes from the one with its own number.
class Origins {
 public:
  Origins() = default;
  /// Each of `count` elements comes from the one with its own number.
  explicit Origins(Index count) : count_(count) {}
  Origins(std::vector<Index> from)  // NOLINT(google-explicit-constructor): the same list
      : count_(static_cast<Index>(from.size())), from_(std::move(from)) {}

  Index size() const { return count_; }
  Index operator[](Index element) const { return from_.empty() ? element : from_[element]; }
  /// Whether it is known that each element comes from the one with its own number.
  bool areTheSame() const { return from_.empty(); }
  bool operator==(const Origins& other) const { return list() == other.list(); }

  /// Appends an element that comes from `origin`.
  void add(Index origin) {
    if (from_.empty()) from_ = numbered(count_);
    from_.push_back(origin);
    ++count_;
  }

  std::vector<Index> list() const { return from_.empty() ? numbered(count_) : from_; }

 private:
  Index count_ = 0;
  std::vector<Index> from_;  // empty: the same numbers
};

/// The origins of elements that were made in two steps; kNone for those that the first step did not
/// make.
inline Origins composed(const Origins& first, const Origins& second) {
  if (second.areTheSame() && second.size() == first.size()) return first;
  std::vector<Index> both(second.size(), kNone);
  for (Index i = 0; i < second.size(); ++i)
    if (second[i] < first.size()) both[i] = first[second[i]];
  return both;
}

}  // namespace vox
