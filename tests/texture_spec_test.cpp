#include "libvox/options/texture_spec.h"

#include "libvox/core/color.h"
#include "libvox/core/error.h"

#include <catch2/catch.hpp>

using namespace vox;
using Catch::Contains;

TEST_CASE("the text of a texture makes the same texture again", "[texture][property]") {
  const std::string text = GENERATE(
      "checker", "stripes:axis=x", "rings:turbulence=0.125", "marble:scale=0.2,seed=4294967295",
      "noise:octaves=16,space=world", "gradient:from=-1,to=2.5,axis=1:2:-3",
      "brick:mortar=0.3,scale=1e-3,colors=1:0:0/0:0.1:0/#ffffff", "gradient:colors=0:0:0/1:1:1");
  CAPTURE(text);
  const TextureSpec texture = parseTexture(text);
  CHECK(parseTexture(textureText(texture)) == texture);
}

TEST_CASE("every kind is in the list of names and has colours", "[texture]") {
  const std::string names = allTextureNames();
  CHECK(names == "checker, stripes, rings, marble, noise, gradient, brick, image");
  for (const auto* name : {"checker", "stripes", "rings", "marble", "noise", "gradient", "brick"})
    CHECK(textureNamed(name).colors.size() >= kLeastColors);
}

TEST_CASE("parameters get the given values", "[texture]") {
  const TextureSpec texture = parseTexture(
      "marble:scale=0.2,axis=y,turbulence=3,octaves=2,seed=7,space=world,colors=0:0:0/1:0.5:0.25");
  CHECK(texture.kind == TextureKind::kMarble);
  CHECK(texture.scale == 0.2);
  CHECK(texture.axis == Vec3d(0, 1, 0));
  CHECK(texture.turbulence == 3);
  CHECK(texture.octaves == 2);
  CHECK(texture.seed == 7);
  CHECK(texture.inWorld);
  REQUIRE(texture.colors.size() == 2);
  CHECK(texture.colors[1] == Vec3d(1, 0.5, 0.25));
}

TEST_CASE("screen colours become light", "[texture][golden]") {
  CHECK(linearFromScreen(0) == 0);
  CHECK(linearFromScreen(1) == 1);
  // The value 0.5 is about a fifth of the light. The two pieces of the curve meet at 0.04045.
  CHECK(linearFromScreen(0.5) == Approx(0.21404).epsilon(1e-4));
  CHECK(linearFromScreen(0.0404499) == Approx(linearFromScreen(0.0404501)).epsilon(1e-4));
  const TextureSpec texture = parseTexture("checker:colors=#ff0080/#000000");
  CHECK((texture.colors[0] - Vec3d(1, 0, linearFromScreen(128 / 255.0))).norm() == 0);
}

TEST_CASE("invalid texture parameters are refused by name", "[texture][error]") {
  const auto [text, message] = GENERATE(table<std::string, std::string>({
      {"wood", "unknown texture 'wood'; known are checker, stripes"},
      {"", "unknown texture ''"},
      {"checker:", "texture checker has no ''; it has scale, space, colors"},
      {"checker:axis=x", "texture checker has no 'axis'; it has scale, space, colors"},
      {"marble:scale", "texture marble: scale must be a number above 0, not ''"},
      {"marble:scale=0", "scale must be a number above 0, not '0'"},
      {"marble:scale=nan", "scale must be a number above 0"},
      {"marble:scale=inf", "scale must be a number above 0"},
      {"marble:scale=1x", "not '1x'"},
      {"marble:scale=1,scale=2", "says scale twice"},
      {"marble:turbulence=-1", "turbulence must be a number from 0 to 100"},
      {"noise:octaves=17", "octaves must be a whole number from 1 to 16"},
      {"noise:octaves=1.5", "octaves must be a whole number"},
      {"noise:seed=-1", "seed must be a whole number"},
      {"noise:seed=4294967296", "seed must be a whole number"},
      {"noise:space=here", "space must be object or world, not 'here'"},
      {"stripes:axis=w", "axis must be x, y, z or"},
      {"stripes:axis=0:0:0", "not all 0"},
      {"stripes:axis=1:2", "axis must be"},
      {"brick:mortar=2", "mortar must be a number from 0 to 1"},
      {"checker:colors=1:0:0", "colors must be 2 to 16 colours"},
      {"checker:colors=1:0:0/2:0:0", "colours R:G:B from 0 to 1, or #rrggbb, not '2'"},
      {"checker:colors=#12345/#ffffff", "not '#12345'"},
      {"checker:colors=#12345g/#ffffff", "not '#12345g'"},
  }));
  CAPTURE(text);
  CHECK_THROWS_AS(parseTexture(text), UsageError);
  CHECK_THROWS_WITH(parseTexture(text), Contains(message));
}
