#include "apps/vox/suggest.h"

#include <catch2/catch.hpp>

using vox::app::nearest;

TEST_CASE("a mistyped word is answered with the nearest one", "[app]") {
  const std::vector<std::string> options = {"--dim", "--voxel-size", "--grids", "--force"};
  CHECK(nearest("--dims", options) == "--dim");
  CHECK(nearest("--voxelsize", options) == "--voxel-size");
  CHECK(nearest("--grid", options) == "--grids");
  CHECK(nearest("--forced", options) == "--force");
}

TEST_CASE("no word is suggested if none is similar", "[app]") {
  CHECK(nearest("--temperature", {"--dim", "--grids"}).empty());
  CHECK(nearest("", {}).empty());
}
