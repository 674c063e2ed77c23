#include "libvox/mesh/stop_rule.h"

#include <catch2/catch.hpp>

using namespace vox;

TEST_CASE("a stop rule has the name it is found by", "[mesh]") {
  for (const std::string name : {"voxel", "levels=0", "levels=7", "levels=30"}) {
    const auto rule = stopRuleNamed(name);
    REQUIRE(rule.has_value());
    CHECK(stopRuleName(*rule) == name);
  }
  CHECK_FALSE(stopRuleNamed("voxel")->levels.has_value());
  CHECK(stopRuleNamed("levels=7")->levels == 7);
}

TEST_CASE("what is no stop rule is refused", "[mesh][error]") {
  for (const std::string name : {"", "voxels", "levels", "levels=", "levels=-1", "levels=31",
                                 "levels=1.5", "levels=3x", "levels= 3", "levels=99999999999"}) {
    CAPTURE(name);
    CHECK_FALSE(stopRuleNamed(name).has_value());
  }
}
