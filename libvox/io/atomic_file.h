#pragma once

#include <filesystem>
#include <fstream>
#include <memory>

namespace vox {

/// Checks, before the work starts, that a file can be written: its folder exists and is writable,
/// and the target is not a folder or device and, unless `overwrite`, does not exist.
/// @throws IoError  one of these fails; the message says which
void requireWritable(const std::filesystem::path& target, bool overwrite);

/// The path at the end of a chain of symbolic links, whether a file exists there or not. A path
/// that is no link is returned unchanged.
/// @throws IoError  the links cannot be followed
std::filesystem::path targetOfLinks(std::filesystem::path target);

/// A file that appears under its name only when it is complete. Bytes go to a partial file
/// ".vox-RANDOM.part" in the folder of the target (for a symbolic link: of the file that the link
/// leads to). commit() syncs the partial file, gives it the permissions of the file that it
/// replaces, and renames it. Without commit() the destructor removes the partial file and leaves
/// the target unchanged. Several objects may exist at a time.
class AtomicFile {
 public:
  /// @throws IoError  as requireWritable, or the partial file cannot be made
  AtomicFile(const std::filesystem::path& target, bool overwrite);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Stream of the partial file: readable, writable, seekable, binary.
  std::fstream& stream() { return stream_; }

  /// Makes the file appear under its name.
  /// @throws IoError  a write, the sync or the rename failed, on a full disk for example
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path partial_;
  std::unique_ptr<char[]> buffer_;  // outlives the stream
  std::fstream stream_;
};

/// Removes the partial files of this process. Safe in signal handlers. No AtomicFile may be used
/// afterwards.
void removePartialFiles() noexcept;

}  // namespace vox
