#include "libvox/io/atomic_file.h"

#include "libvox/core/error.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>
#include <sys/stat.h>

using namespace vox;
using Catch::Contains;
using test::contentOf;

TEST_CASE("a file appears only when committed, with the usual permissions", "[io]") {
  const test::TemporaryFolder folder;
  {
    AtomicFile file(folder / "out", false);
    file.stream() << "content";
    CHECK_FALSE(std::filesystem::exists(folder / "out"));
    file.commit();
  }
  CHECK(contentOf(folder / "out") == "content");
  CHECK(folder.fileCount() == 1);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  struct stat status {};
  REQUIRE(::stat((folder / "out").c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == (0666 & ~mask));
}

TEST_CASE("without commit the old file stays and nothing else is left", "[io]") {
  const test::TemporaryFolder folder;
  folder.write("out", "old");
  {
    AtomicFile file(folder / "out", true);
    file.stream() << "half";
  }
  CHECK(contentOf(folder / "out") == "old");
  CHECK(folder.fileCount() == 1);
}

TEST_CASE("a signal handler can remove partial files", "[io]") {
  const test::TemporaryFolder folder;
  AtomicFile file(folder / "out", false);
  file.stream() << "half";
  CHECK(folder.fileCount() == 1);
  removePartialFiles();
  CHECK(folder.fileCount() == 0);
}

TEST_CASE("an existing file needs permission to be overwritten", "[io][error]") {
  const test::TemporaryFolder folder;
  folder.write("out", "old");
  CHECK_THROWS_WITH(requireWritable(folder / "out", false), Contains("--force"));
  AtomicFile file(folder / "out", true);
  file.stream() << "new";
  file.commit();
  CHECK(contentOf(folder / "out") == "new");
}

TEST_CASE("a symbolic link is written through", "[io]") {
  const test::TemporaryFolder folder;
  folder.write("real", "old");
  std::filesystem::create_symlink("real", folder / "link");
  AtomicFile file(folder / "link", true);
  file.stream() << "new";
  file.commit();
  CHECK(std::filesystem::is_symlink(folder / "link"));
  CHECK(contentOf(folder / "real") == "new");
}

TEST_CASE("targets that cannot be files are refused by name", "[io][error]") {
  const test::TemporaryFolder folder;
  CHECK_THROWS_WITH(requireWritable(folder / "none/out", false), Contains("does not exist"));
  CHECK_THROWS_WITH(requireWritable(folder.path(), true), Contains("not a regular file"));
  CHECK_THROWS_WITH(requireWritable("/dev/null", true), Contains("not a regular file"));
}

TEST_CASE("two files at a time do not disturb each other", "[io]") {
  const test::TemporaryFolder folder;
  AtomicFile second(folder / "b", false);
  {
    const AtomicFile first(folder / "a", false);
    CHECK(folder.fileCount() == 2);
  }
  second.stream() << "content";
  second.commit();
  CHECK(contentOf(folder / "b") == "content");
  CHECK(folder.fileCount() == 1);
}

TEST_CASE("a replaced file keeps its permissions", "[io]") {
  const test::TemporaryFolder folder;
  folder.write("out", "secret");
  std::filesystem::permissions(folder / "out", std::filesystem::perms(0600));
  AtomicFile file(folder / "out", true);
  file.commit();
  CHECK(std::filesystem::status(folder / "out").permissions() == std::filesystem::perms(0600));
}

TEST_CASE("a dangling link is written through, a loop of links is refused", "[io]") {
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("nowhere", folder / "link");
  AtomicFile file(folder / "link", false);
  file.stream() << "new";
  file.commit();
  CHECK(std::filesystem::is_symlink(folder / "link"));
  CHECK(contentOf(folder / "nowhere") == "new");
  std::filesystem::create_symlink("loop", folder / "loop");
  CHECK_THROWS_WITH(requireWritable(folder / "loop", true), Contains("too many symbolic links"));
}

TEST_CASE("a name as long as the file system allows works", "[io]") {
  const test::TemporaryFolder folder;
  const std::string name(255, 'n');
  AtomicFile file(folder / name, false);
  file.commit();
  CHECK(std::filesystem::exists(folder / name));
  CHECK_THROWS_WITH(requireWritable("", false), Contains("no name"));
}
