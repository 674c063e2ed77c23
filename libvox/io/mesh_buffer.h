#pragma once

#include "libvox/core/error.h"

#include <cstddef>
#include <ostream>
#include <string>

namespace vox {

/// The text or bytes of a mesh file, sent to a stream in large pieces.
class MeshBuffer {
 public:
  explicit MeshBuffer(std::ostream& out) : out_(out) { bytes_.reserve(kPiece + kItem); }

  /// What is appended here is written later.
  std::string& bytes() { return bytes_; }

  /// Call it after each item.
  /// @throws IoError  the stream fails
  void endItem() {
    if (bytes_.size() >= kPiece) send();
  }

  /// @throws IoError  the stream fails
  void finish() {
    send();
    if (!out_.flush()) fail();
  }

 private:
  static constexpr std::size_t kPiece = std::size_t{1} << 20U;
  static constexpr std::size_t kItem = 64;

  void send() {
    if (!out_.write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()))) fail();
    bytes_.clear();
  }
  [[noreturn]] static void fail() {
    throw IoError("the mesh could not be written; check the free space and permissions");
  }

  std::ostream& out_;
  std::string bytes_;
};

}  // namespace vox
