#pragma once

#include <filesystem>
#include <fstream>
#include <memory>

namespace vox {

/// Checks before the work starts that a file may be written: its folder exists and is writable, the
/// target is not a folder or device, and does not exist unless `overwrite`.
/// @throws IoError  says which of these fails
void requireWritable(const std::filesystem::path& target, bool overwrite);

/// The file that a chain of symbolic links stands for, whether it exists or not; any other path
/// itself.
/// @throws IoError  the links cannot be followed
std::filesystem::path targetOfLinks(std::filesystem::path target);

/// A file that appears under its name only when complete. Bytes go to a new file ".vox-RANDOM.part"
/// in the folder of the target (of what it points to, for a symbolic link); commit() syncs it,
/// gives it the permissions of the file it replaces and renames it. Without commit() the destructor
/// removes the partial file and the target is as it was. Several may be open at a time.
class AtomicFile {
 public:
  /// @throws IoError  see requireWritable; or the partial file cannot be made
  AtomicFile(const std::filesystem::path& target, bool overwrite);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Readable, writable, seekable, binary.
  std::fstream& stream() { return stream_; }

  /// @throws IoError  a write, the sync or the rename failed: full disk, for one
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path partial_;
  std::unique_ptr<char[]> buffer_;  // outlives the stream
  std::fstream stream_;
};

/// Removes the partial files of this process. Safe to call from a signal handler; the files must
/// not be used any more.
void removePartialFiles() noexcept;

}  // namespace vox
