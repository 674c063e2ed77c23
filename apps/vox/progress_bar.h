#pragma once

#include "libvox/core/progress.h"

#include <chrono>

namespace vox::app {

/// One line on stderr that shows how far a run has come, drawn over itself; only on a terminal, and
/// only when the run takes longer than a moment. Erased in the end.
class ProgressBar {
 public:
  explicit ProgressBar(bool wanted);
  ~ProgressBar() { erase(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// What the progress of the run is to call; nothing, when there is no terminal.
  Progress::Callback callback();
  void erase();

 private:
  void draw(double fraction, const char* stage);

  bool wanted_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace vox::app
