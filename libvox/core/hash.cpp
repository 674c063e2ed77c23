// Content hashes, by xxHash.

#include "libvox/core/hash.h"

#include "libvox/core/error.h"

#define XXH_INLINE_ALL
#include <array>
#include <fstream>
#include <vector>
#include <xxhash.h>

namespace vox {

struct ContentHash::State {
  XXH3_state_t xxh;
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->xxh);
}
ContentHash::~ContentHash() = default;

void ContentHash::add(std::span<const char> bytes) {
  XXH3_128bits_update(&state_->xxh, bytes.data(), bytes.size());
}

std::string ContentHash::hex() const {
  XXH128_canonical_t bytes;
  XXH128_canonicalFromHash(&bytes, XXH3_128bits_digest(&state_->xxh));
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes.digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

std::string hashOfFiles(std::span<const std::filesystem::path> files) {
  ContentHash hash;
  std::vector<char> buffer(1 << 20);
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    while (in.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || in.gcount() > 0)
      hash.add({buffer.data(), static_cast<std::size_t>(in.gcount())});
    if (!in.eof()) throw InputError(file.string() + ": cannot be read");
  }
  return hash.hex();
}

}  // namespace vox
