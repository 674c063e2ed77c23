#pragma once

#include "libvox/core/error.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <vector>

namespace vox {

/// The run was stopped by Progress::cancel.
class Cancelled : public Error {
 public:
  static constexpr int kExitCode = 130;
  Cancelled() : Error("interrupted") {}
  int exitCode() const noexcept override { return kExitCode; }
};

/// Progress of a run, and the means to cancel it.
///
/// A run is a sequence of stages, each a share of the whole. One thread plans the work and begins
/// the stages; tasks on any thread credit parts of the current stage (done). Long work calls
/// check() often enough to stop within about a tenth of a second after cancel().
class Progress {
 public:
  /// Receives the fraction of all work that is done, 0 .. 1 and never falling, and the name of the
  /// stage. Called when a stage of a new name begins, when the run finishes, and otherwise at most
  /// once per interval. The calls come from any thread of the run, but never two at a time.
  using Callback = std::function<void(double fraction, const char* stage)>;

  /// @param interval  least time between two calls of the callback
  explicit Progress(Callback callback = {},
                    std::chrono::nanoseconds interval = std::chrono::milliseconds(50));
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Makes every later check() throw. Safe in any thread and in signal handlers.
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }
  /// @throws Cancelled  cancel() was called
  void check() const {
    if (cancelled()) throw Cancelled();
  }

  /// Whether there is a callback. Without one, work needed only for done() can be left out.
  bool watched() const { return callback_ != nullptr; }

  /// Adds to the planned work of the run, in any unit. Estimates are good enough.
  void plan(double work);

  /// Ends the current stage and begins the next one.
  /// @param stage  its name: a string literal, one or two words
  /// @param work   its share of the planned work, in the unit of plan
  /// @throws Cancelled  cancel() was called
  void begin(const char* stage, double work);
  /// Begins the last stage: its share is all planned work that no stage has had.
  void beginLast(const char* stage);

  /// Credits a part of the current stage; the parts of a stage add up to 1. Thread-safe. A call
  /// costs tens of nanoseconds, so a part should stand for microseconds of work or more.
  void done(double part);

  /// Ends the run: reports 1.
  /// @throws Cancelled  cancel() was called
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  void report();

  Callback callback_;
  std::chrono::nanoseconds interval_;
  std::atomic<bool> cancelled_{false};
  static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers set it");

  std::atomic<double> part_{0};            // of the current stage
  std::atomic<Clock::rep> nextReport_{0};  // earliest time of it, since the epoch of the clock
  std::mutex mutex_;                       // guards the members below and the callback
  const char* stage_ = "";
  double planned_ = 0;
  double before_ = 0;               // work of all earlier stages
  double work_ = 0;                 // of the current stage
  double reported_ = 0;             // fraction
  std::vector<const char*> known_;  // names of the stages so far
};

}  // namespace vox
