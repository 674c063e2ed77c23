#include "apps/vox/sequence.h"

#include "libvox/core/error.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

using namespace vox;
using app::Frame;
using app::framesOf;

namespace {

std::string textOf(const std::vector<Frame>& frames) {
  std::string text;
  for (const Frame& frame : frames)
    text += frame.input.substr(frame.input.find_last_of('/') + 1) + ">" + frame.output + " ";
  return text;
}

}  // namespace

TEST_CASE("one input is one conversion, whatever the names", "[sequence]") {
  CHECK(textOf(framesOf({"a.obj"}, "a.vdb")) == "a.obj>a.vdb ");
  CHECK(textOf(framesOf({"a.obj"}, "a.#.vdb")) == "a.obj>a.#.vdb ");
  CHECK(textOf(framesOf({"100%.obj"}, "")) == "100%.obj> ");
  const test::TemporaryFolder folder;
  const std::string literal = folder.write("a.#.obj", "").string();
  folder.write("a.1.obj", "");
  CHECK(textOf(framesOf({literal}, "b.vdb")) == "a.#.obj>b.vdb ");
}

TEST_CASE("several inputs are numbered from 1 as they stand", "[sequence]") {
  CHECK(textOf(framesOf({"b.obj", "a.obj", "b.obj"}, "o_%03d.vdb")) ==
        "b.obj>o_001.vdb a.obj>o_002.vdb b.obj>o_003.vdb ");
  CHECK(textOf(framesOf({"b.obj", "a.obj"}, "")) == "b.obj> a.obj> ");
  CHECK_THROWS_AS(framesOf({"a.obj", "b.obj"}, "o.vdb"), UsageError);
  CHECK_THROWS_AS(framesOf({"a.obj", "b.obj"}, "-"), UsageError);
  CHECK_THROWS_AS(framesOf({"a.obj", "b.obj"}, "o#.#.vdb"), UsageError);
  CHECK_THROWS_AS(framesOf({"a.obj", "b.obj"}, "##/o.vdb"), UsageError);
}

TEST_CASE("a pattern matches files, ordered by number", "[sequence]") {
  const test::TemporaryFolder folder;
  for (const char* name : {"m.0010.obj", "m.0002.obj", "m.10000.obj", "m.002.obj", "m.00003.obj",
                           "m.0004.ply", "m.000x.obj", "xm.0001.obj", "m.-001.obj", "m..obj"})
    folder.write(name, "");
  const auto in = [&](const std::string& name) { return (folder / name).string(); };
  const std::string expected = "m.0002.obj>o2.vdb m.0010.obj>o10.vdb m.10000.obj>o10000.vdb ";
  CHECK(textOf(framesOf({in("m.####.obj")}, "o#.vdb")) == expected);
  CHECK(textOf(framesOf({in("m.%04d.obj")}, "o%d.vdb")) == expected);
  CHECK(textOf(framesOf({in("m.##.obj")}, "o.####.vdb")) == "m.10000.obj>o.10000.vdb ");
  CHECK_THROWS_AS(framesOf({in("n.####.obj")}, "o#.vdb"), InputError);
  CHECK_THROWS_AS(framesOf({in("none/n.####.obj")}, "o#.vdb"), InputError);
  CHECK_THROWS_AS(framesOf({in("m.####.obj")}, "o.vdb"), UsageError);
  CHECK_THROWS_AS(framesOf({in("m.##.##.obj")}, "o#.vdb"), UsageError);
}
