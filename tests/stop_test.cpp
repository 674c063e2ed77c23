#include "libvox/subdivide/stop.h"

#include "tests/reference.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

using namespace vox;

TEST_CASE("the span of a quad counts its edges and its better diagonal", "[subdivide][golden]") {
  const std::vector<Vec3d> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  CHECK(faceSpan(square) == 1);
  const std::vector<Vec3d> kite = {{0, 0, 0}, {1, 0.4, 0}, {2, 0, 0}, {1, -0.4, 0}};
  CHECK(faceSpan(kite) == 1);  // edges 1, diagonals 2 and 0.8
  const std::vector<Vec3d> diamond = {{-1, 0, 0}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}};
  CHECK(faceSpan(diamond) == 2);
}

TEST_CASE("the span of other faces is their L-inf diameter", "[subdivide][golden]") {
  const std::vector<Vec3d> triangle = {{0, 0, 0}, {0.5, 0, -3}, {0.2, 0.9, 0}};
  CHECK(faceSpan(triangle) == 3);
  const std::vector<Vec3d> pentagon = {
      {0, 0, 0}, {1, 0, 0}, {1.5, 1, 0}, {0.5, 2, 0}, {-0.5, 1, 0}};
  CHECK(faceSpan(pentagon) == 2);
}

TEST_CASE("the largest child span is that of the faces of the next level",
          "[subdivide][property]") {
  for (const auto& shape : test::shapes()) {
    CAPTURE(shape.name);
    SubdivisionLevel level = baseLevel(shape.mesh, BoundaryRule::kFree);
    for (int k = 0; k < 3; ++k) {
      const auto image = imageVertices(level);
      const double predicted = largestChildSpan(level, image);
      level = nextLevel(level, image);
      CHECK(predicted == test::naiveLargestSpan(level.mesh));
    }
  }
}
