#pragma once

#include "libvox/core/progress.h"

namespace vox::app {

/// A signal that asks to stop (SIGINT, SIGTERM, SIGHUP) ends the process with exit code 130 and
/// leaves no partial file, unless the caller of the program chose to ignore it.
void handleSignals();

/// As long as this object lives, the first such signal cancels the run instead. Only one object at
/// a time.
class CancelOnSignal {
 public:
  explicit CancelOnSignal(Progress& run);
  ~CancelOnSignal();
  CancelOnSignal(const CancelOnSignal&) = delete;
  CancelOnSignal& operator=(const CancelOnSignal&) = delete;
};

}  // namespace vox::app
