#pragma once

#include <cstdint>
#include <string>

namespace vox {

/// Bytes that this process may still allocate: the smallest of the available memory of the system
/// and of what is left of the limits of the control group (version 2) and of the address space.
std::uint64_t availableMemory();

/// Peak resident set of this process so far, in bytes.
std::uint64_t peakMemory();

/// The number with a binary unit, as in "1.5 GiB".
std::string formatBytes(std::uint64_t bytes);

/// Account of the memory of a run: its limit, and how much of it is taken. The numbers are
/// estimates made before the memory is allocated. They leave out the program itself (libraries,
/// input text). Not thread-safe.
class MemoryBudget {
 public:
  /// @param limit  bytes; 0: three quarters of availableMemory()
  explicit MemoryBudget(std::uint64_t limit);

  std::uint64_t limit() const { return limit_; }
  std::uint64_t left() const { return limit_ - taken_; }

  /// Takes `bytes` for as long as this budget lives.
  /// @throws LimitError  as require
  void take(std::uint64_t bytes, const std::string& what, const std::string& advice);

  /// Checks that `bytes` more than what is taken are within the limit.
  /// @throws LimitError  they are not: "WHAT needs about ... of memory, ...; ADVICE"
  void require(std::uint64_t bytes, const std::string& what, const std::string& advice) const;

 private:
  std::uint64_t limit_;
  std::uint64_t taken_ = 0;
};

}  // namespace vox
