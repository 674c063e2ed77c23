#pragma once

#include <cstdint>
#include <string>

namespace vox {

/// Bytes this process may still allocate: what the system reports as available, within the limits
/// of its control group (version 2) and address space.
std::uint64_t availableMemory();

/// The most memory this process has had in use so far: its peak resident set, in bytes.
std::uint64_t peakMemory();

/// "1.5 GiB".
std::string formatBytes(std::uint64_t bytes);

/// How much memory a run may use, and how much of it is taken. Numbers are estimates made before
/// the memory is allocated; the program itself (libraries, input text) comes on top.
class MemoryBudget {
 public:
  /// @param limit  bytes; 0: three quarters of what is available now
  explicit MemoryBudget(std::uint64_t limit);

  std::uint64_t limit() const { return limit_; }
  std::uint64_t left() const { return limit_ - taken_; }

  /// Takes bytes for as long as the budget lives.
  /// @throws LimitError  as require
  void take(std::uint64_t bytes, const std::string& what, const std::string& advice);

  /// Checks that bytes on top of what is taken fit.
  /// @throws LimitError  they do not: "WHAT needs about ... of memory, ...; ADVICE"
  void require(std::uint64_t bytes, const std::string& what, const std::string& advice) const;

 private:
  std::uint64_t limit_;
  std::uint64_t taken_ = 0;
};

}  // namespace vox
