// Input files in memory, with a message for each reason why a file cannot be read.

#include "libvox/io/input_file.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

namespace vox {

namespace fs = std::filesystem;

namespace {

/// A file that is open for reading, if its descriptor is not negative.
class OpenFile {
 public:
  explicit OpenFile(const char* file) : descriptor_(::open(file, O_RDONLY | O_CLOEXEC)) {}
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  int descriptor() const { return descriptor_; }

  /// Reads `size` bytes from a place of the file on; false if it cannot. Any thread may call it.
  bool read(char* bytes, std::uint64_t from, std::size_t size) const {
    while (size > 0) {
      const ssize_t count = ::pread(descriptor_, bytes, size, static_cast<off_t>(from));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      bytes += count;
      from += static_cast<std::uint64_t>(count);
      size -= static_cast<std::size_t>(count);
    }
    return true;
  }

 private:
  int descriptor_;
};

}  // namespace

void requireInputFile(const fs::path& file) {
  const std::string name = file.string();
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found)
    throw InputError(name + ": no such file; check the path");
  if (error) throw InputError(name + ": cannot be read: " + error.message());
  if (fs::is_directory(status)) throw InputError(name + ": is a directory; name a file inside it");
  if (!fs::is_regular_file(status))
    throw InputError(name + ": is not a regular file; copy its content to a file first");
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) throw InputError(name + ": cannot be read: " + error.message());
  if (size == 0) throw InputError(name + ": the file is empty");
}

FileContent::FileContent(const fs::path& file, std::size_t size)
    : size_(size), bytes_(std::make_unique_for_overwrite<char[]>(size)) {
  const OpenFile in(file.c_str());
  if (in.descriptor() < 0)
    throw InputError(file.string() + ": cannot be opened; check its permissions");
  constexpr std::size_t kBlock = std::size_t{1} << 21;
  std::atomic<bool> whole{true};
  parallelForRanges(size, kBlock, [&](std::size_t begin, std::size_t end) {
    if (!in.read(bytes_.get() + begin, begin, end - begin)) whole = false;
  });
  if (!whole) throw InputError(file.string() + ": could be read only in part");
}

FileContent contentsOf(const fs::path& file) {
  requireInputFile(file);
  const std::string name = file.string();
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) throw InputError(name + ": cannot be read: " + error.message());
  if (size > availableMemory())
    throw LimitError(name + ": " + formatBytes(size) + " do not fit into memory");
  return {file, size};
}

bool haveSameBytes(const fs::path& a, std::uint64_t fromA, const fs::path& b, std::uint64_t fromB,
                   std::uint64_t size) {
  const OpenFile fileA(a.c_str());
  const OpenFile fileB(b.c_str());
  for (const auto& [file, path] : {std::pair(&fileA, &a), std::pair(&fileB, &b)})
    if (file->descriptor() < 0)
      throw InputError(path->string() + ": cannot be opened; check its permissions");
  constexpr std::uint64_t kBlock = std::uint64_t{1} << 18;
  const std::uint64_t count = (size + kBlock - 1) / kBlock;
  std::atomic<bool> whole{true};
  const std::uint64_t firstOther = lowestWhere(count, 1, [&](std::uint64_t i) {
    const auto bytes = static_cast<std::size_t>(std::min(kBlock, size - i * kBlock));
    std::vector<char> blockA(bytes);
    std::vector<char> blockB(bytes);
    if (!fileA.read(blockA.data(), fromA + i * kBlock, bytes) ||
        !fileB.read(blockB.data(), fromB + i * kBlock, bytes))
      whole = false;
    return !whole || blockA != blockB;
  });
  if (!whole) throw InputError(a.string() + " or " + b.string() + ": could be read only in part");
  return firstOther == count;
}

std::string lowerExtension(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');  // the same in every locale
  return extension;
}

}  // namespace vox
