#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace vox {

/// Checks that a path is a regular file with content, without opening it: opening a FIFO would
/// block.
/// @throws InputError  it is missing, a directory, a device, or empty
void requireInputFile(const std::filesystem::path& file);

/// The content of a file, in memory. It is a copy: if another program changes or cuts the file, it
/// stays as it was read.
class FileContent {
 public:
  /// Reads `size` bytes, in parallel.
  /// @throws InputError  they cannot be read
  FileContent(const std::filesystem::path& file, std::size_t size);

  operator std::string_view() const {  // NOLINT(google-explicit-constructor)
    return {bytes_.get(), size_};
  }

 private:
  std::size_t size_;
  std::unique_ptr<char[]> bytes_;
};

/// The whole content of a file.
/// @throws InputError  as requireInputFile, or it cannot be read
/// @throws LimitError  it is larger than the available memory
FileContent contentsOf(const std::filesystem::path& file);

/// Whether `size` bytes of two files, from these places on, are the same. Reads in parallel, and
/// stops soon after a difference.
/// @throws InputError  they cannot be read
bool haveSameBytes(const std::filesystem::path& a, std::uint64_t fromA,
                   const std::filesystem::path& b, std::uint64_t fromB, std::uint64_t size);

/// Extension with its dot, in lower case, such as ".obj".
std::string lowerExtension(const std::filesystem::path& file);

}  // namespace vox
