// A partial file beside the target, synced and then renamed.

#include "libvox/io/atomic_file.h"

#include "libvox/core/error.h"

#include <sys/stat.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <fcntl.h>
#include <random>
#include <string>
#include <unistd.h>

namespace vox {
namespace {

namespace fs = std::filesystem;

/// Name of a partial file, kept for signal handlers as plain bytes; valid in state kUsed. A file
/// that finds no free slot is removed by its destructor only.
struct Slot {
  enum State { kFree, kFilling, kUsed };
  std::atomic<int> state{kFree};
  std::array<char, PATH_MAX> name{};
};
std::array<Slot, 16> slots;

void registerPartial(const fs::path& partial) {
  for (Slot& slot : slots) {
    int expected = Slot::kFree;
    if (!slot.state.compare_exchange_strong(expected, Slot::kFilling)) continue;
    std::strncpy(slot.name.data(), partial.c_str(), slot.name.size() - 1);
    slot.state = Slot::kUsed;
    return;
  }
}

void unregisterPartial(const fs::path& partial) {
  for (Slot& slot : slots)
    if (slot.state == Slot::kUsed && partial == slot.name.data()) slot.state = Slot::kFree;
}

std::string reason() {
  return std::strerror(errno);
}

fs::path folderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// Makes a new file with a random name.
fs::path createPartial(const fs::path& folder) {
  constexpr int kTries = 100;
  std::random_device random;
  for (int i = 0; i < kTries; ++i) {
    const fs::path partial = folder / (".vox-" + std::to_string(random()) + ".part");
    const int file = ::open(partial.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
    if (file >= 0) {
      ::close(file);
      return partial;
    }
    if (errno != EEXIST) throw IoError(folder.string() + ": cannot be written: " + reason());
  }
  throw IoError(folder.string() + ": no free name for a partial file");
}

void syncFile(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synced = file >= 0 && (::fsync(file) == 0 || errno == EINVAL);
  const std::string why = reason();
  if (file >= 0) ::close(file);
  if (!synced) throw IoError(path.string() + ": cannot be synced to disk: " + why);
}

/// Makes the rename durable. A folder without read permission cannot be synced; that is no error.
void syncFolder(const fs::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  ::fsync(file);
  ::close(file);
}

void keepPermissions(const fs::path& from, const fs::path& to) {
  struct stat status {};
  if (::stat(from.c_str(), &status) == 0) ::chmod(to.c_str(), status.st_mode & 07777);
}

}  // namespace

fs::path targetOfLinks(fs::path target) {
  constexpr int kMostLinks = 40;
  std::error_code error;
  for (int links = 0; fs::is_symlink(target, error); ++links) {
    if (links == kMostLinks) throw IoError(target.string() + ": too many symbolic links");
    const fs::path next = fs::read_symlink(target, error);
    if (error) throw IoError(target.string() + ": cannot be followed: " + error.message());
    target = next.is_absolute() ? next : folderOf(target) / next;
  }
  return target;
}

void requireWritable(const fs::path& target, bool overwrite) {
  if (target.empty()) throw IoError("the output file has no name");
  std::error_code error;
  const fs::path real = targetOfLinks(target);
  const fs::path folder = folderOf(real);
  if (!fs::is_directory(folder, error))
    throw IoError(target.string() + ": the folder " + folder.string() + " does not exist");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw IoError(target.string() + ": the folder " + folder.string() +
                  " cannot be written: " + reason());
  if (!real.has_filename()) throw IoError(target.string() + ": names a folder, not a file");
  if (!fs::exists(real, error)) return;
  if (!fs::is_regular_file(real, error))
    throw IoError(target.string() + ": exists and is not a regular file; use -o - for stdout");
  if (!overwrite) throw IoError(target.string() + ": exists; use --force to overwrite it");
}

AtomicFile::AtomicFile(const fs::path& target, bool overwrite) {
  requireWritable(target, overwrite);
  target_ = targetOfLinks(target);
  partial_ = createPartial(folderOf(target_));
  registerPartial(partial_);
  constexpr std::size_t kBufferBytes = 1 << 20;
  buffer_ = std::make_unique<char[]>(kBufferBytes);
  stream_.rdbuf()->pubsetbuf(buffer_.get(), kBufferBytes);  // before it is opened
  stream_.open(partial_, std::ios::in | std::ios::out | std::ios::binary);
  if (stream_) return;
  const std::string why = reason();
  ::unlink(partial_.c_str());
  unregisterPartial(partial_);
  throw IoError(target.string() + ": cannot be written: " + why);
}

AtomicFile::~AtomicFile() {
  if (partial_.empty()) return;
  ::unlink(partial_.c_str());
  unregisterPartial(partial_);
}

void AtomicFile::commit() {
  stream_.close();
  if (!stream_) throw IoError(target_.string() + ": cannot be written: " + reason());
  syncFile(partial_);
  keepPermissions(target_, partial_);
  if (::rename(partial_.c_str(), target_.c_str()) != 0)
    throw IoError(target_.string() + ": cannot be renamed into place: " + reason());
  unregisterPartial(partial_);
  partial_.clear();
  syncFolder(folderOf(target_));
}

void removePartialFiles() noexcept {
  for (const Slot& slot : slots)
    if (slot.state == Slot::kUsed) ::unlink(slot.name.data());
}

}  // namespace vox
