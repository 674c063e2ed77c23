#pragma once

#include "libvox/core/progress.h"

#include <chrono>

namespace vox::app {

struct CommonOptions;

/// A line on stderr that shows how far a run has come; only on a terminal, without --quiet, and
/// only if the run takes longer than a moment. Every update replaces the line; the end erases it.
/// With --progress, instead, a line of its own for each percent, wherever stderr goes.
class ProgressBar {
 public:
  explicit ProgressBar(const CommonOptions& options);
  ~ProgressBar() { erase(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Callback for the progress of the run; empty if nobody sees it.
  Progress::Callback callback();
  void erase();

 private:
  void draw(double fraction, const char* stage);
  void print(double fraction, const char* stage);

  bool isBar_;
  bool isLines_;
  int printedPercent_ = -1;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace vox::app
