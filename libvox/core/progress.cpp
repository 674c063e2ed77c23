// Progress as the sum of the work of earlier stages and of the credited part of the current one.

#include "libvox/core/progress.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace vox {

Progress::Progress(Callback callback, std::chrono::nanoseconds interval)
    : callback_(std::move(callback)), interval_(interval) {}

void Progress::plan(double work) {
  const std::scoped_lock lock(mutex_);
  planned_ += work;
}

void Progress::begin(const char* stage, double work) {
  check();
  const std::scoped_lock lock(mutex_);
  before_ += work_;
  work_ = work;
  part_ = 0;
  stage_ = stage;
  const auto same = [&](std::string_view other) { return other == stage; };
  const bool isNew = std::none_of(known_.begin(), known_.end(), same);
  if (isNew) known_.push_back(stage);
  if (isNew || Clock::now().time_since_epoch().count() >= nextReport_) report();
}

void Progress::beginLast(const char* stage) {
  begin(stage, std::max(0.0, planned_ - before_ - work_));
}

void Progress::done(double part) {
  if (!watched()) return;
  part_.fetch_add(part, std::memory_order_relaxed);
  if (Clock::now().time_since_epoch().count() < nextReport_.load(std::memory_order_relaxed)) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (lock && Clock::now().time_since_epoch().count() >= nextReport_) report();
}

void Progress::finish() {
  check();
  const std::scoped_lock lock(mutex_);
  before_ = planned_ = 1;
  work_ = 0;
  report();
}

/// Calls the callback. The caller holds mutex_.
void Progress::report() {
  if (!watched()) return;
  const double all = before_ + work_ * std::min(1.0, part_.load(std::memory_order_relaxed));
  if (planned_ > 0) reported_ = std::clamp(all / planned_, reported_, 1.0);
  callback_(reported_, stage_);
  nextReport_ = (Clock::now() + interval_).time_since_epoch().count();
}

}  // namespace vox
