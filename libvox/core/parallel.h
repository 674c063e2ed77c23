#pragma once

#include "libvox/core/error.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace vox {

/// Tells ThreadSanitizer the order that TBB guarantees around a parallel loop: the caller's earlier
/// work happens before every part of the loop, and every part, whether it returns or throws,
/// happens before the caller's later work. (Debian's TBB is built without the sanitizer, which
/// therefore does not see how a task reaches another thread.) An object lives as long as the loop.
/// Does nothing in builds without the sanitizer.
class LoopOrder {
 public:
  LoopOrder() { release(&begin_); }
  ~LoopOrder() { acquire(&end_); }
  LoopOrder(const LoopOrder&) = delete;
  LoopOrder& operator=(const LoopOrder&) = delete;

  /// One part of the loop. An object lives as long as the part.
  class Part {
   public:
    explicit Part(LoopOrder& order) : order_(order) { acquire(&order_.begin_); }
    ~Part() { release(&order_.end_); }
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;

   private:
    LoopOrder& order_;
  };

  /// Work that a part of the loop hands to TBB as a task. TBB copies the task and runs the copy on
  /// any thread; the run is a part of the loop.
  template <class Work>
  class Task {
   public:
    Task(LoopOrder& order, Work work) : order_(&order), work_(std::move(work)) {}
    Task(const Task& task) : order_(task.order_), work_(task.work_) { release(&tasks_); }
    ~Task() { acquire(&tasks_); }  // destruction, too, comes after the copying
    Task& operator=(const Task&) = delete;
    void operator()() const {
      acquire(&tasks_);  // first: even reading the copied members must come after the copying
      const Part part(*order_);
      work_();
    }

   private:
    LoopOrder* order_;
    Work work_;
  };
  template <class Work>
  Task<Work> task(Work work) {
    return {*this, std::move(work)};
  }

 private:
#ifdef __SANITIZE_THREAD__
  static void acquire(char* token) {
    __tsan_acquire(token);
  }
  static void release(char* token) {
    __tsan_release(token);
  }
#else
  static void acquire(char*) {}
  static void release(char*) {}
#endif
  char begin_ = 0;
  char end_ = 0;
  inline static char tasks_ = 0;
};

/// Calls body(begin, end), in parallel, for ranges that cover [0, count) once. Ranges have at least
/// grain / 2 elements (unless count is smaller), and more where fewer tasks are enough.
template <class Body>
void parallelForRanges(std::size_t count, std::size_t grain, Body&& body) {
  LoopOrder order;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
    const LoopOrder::Part part(order);
    body(range.begin(), range.end());
  });
}

/// Calls body(i), in parallel, for every i in [0, count). `grain` as in parallelForRanges.
template <class Integer, class Body>
void parallelForEach(Integer count, std::size_t grain, Body&& body) {
  parallelForRanges(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i != end; ++i) body(static_cast<Integer>(i));
  });
}

/// True if holds(i) for every i in [0, count). `grain` as in parallelForRanges.
template <class Integer, class Predicate>
bool parallelAllOf(Integer count, std::size_t grain, Predicate&& holds) {
  std::atomic<bool> all{true};
  parallelForRanges(count, grain, [&](std::size_t begin, std::size_t end) {
    for (; begin != end && all.load(std::memory_order_relaxed); ++begin)
      if (!holds(static_cast<Integer>(begin))) all.store(false, std::memory_order_relaxed);
  });
  return all;
}

/// Sorts a vector in parallel. The order must be total, so that the result does not depend on
/// threads.
template <class Element, class Less = std::less<Element>>
void parallelSort(std::vector<Element>& elements, Less less = {}) {
#ifdef __SANITIZE_THREAD__
  std::sort(elements.begin(), elements.end(), less);  // LoopOrder cannot reach into TBB's sort
#else
  tbb::parallel_sort(elements.begin(), elements.end(), less);
#endif
}

/// Calls work() on `threads` threads, or on all processors if 0, and returns its result. TBB needs
/// both settings: task_arena can raise the number of threads, global_control can lower it.
/// @throws UsageError  threads < 0
template <class Work>
auto onThreads(int threads, Work&& work) {
  if (threads < 0)
    throw UsageError("the number of threads must be 0 or more, not " + std::to_string(threads));
  if (threads == 0) return work();
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  LoopOrder order;
  return arena.execute([&] {
    const LoopOrder::Part part(order);
    return work();
  });
}

}  // namespace vox
