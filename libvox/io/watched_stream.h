#pragma once

#include "libvox/core/progress.h"

#include <cstdint>
#include <iostream>
#include <streambuf>

namespace vox {

/// Another stream, with what is written to it credited to the current stage of a progress, and the
/// way to stop it: a write throws Cancelled. A write that fails throws IoError.
class WatchedStream : public std::iostream {
 public:
  /// @param inner          where everything goes; must outlive this
  /// @param expectedBytes  that will be written in all, roughly
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
