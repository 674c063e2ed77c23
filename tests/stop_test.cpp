#include "libvox/subdivide/stop.h"

#include "libvox/voxelize/vertex_sink.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <random>

using namespace vox;

TEST_CASE("the diameter of a face is the longest side of its box", "[subdivide][golden]") {
  const std::vector<Vec3d> triangle = {{0, 0, 0}, {0.5, 0, -3}, {0.2, 0.9, 0}};
  CHECK(diameter(triangle) == 3);
  const std::vector<Vec3d> square = {{0, 0, 5}, {1, 0, 5}, {1, 1, 5}, {0, 1, 5}};
  CHECK(diameter(square) == 1);
  const std::vector<Vec3d> point = {{7, 7, 7}};
  CHECK(diameter(point) == 0);
}

TEST_CASE("at the depth of a patch all its faces fit, and one level higher need not",
          "[subdivide][property]") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> jitter(-0.4, 0.4);
  std::size_t needed = 0;
  for (int trial = 0; trial < 100; ++trial) {
    CAPTURE(trial);
    // A 5 x 5 net, so that all faces around descendants of the middle exist.
    PolygonMesh net;
    for (int u = 0; u < 5; ++u)
      for (int v = 0; v < 5; ++v)
        net.points.push_back((0.5 + trial / 10.0) *
                             Vec3d(u + jitter(random), v + jitter(random), jitter(random)));
    const auto at = [&](std::size_t u, std::size_t v) { return net.points[5 * u + v]; };
    Patch patch;
    for (std::size_t u = 0; u < 3; ++u)
      for (std::size_t v = 0; v < 3; ++v) patch.points[u][v] = at(u + 1, v + 1);
    const int k = patchDepth(patch);

    // Faces of the refined net that have a descendant of the middle vertex as a corner.
    const auto largestAt = [&](int depth) {
      std::vector<std::vector<Vec3d>> grid(5, std::vector<Vec3d>(5));
      for (std::size_t u = 0; u < 5; ++u)
        for (std::size_t v = 0; v < 5; ++v) grid[u][v] = at(u, v);
      const auto chaikin = [](std::vector<std::vector<Vec3d>> lines) {
        for (auto& line : lines) {
          std::vector<Vec3d> fine;
          for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            fine.push_back(0.75 * line[i] + 0.25 * line[i + 1]);
            fine.push_back(0.25 * line[i] + 0.75 * line[i + 1]);
          }
          line = fine;
        }
        return lines;
      };
      const auto transpose = [](const std::vector<std::vector<Vec3d>>& lines) {
        std::vector<std::vector<Vec3d>> out(lines[0].size(), std::vector<Vec3d>(lines.size()));
        for (std::size_t i = 0; i < lines.size(); ++i)
          for (std::size_t j = 0; j < lines[0].size(); ++j) out[j][i] = lines[i][j];
        return out;
      };
      std::size_t first = 2;  // of the middle's descendants
      std::size_t count = 1;
      for (int level = 0; level < depth; ++level) {
        grid = transpose(chaikin(transpose(chaikin(grid))));
        first = 2 * first - 1;
        count *= 2;
      }
      double largest = 0;
      for (std::size_t u = first - 1; u < first + count; ++u)
        for (std::size_t v = first - 1; v < first + count; ++v) {
          const std::vector<Vec3d> face = {grid[u][v], grid[u + 1][v], grid[u + 1][v + 1],
                                           grid[u][v + 1]};
          largest = std::max(largest, diameter(face));
        }
      return largest;
    };
    CHECK(largestAt(k) <= kVertexConversionSpan);
    if (k > 0) needed += largestAt(k - 1) > kVertexConversionSpan;
  }
  CHECK(needed > 50);  // the bound is not idle
}
