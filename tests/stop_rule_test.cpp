#include "libvox/options/stop_rule.h"

#include <catch2/catch.hpp>

using namespace vox;

TEST_CASE("a stop rule is found by its name", "[mesh]") {
  for (const std::string name : {"voxel", "levels=0", "levels=7", "levels=30", "diameter=2.5",
                                 "angle=180", "levels=3,diameter=4,angle=5,flatness=0.1"}) {
    const auto rule = stopRuleNamed(name);
    REQUIRE(rule.has_value());
    CHECK(stopRuleName(*rule) == name);
  }
  CHECK_FALSE(stopRuleNamed("voxel")->levels.has_value());
  CHECK(stopRuleNamed("levels=7")->levels == 7);
}

TEST_CASE("invalid stop rules are refused", "[mesh][error]") {
  for (const std::string name :
       {"", "voxels", "levels", "levels=", "levels=-1", "levels=31", "levels=1.5", "levels=3x",
        "levels= 3", "levels=99999999999", "diameter=0", "diameter=inf", "angle=nan", "angle=181",
        "flatness=", "levels=3,", ",levels=3", "depth=3"}) {
    CAPTURE(name);
    CHECK_FALSE(stopRuleNamed(name).has_value());
  }
}

TEST_CASE("of two limits of a kind, the one that is met first counts", "[mesh]") {
  CHECK(stopRuleNamed("levels=5,levels=3") == StopRule{3});
  CHECK(stopRuleNamed("diameter=2,diameter=4") == StopRule{{}, 4.0});
  CHECK(stopRuleNamed("voxel,levels=3") == StopRule{3, 1.0});
}
