#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <memory>
#include <span>
#include <streambuf>

namespace vox {

/// Growing bytes, at the end of which streams and callers write. clear() keeps the memory: to get
/// fresh pages of memory costs more than to write to them.
class PartBytes : public std::streambuf {
 public:
  void clear() { size_ = 0; }
  std::span<const char> bytes() const { return {bytes_.get(), size_}; }
  /// Appends `count` bytes that the caller must fill in before the next call.
  char* extend(std::size_t count);

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override;
  int_type overflow(int_type byte) override;

 private:
  std::unique_ptr<char[]> bytes_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

/// Writes parts of a stream in order, while all threads of the caller's arena make them. At any
/// time it holds at most two parts for each thread, and 64 in all. An exception of `make` or of the
/// stream ends the work; the stream then has some of the parts.
///
/// @param count  number of parts
/// @param make   called once for every part in [0, count), on any thread; appends its bytes to
/// `to`;
///   it must not wait for other tasks, such as parallel loops
void writeInOrder(std::ostream& stream, std::size_t count,
                  const std::function<void(std::size_t part, PartBytes& to)>& make);

}  // namespace vox
