#pragma once

#include "libvox/core/error.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <string>

namespace vox {

/// Runs work on `threads` threads, or on all processors if 0, and returns its result. The arena
/// raises the number, the control lowers it.
/// @throws UsageError  threads < 0
template <class Work>
auto onThreads(int threads, Work&& work) {
  if (threads < 0)
    throw UsageError("the number of threads must be 0 or more, not " + std::to_string(threads));
  if (threads == 0) return work();
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  return arena.execute(work);
}

}  // namespace vox
