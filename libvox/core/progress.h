#pragma once

#include "libvox/core/error.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <vector>

namespace vox {

/// The work was stopped because somebody asked for it.
class Cancelled : public Error {
 public:
  static constexpr int kExitCode = 130;
  Cancelled() : Error("interrupted") {}
  int exitCode() const noexcept override { return kExitCode; }
};

/// How far a run has come, and the way to stop it.
///
/// A run is a sequence of stages, each a share of the whole. One thread plans and begins them; the
/// tasks within a stage say what they have done. Work asks check() often enough to stop within
/// about a tenth of a second.
class Progress {
 public:
  /// Told the fraction of all work done, 0 .. 1, never less than before, and the stage: when a kind
  /// of stage begins for the first time, and else once per interval at most. From any thread of the
  /// run, but from one at a time.
  using Callback = std::function<void(double fraction, const char* stage)>;

  explicit Progress(Callback callback = {},
                    std::chrono::nanoseconds interval = std::chrono::milliseconds(50));
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Makes the next check() throw. From any thread, and from signal handlers.
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }
  /// @throws Cancelled  cancel() was called
  void check() const {
    if (cancelled()) throw Cancelled();
  }

  /// Whether anybody looks: else what is only done for done() can be left out.
  bool watched() const { return callback_ != nullptr; }

  /// Adds to the work of the run, in any unit; estimates will do.
  void plan(double work);

  /// Ends the stage before and begins the next, which is so much of what was planned.
  /// @param stage  a literal, one or two words
  /// @throws Cancelled
  void begin(const char* stage, double work);
  /// The same with all work that is left.
  void beginLast(const char* stage);

  /// Credits a part of the current stage; the parts add up to 1. Thread-safe. Costs tens of
  /// nanoseconds, so work is credited in pieces of microseconds.
  void done(double part);

  /// The end of the run: reports 1.
  /// @throws Cancelled
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  void report();

  Callback callback_;
  std::chrono::nanoseconds interval_;
  std::atomic<bool> cancelled_{false};
  static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers set it");

  std::atomic<double> part_{0};            // of the current stage
  std::atomic<Clock::rep> nextReport_{0};  // since the epoch of the clock
  std::mutex mutex_;                       // for what follows, and the callback
  const char* stage_ = "";
  double planned_ = 0;
  double before_ = 0;               // work of the stages before
  double work_ = 0;                 // of the current stage
  double reported_ = 0;             // fraction
  std::vector<const char*> known_;  // stages that have begun before
};

}  // namespace vox
