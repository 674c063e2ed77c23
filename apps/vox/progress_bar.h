#pragma once

#include "libvox/core/progress.h"

#include <chrono>

namespace vox::app {

/// A line on stderr that shows how far a run has come; only on a terminal, and only if the run
/// takes longer than a moment. Every update replaces the line; the end erases it.
class ProgressBar {
 public:
  explicit ProgressBar(bool wanted);
  ~ProgressBar() { erase(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Callback for the progress of the run; empty if there is no terminal.
  Progress::Callback callback();
  void erase();

 private:
  void draw(double fraction, const char* stage);

  bool wanted_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace vox::app
