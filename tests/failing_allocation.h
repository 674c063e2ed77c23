#pragma once

#include <cstddef>

namespace vox::test {

/// While it lives, one allocation of this thread by `new` fails: number `n`, from 0, of those of at
/// least `bytes`.
class FailingAllocation {
 public:
  FailingAllocation(int n, std::size_t bytes);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;

  /// Whether it has.
  bool failed() const;

  /// False where a sanitizer checks allocations itself: then none fails.
  static bool possible();
};

}  // namespace vox::test
