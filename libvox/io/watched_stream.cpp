// A buffer that passes all calls on to another one, and counts the bytes written.

#include "libvox/io/watched_stream.h"

#include <algorithm>

namespace vox {

WatchedStream::WatchedStream(std::streambuf& inner, Progress& progress, std::uint64_t expectedBytes)
    : std::iostream(nullptr), buffer_(inner, progress, expectedBytes) {
  rdbuf(&buffer_);
  exceptions(std::ios::badbit);  // lets exceptions of the buffer through
}

WatchedStream::Buffer::Buffer(std::streambuf& inner, Progress& progress,
                              std::uint64_t expectedBytes)
    : inner_(inner),
      progress_(progress),
      expectedBytes_(static_cast<double>(std::max<std::uint64_t>(expectedBytes, 1))) {}

std::streamsize WatchedStream::Buffer::xsputn(const char* bytes, std::streamsize count) {
  constexpr std::streamsize kBytesPerCredit = 1 << 18;
  notCredited_ += count;
  if (notCredited_ >= kBytesPerCredit) {
    progress_.check();
    progress_.done(static_cast<double>(notCredited_) / expectedBytes_);
    notCredited_ = 0;
  }
  if (inner_.sputn(bytes, count) != count)
    throw IoError("the output cannot be written; is the disk full?");
  return count;
}

WatchedStream::Buffer::int_type WatchedStream::Buffer::overflow(int_type byte) {
  if (traits_type::eq_int_type(byte, traits_type::eof())) return traits_type::not_eof(byte);
  const char value = traits_type::to_char_type(byte);
  xsputn(&value, 1);
  return byte;
}

std::streamsize WatchedStream::Buffer::xsgetn(char* bytes, std::streamsize count) {
  return inner_.sgetn(bytes, count);
}

WatchedStream::Buffer::int_type WatchedStream::Buffer::underflow() {
  return inner_.sgetc();
}

WatchedStream::Buffer::int_type WatchedStream::Buffer::uflow() {
  return inner_.sbumpc();
}

WatchedStream::Buffer::pos_type WatchedStream::Buffer::seekoff(off_type offset,
                                                               std::ios::seekdir from,
                                                               std::ios::openmode which) {
  return inner_.pubseekoff(offset, from, which);
}

WatchedStream::Buffer::pos_type WatchedStream::Buffer::seekpos(pos_type position,
                                                               std::ios::openmode which) {
  return inner_.pubseekpos(position, which);
}

int WatchedStream::Buffer::sync() {
  if (inner_.pubsync() != 0) throw IoError("the output cannot be written; is the disk full?");
  return 0;
}

}  // namespace vox
