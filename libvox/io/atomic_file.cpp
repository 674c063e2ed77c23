// Write beside the target, sync, rename.

#include "libvox/io/atomic_file.h"

#include "libvox/core/error.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <unistd.h>

namespace vox {
namespace {

namespace fs = std::filesystem;

/// Name of the partial file for signal handlers: plain bytes, valid while the flag is set.
std::array<char, PATH_MAX> partialName{};
std::atomic<bool> partialExists{false};

std::string reason() {
  return std::strerror(errno);
}

fs::path folderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// The file a symbolic link stands for, so that the link survives the rename.
fs::path resolved(const fs::path& target) {
  std::error_code error;
  if (!fs::is_symlink(target, error)) return target;
  const fs::path real = fs::weakly_canonical(target, error);
  return error ? target : real;
}

void createEmpty(const fs::path& partial) {
  const int file = ::open(partial.c_str(), O_CREAT | O_TRUNC | O_RDWR | O_CLOEXEC, 0666);
  if (file < 0) throw IoError(partial.string() + ": cannot be created: " + reason());
  ::close(file);
}

void sync(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synced = file >= 0 && (::fsync(file) == 0 || errno == EINVAL);
  const std::string why = reason();
  if (file >= 0) ::close(file);
  if (!synced) throw IoError(path.string() + ": cannot be synced to disk: " + why);
}

}  // namespace

void requireWritable(const fs::path& target, bool overwrite) {
  std::error_code error;
  const fs::path folder = folderOf(resolved(target));
  if (!fs::is_directory(folder, error))
    throw IoError(target.string() + ": the folder " + folder.string() + " does not exist");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw IoError(target.string() + ": the folder " + folder.string() +
                  " cannot be written: " + reason());
  if (!fs::exists(target, error)) return;
  if (!fs::is_regular_file(target, error))
    throw IoError(target.string() + ": exists and is not a regular file; use -o - for stdout");
  if (!overwrite) throw IoError(target.string() + ": exists; use --force to overwrite it");
}

AtomicFile::AtomicFile(const fs::path& target, bool overwrite) : target_(resolved(target)) {
  requireWritable(target, overwrite);
  partial_ = target_;
  partial_ += "." + std::to_string(::getpid()) + ".part";
  if (partial_.native().size() + 1 > partialName.size())
    throw IoError(target.string() + ": the name is too long");
  createEmpty(partial_);
  std::memcpy(partialName.data(), partial_.c_str(), partial_.native().size() + 1);
  partialExists = true;
  stream_.open(partial_, std::ios::in | std::ios::out | std::ios::binary);
  if (!stream_) throw IoError(partial_.string() + ": cannot be opened: " + reason());
}

AtomicFile::~AtomicFile() {
  removePartialFile();
}

void AtomicFile::commit() {
  stream_.close();
  if (!stream_) throw IoError(target_.string() + ": cannot be written: " + reason());
  sync(partial_);
  if (::rename(partial_.c_str(), target_.c_str()) != 0)
    throw IoError(target_.string() + ": cannot be renamed into place: " + reason());
  partialExists = false;
  sync(folderOf(target_));
}

void removePartialFile() noexcept {
  if (partialExists.exchange(false)) ::unlink(partialName.data());
}

}  // namespace vox
