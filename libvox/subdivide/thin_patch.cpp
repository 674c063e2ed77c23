// Thin patches: which rows of a patch are enough.

#include "libvox/subdivide/thin_patch.h"

#include "libvox/mesh/patch_parts.h"
#include "libvox/subdivide/patch_steps.h"
#include "libvox/subdivide/patch_strips.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vox {
namespace {

/// Cost of a vertex of a row, in vertices of a patch.
constexpr std::int64_t kCostOfRows = 4;

/// Adds the rows that are needed between rows i and j. False if there would be more than `most`
/// rows in all.
bool addBetween(const PatchStrips& strips, std::int64_t i, std::int64_t j, std::int64_t most,
                std::vector<std::int64_t>& rows) {
  if (static_cast<std::int64_t>(rows.size()) > most) return false;
  if (j - i == 1 || strips.fillable(i, j)) return true;
  const std::int64_t middle = i + (j - i) / 2;
  if (!addBetween(strips, i, middle, most - 1, rows)) return false;
  rows.push_back(middle);
  return addBetween(strips, middle, j, most, rows);
}

/// Sets the rows to keep, in ascending order. False if they are more than `most`.
bool setRows(const Patch& patch, int levels, std::int64_t most, std::vector<std::int64_t>& rows) {
  const std::int64_t n = std::int64_t{1} << levels;
  rows.assign(1, 0);
  if (!addBetween(PatchStrips(patch, levels), 0, n - 1, most - 1, rows)) return false;
  rows.push_back(n - 1);
  return true;
}

/// Shortest distance between the ends of a row of control points.
double shortestRow(const Patch& patch) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& row : patch.points) shortest = std::min(shortest, (row[2] - row[0]).norm());
  return shortest;
}

/// A number for the extent of a patch from its first row to its last. It changes its sign if the
/// patch is turned by half a turn. Even for symmetric patches the number for the columns is
/// another one.
double extentAcross(const Patch& patch) {
  const Vec3d direction(1, 0.7548776662466927, 0.5698402909980532);  // unlikely in any mesh
  const auto& p = patch.points;
  return direction.dot((p[2][1] - p[0][1]) + 0.3 * (p[2][2] - p[0][0]) + 0.1 * (p[2][0] - p[0][2]));
}

/// The patch turned so that few rows are enough: the rows run along the axis on which the shortest
/// row is longer. The result is the same for all four turns of a patch.
Patch turnedForRows(const Patch& patch) {
  const Patch turned = quarterTurn(patch);
  constexpr double kMuch = 1.001;
  const double here = shortestRow(patch);
  const double there = shortestRow(turned);
  const bool alike = here <= kMuch * there && there <= kMuch * here;
  const bool turn =
      alike ? std::abs(extentAcross(patch)) > std::abs(extentAcross(turned)) : there > here;
  const Patch& chosen = turn ? turned : patch;
  return extentAcross(chosen) < 0 ? halfTurn(chosen) : chosen;
}

/// Approximate width of the surface of the descendants: its area, a quarter of each face, divided
/// by its length, half of the middle row.
double meanWidth(const Patch& patch) {
  const auto& p = patch.points;
  double area = 0;
  for (std::size_t u = 0; u < 2; ++u)
    for (std::size_t v = 0; v < 2; ++v)
      area += (p[u + 1][v + 1] - p[u][v]).cross(p[u][v + 1] - p[u + 1][v]).norm() / 2;
  return area / 4 / ((p[1][2] - p[1][0]).norm() / 2);
}

/// Emits the rows as curves; the columns are rows of the patch turned by a quarter.
void emitThin(const ThinPatch& thin, int level, SurfaceSink& sink) {
  const int k = thin.levels;
  const std::int64_t n = std::int64_t{1} << k;
  for (const std::int64_t i : thin.rows) sink.curve(rowOf(thin.patch, {i, n}), k, level + k);
  const Patch across = quarterTurn(thin.patch);
  for (const std::int64_t j : {std::int64_t{0}, n - 1})
    sink.curve(rowOf(across, {j, n}), k, level + k);
}

}  // namespace

std::optional<ThinPatch> thinPatch(const Patch& patch, int levels) {
  constexpr int kLeastLevels = 4;  // with fewer vertices it is not worth it
  constexpr int kDeepestRows = 30;
  if (levels < kLeastLevels || levels > kDeepestRows || patch.quadrants != kAllQuadrants)
    return std::nullopt;
  ThinPatch thin{turnedForRows(patch), levels, {}};
  std::int64_t limit = (std::int64_t{1} << (2 * levels)) / kCostOfRows;
  constexpr double kWidestStrip = 0.6;  // voxels; the rest is for the step along the rows
  const auto mostStrips = static_cast<double>((limit >> levels) - ThinPatch::kColumns - 1);
  if (!(meanWidth(thin.patch) <= kWidestStrip * mostStrips)) return std::nullopt;

  const double step = std::ldexp(PatchSteps(thin.patch).v.maxCoeff(), -levels);
  std::optional<ThinPatch> best;
  for (; thin.levels <= levels + 1; ++thin.levels) {
    const std::int64_t n = std::int64_t{1} << thin.levels;
    if (!setRows(thin.patch, thin.levels, limit / n - ThinPatch::kColumns, thin.rows)) continue;
    // With one more level, steps along rows are smaller, and rows may be farther apart. That saves
    // vertices if the steps are long.
    constexpr double kLongStep = 2.0 / 3;
    if (step < kLongStep) return thin;
    best = thin;
    limit = thin.vertices() - 1;
  }
  return best;
}

std::optional<std::array<PatchPart, 4>> cheaperChildren(const ThinPatch& thin) {
  constexpr std::size_t kManyRows = 8;
  if (thin.rows.size() <= kManyRows) return std::nullopt;
  const auto [first, second] = childrenOf(thin.patch);
  std::array children = {PatchPart(first[0]), PatchPart(first[1]), PatchPart(second[0]),
                         PatchPart(second[1])};
  double vertices = 0;
  for (const PatchPart& child : children)
    vertices += child.thin ? static_cast<double>(child.thin->vertices())
                           : std::ldexp(1.0, 2 * child.levels) / static_cast<double>(kCostOfRows);
  constexpr double kFarFewer = 0.75;
  if (vertices > kFarFewer * static_cast<double>(thin.vertices())) return std::nullopt;
  return children;
}

void emitRegular(const PatchPart& whole, int level, SurfaceSink& sink) {
  forEachPatchPart(
      whole, level,
      [&](const ThinPatch& thin, int levelOfPart) { emitThin(thin, levelOfPart, sink); },
      [&](const Patch& part, int levels, int levelOfPart) {
        if (levels == 0)
          sink.points({&part.points[1][1], 1}, levelOfPart);
        else
          sink.patch(part, levels, levelOfPart + levels);
      });
}

}  // namespace vox
