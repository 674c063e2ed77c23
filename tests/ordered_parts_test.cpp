#include "libvox/io/ordered_parts.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"

#include <catch2/catch.hpp>

#include <atomic>
#include <sstream>
#include <string>

using namespace vox;

namespace {

/// Parts of very different sizes; some are empty.
std::string textOfPart(std::size_t i) {
  return std::string(i * i * 31 % 5000, static_cast<char>('a' + i % 26));
}

void appendPart(const std::string& text, PartBytes& to) {
  to.sputn(text.data(), static_cast<std::streamsize>(text.size()));
}

/// A buffer that takes some bytes and then throws.
class FillingBuffer : public std::stringbuf {
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    if (str().size() > 100000) throw IoError("full");
    return std::stringbuf::xsputn(bytes, count);
  }
};

}  // namespace

TEST_CASE("parts are written in order, each once, by any number of threads", "[io][parallel]") {
  const std::size_t count = GENERATE(0, 1, 2, 1000);
  const int threads = GENERATE(1, 2, 8);
  std::string expected;
  for (std::size_t i = 0; i < count; ++i) expected += textOfPart(i);
  std::ostringstream stream;
  onThreads(threads, [&] {
    writeInOrder(stream, count,
                 [](std::size_t i, PartBytes& to) { appendPart(textOfPart(i), to); });
  });
  CHECK(stream.str() == expected);
}

TEST_CASE("a part that cannot be made ends the writing", "[io][error]") {
  const int threads = GENERATE(1, 2, 8);
  std::ostringstream stream;
  const auto make = [](std::size_t i, PartBytes& to) {
    if (i == 500) throw MeshError("part 500");
    appendPart(textOfPart(i), to);
  };
  CHECK_THROWS_AS(onThreads(threads, [&] { writeInOrder(stream, 1000, make); }), MeshError);
  std::string before;
  for (std::size_t i = 0; i < 500; ++i) before += textOfPart(i);
  CHECK(before.compare(0, stream.str().size(), stream.str()) == 0);
}

TEST_CASE("a stream that throws ends the writing, and few parts are made in vain",
          "[io][error][parallel]") {
  const int threads = GENERATE(1, 2, 8);
  FillingBuffer full;
  std::ostream stream(&full);
  stream.exceptions(std::ios::badbit);
  std::atomic<std::size_t> made = 0;
  const auto make = [&](std::size_t i, PartBytes& to) {
    ++made;
    appendPart(textOfPart(i), to);
  };
  CHECK_THROWS_AS(onThreads(threads, [&] { writeInOrder(stream, 100000, make); }), IoError);
  CHECK(made < 1000);
}
