#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace vox {

/// 128-bit content hash (XXH3), for naming content, not for security.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;

  void add(std::span<const char> bytes);

  /// Adds the content of a file with its length, so that files cannot run into each other.
  void addFile(std::string_view content);

  /// 32 lower-case hexadecimal digits.
  std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vox
