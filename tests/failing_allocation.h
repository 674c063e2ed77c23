#pragma once

#include <cstddef>

namespace vox::test {

/// Makes one allocation by `new` in this thread fail, as long as the object lives: number `n`, from
/// 0, of the allocations of at least `bytes`.
class FailingAllocation {
 public:
  FailingAllocation(int n, std::size_t bytes);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;

  /// Whether the allocation has failed.
  bool failed() const;

  /// False in builds with a sanitizer, which has its own allocator: no allocation fails there.
  static bool possible();
};

}  // namespace vox::test
