#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace vox {

/// 128-bit content hash (XXH3), for naming content, not for security.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;

  void add(std::span<const char> bytes);

  /// 32 lower-case hexadecimal digits.
  std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Hash of the contents of some files, one after the other.
/// @throws InputError  a file cannot be read
std::string hashOfFiles(std::span<const std::filesystem::path> files);

}  // namespace vox
