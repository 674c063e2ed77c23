#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace vox::bench {

/// What a measured process may use; 0: no limit.
struct Limits {
  double timeoutSeconds = 0;
  std::uint64_t memoryBytes = 0;  ///< of address space (RLIMIT_AS)
};

enum class Outcome {
  kOk,           ///< exit code 0
  kAbsent,       ///< there is no such program
  kFailed,       ///< another exit code, or a signal
  kTimedOut,     ///< killed at the limit
  kOutOfMemory,  ///< failed under a limit of memory and says that it is about memory
};

/// One process from start to end.
struct ProcessRun {
  Outcome outcome = Outcome::kFailed;
  int exitCode = 0;             ///< 128 + number of a signal
  double wallSeconds = 0;       ///< from before the start to after the end
  double cpuSeconds = 0;        ///< user + system, with waited-for children
  std::uint64_t peakBytes = 0;  ///< resident; at least what this process itself had at the start
  std::string output;           ///< standard output and error
};

/// SIGINT or SIGTERM arrived while a process ran.
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Runs a program (found as the shell finds it) to its end and measures it. Its input is empty, its
/// output goes to memory and nowhere else. At the timeout, on interruption, and when this process
/// dies, it is killed. One at a time.
/// @throws Interrupted         the process has been killed
/// @throws std::system_error   the system gives no process
ProcessRun runProcess(const std::vector<std::string>& command, const Limits& limits);

/// "ok", "absent", "failed (exit code 3: vox: error: ...)", "over the timeout", "over the limit of
/// memory (...)".
std::string describe(const ProcessRun& run);

}  // namespace vox::bench
