#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace vox {

/// 128-bit content hash (XXH3). It names content; it is no protection against forgery.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;

  void add(std::span<const char> bytes);

  /// Adds the length of a file, then its content. With the lengths, "ab" + "c" and "a" + "bc" have
  /// different hashes.
  void addFile(std::string_view content);

  /// 32 lower-case hexadecimal digits.
  std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vox
