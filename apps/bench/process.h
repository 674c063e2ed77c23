#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace vox::bench {

/// Limits of a measured process; 0: no limit.
struct Limits {
  double timeoutSeconds = 0;
  std::uint64_t memoryBytes = 0;  ///< of address space (RLIMIT_AS)
};

enum class Outcome {
  kOk,           ///< exit code 0
  kAbsent,       ///< there is no such program
  kFailed,       ///< another exit code, or a signal
  kTimedOut,     ///< killed at the limit
  kOutOfMemory,  ///< failed under a memory limit, with a message about memory
};

/// Result and cost of one process.
struct ProcessRun {
  Outcome outcome = Outcome::kFailed;
  int exitCode = 0;             ///< 128 + number of a signal
  double wallSeconds = 0;       ///< from before the start to after the end
  double cpuSeconds = 0;        ///< user + system, with the children that it waited for
  std::uint64_t peakBytes = 0;  ///< resident; at least that of this process at the start
  std::string output;           ///< standard output and error
};

/// SIGINT or SIGTERM arrived while a process ran.
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Runs a program to its end and measures it. The program is found like in a shell; its input is
/// empty, and its output is only kept in memory. It is killed at the timeout, on interruption, and
/// if this process dies. Not thread-safe.
/// @throws Interrupted         SIGINT or SIGTERM arrived; the program has been killed
/// @throws std::system_error   the system could not start a process
ProcessRun runProcess(const std::vector<std::string>& command, const Limits& limits);

/// The outcome in words: "ok", "absent", "failed (exit code 3: vox: error: ...)", "over the
/// timeout", "over the limit of memory (...)".
std::string describe(const ProcessRun& run);

}  // namespace vox::bench
