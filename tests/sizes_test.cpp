#include "libvox/subdivide/sizes.h"

#include "libvox/subdivide/stop.h"
#include "libvox/subdivide/vertex_split.h"

#include <catch2/catch.hpp>
#include <hwy/targets.h>

#include <algorithm>
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

VertexSplit randomSplit(Points& points) {
  VertexSplit split;
  split.setF({points.next(), points.next(), points.next(), points.next()});
  split.setVFace({points.next(), points.next(), points.next(), points.next()});
  for (auto* quad : {&split.r, &split.l})
    for (Vec3d& p : *quad) p = points.next();
  return split;
}

/// PatchSteps in plain code: the largest steps along the four sides of each face that exists.
struct PlainSteps {
  Vec3d u = Vec3d::Zero();
  Vec3d v = Vec3d::Zero();
  explicit PlainSteps(const Patch& patch) {
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

template <class Check>
void onEveryInstructionSet(Check&& check) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    CAPTURE(hwy::TargetName(target));
    hwy::GetChosenTarget().Update(target);
    for (int trial = 0; trial < 200; ++trial) check(trial);
  }
  hwy::GetChosenTarget().DeInit();
}

}  // namespace

TEST_CASE("steps of a patch are the sides of its faces, bit for bit", "[subdivide][simd]") {
  Points points;
  onEveryInstructionSet([&](int trial) {
    Patch patch = randomPatch(points);
    patch.quadrants = static_cast<std::uint8_t>(1 + trial % 15);
    CAPTURE(patch.quadrants);
    const PatchSteps steps(patch);
    const PlainSteps plain(patch);
    CHECK(steps.u == plain.u);
    CHECK(steps.v == plain.v);
  });
}

TEST_CASE("sizes of children are those of the faces around them, bit for bit",
          "[subdivide][simd]") {
  Points points;
  onEveryInstructionSet([&](int) {
    const VertexSplit s = randomSplit(points);
    const ChildSizes sizes = childSizes(s);
    const double own = diameter(s.f0, s.r[0], s.vFace0, s.l[0]);
    CHECK(sizes.f == std::max({own, diameter(s.f0, s.fNext, s.r[1], s.r[0]),
                               diameter(s.f0, s.fPrevious, s.l[1], s.l[0])}));
    CHECK(sizes.vFace == std::max({own, diameter(s.vFace0, s.vFaceRight, s.r[3], s.r[0]),
                                   diameter(s.vFace0, s.vFaceLeft, s.l[3], s.l[0])}));
    CHECK(sizes.r == PatchSteps(s.childInR()).sizeBelow(0, 0));
    CHECK(sizes.l == PatchSteps(s.childInL()).sizeBelow(0, 0));
  });
}
