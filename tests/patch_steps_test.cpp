#include "libvox/subdivide/patch_steps.h"

#include <catch2/catch.hpp>

#include <random>

using namespace vox;

namespace {

class Points {
 public:
  Vec3d next() { return {place_(random_), place_(random_), place_(random_)}; }

 private:
  std::mt19937 random_{3};
  std::uniform_real_distribution<double> place_{-10, 10};
};

Patch randomPatch(Points& points) {
  Patch patch;
  for (auto& row : patch.points)
    for (Vec3d& p : row) p = points.next();
  return patch;
}

/// The largest steps along the four sides of each face that exists.
struct SidesOfFaces {
  Vec3d u = Vec3d::Zero();
  Vec3d v = Vec3d::Zero();
  explicit SidesOfFaces(const Patch& patch) {
    const auto& p = patch.points;
    for (unsigned a = 0; a < 2; ++a)
      for (unsigned b = 0; b < 2; ++b) {
        if ((patch.quadrants >> (2 * a + b) & 1U) == 0) continue;
        u = u.cwiseMax((p[a + 1][b] - p[a][b]).cwiseAbs());
        u = u.cwiseMax((p[a + 1][b + 1] - p[a][b + 1]).cwiseAbs());
        v = v.cwiseMax((p[a][b + 1] - p[a][b]).cwiseAbs());
        v = v.cwiseMax((p[a + 1][b + 1] - p[a + 1][b]).cwiseAbs());
      }
  }
};

}  // namespace

TEST_CASE("steps of a patch are the sides of its faces, bit for bit", "[subdivide]") {
  Points points;
  for (unsigned quadrants = 1; quadrants <= kAllQuadrants; ++quadrants) {
    Patch patch = randomPatch(points);
    patch.quadrants = static_cast<std::uint8_t>(quadrants);
    CAPTURE(quadrants);
    const PatchSteps steps(patch);
    const SidesOfFaces sides(patch);
    CHECK(steps.u == sides.u);
    CHECK(steps.v == sides.v);
  }
}
