#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <unordered_set>

namespace vox {

/// Gives names that differ: a name that was given before gets a number.
class UniqueNames {
 public:
  std::string given(const std::string& wanted) {
    std::string name = wanted;
    for (std::uint64_t& number = counts_[wanted]; !taken_.insert(name).second;)
      name = wanted + " " + std::to_string(++number + 1);
    return name;
  }

 private:
  std::unordered_set<std::string> taken_;
  std::unordered_map<std::string, std::uint64_t> counts_;  // of repetitions
};

}  // namespace vox
