// Memory that Linux still grants: /proc/meminfo, the control group, the limit of address space.

#include "libvox/core/memory.h"

#include "libvox/core/error.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <limits>
#include <unistd.h>

namespace vox {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// The first number after the word `key` in a file, or the first number of the file if `key` is
/// empty; `missing` if there is no such number.
std::uint64_t numberIn(const char* file, const std::string& key, std::uint64_t missing) {
  std::ifstream in(file);
  std::string word;
  while (!key.empty() && in >> word && word != key) {
  }
  std::uint64_t value = 0;
  return in >> value ? value : missing;
}

std::uint64_t systemMemory() {
  const std::uint64_t kibibytes = numberIn("/proc/meminfo", "MemAvailable:", 0);
  if (kibibytes > 0) return kibibytes * 1024;
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t controlGroupMemory() {
  const std::uint64_t limit = numberIn("/sys/fs/cgroup/memory.max", "", kUnlimited);
  if (limit == kUnlimited) return kUnlimited;
  const std::uint64_t used = numberIn("/sys/fs/cgroup/memory.current", "", 0);
  const std::uint64_t cache = numberIn("/sys/fs/cgroup/memory.stat", "file", 0);  // freed on demand
  return limit - std::min(limit, used - std::min(used, cache));
}

std::uint64_t addressSpace() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  const std::uint64_t used =
      numberIn("/proc/self/statm", "", 0) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, used);
}

}  // namespace

std::uint64_t availableMemory() {
  return std::min({systemMemory(), controlGroupMemory(), addressSpace()});
}

std::uint64_t peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::string formatBytes(std::uint64_t bytes) {
  constexpr std::array<const char*, 7> kUnits = {"B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1024 && unit + 1 < kUnits.size(); ++unit) value /= 1024;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), unit == 0 ? "%.0f %s" : "%.1f %s", value, kUnits[unit]);
  return text.data();
}

MemoryBudget::MemoryBudget(std::uint64_t limit)
    : limit_(limit != 0 ? limit : availableMemory() / 4 * 3) {}

void MemoryBudget::take(std::uint64_t bytes, const std::string& what, const std::string& advice) {
  require(bytes, what, advice);
  taken_ += bytes;
}

void MemoryBudget::require(std::uint64_t bytes, const std::string& what,
                           const std::string& advice) const {
  if (bytes <= left()) return;
  throw LimitError(what + " needs about " + formatBytes(bytes) + " of memory" +
                   (taken_ > 0 ? " on top of " + formatBytes(taken_) : "") + ", the limit is " +
                   formatBytes(limit_) + "; " + advice);
}

}  // namespace vox
