#pragma once

#include "libvox/core/progress.h"

#include <cstdint>
#include <iostream>
#include <streambuf>

namespace vox {

/// A stream in front of a buffer. Bytes written are credited to the current stage of a Progress. A
/// write throws Cancelled if the run is cancelled, and IoError if the buffer fails.
class WatchedStream : public std::iostream {
 public:
  /// @param inner          receives all calls; must outlive this object
  /// @param expectedBytes  estimate of all bytes that will be written
  WatchedStream(std::streambuf& inner, Progress& progress, std::uint64_t expectedBytes);

 private:
  class Buffer : public std::streambuf {
   public:
    Buffer(std::streambuf& inner, Progress& progress, std::uint64_t expectedBytes);

   protected:
    std::streamsize xsputn(const char* bytes, std::streamsize count) override;
    int_type overflow(int_type byte) override;
    std::streamsize xsgetn(char* bytes, std::streamsize count) override;
    int_type underflow() override;
    int_type uflow() override;
    pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode which) override;
    pos_type seekpos(pos_type position, std::ios::openmode which) override;
    int sync() override;

   private:
    std::streambuf& inner_;
    Progress& progress_;
    double expectedBytes_;
    std::streamsize notCredited_ = 0;
  };

  Buffer buffer_;
};

}  // namespace vox
