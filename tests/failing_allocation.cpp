// Replaces the operators new and delete of the standard library.

#include "tests/failing_allocation.h"

#include <cstdlib>
#include <new>

namespace {

thread_local std::size_t leastBytes = 0;
thread_local int allocationsToGo = -1;  // before the one that fails; negative: none

}  // namespace

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
[[gnu::noinline]] void* operator new(std::size_t bytes) {
  if (allocationsToGo >= 0 && bytes >= leastBytes && allocationsToGo-- == 0) throw std::bad_alloc();
  void* const memory = std::malloc(bytes > 0 ? bytes : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}

[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
#endif

namespace vox::test {

FailingAllocation::FailingAllocation(int n, std::size_t bytes) {
  leastBytes = bytes;
  allocationsToGo = n;
}

FailingAllocation::~FailingAllocation() {
  allocationsToGo = -1;
}

bool FailingAllocation::failed() const {
  return allocationsToGo < 0;
}

bool FailingAllocation::possible() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;
#else
  return true;
#endif
}

}  // namespace vox::test
