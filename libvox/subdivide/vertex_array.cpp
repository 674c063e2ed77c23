// The descendants of a vertex as an array.

#include "libvox/subdivide/vertex_array.h"

#include <algorithm>

namespace vox {
namespace {

/// The patch with the directions of u and v reversed.
Patch turned(const Patch& patch) {
  Patch other;
  for (std::size_t u = 0; u < 3; ++u)
    for (std::size_t v = 0; v < 3; ++v) other.points[u][v] = patch.points[2 - u][2 - v];
  return other;
}

Patch pointPatch(const Vec3d& point) {
  Patch patch;
  for (auto& row : patch.points) row.fill(point);
  return patch;
}

}  // namespace

LevelOneVertex::LevelOneVertex() {
  const Vec3d unknown = Vec3d::Zero();
  for (auto& row : patch.points) row.fill(unknown);
  split.f0 = split.fNext = split.fPrevious = unknown;
  split.r.fill(unknown);
  split.l.fill(unknown);
}

void VertexArray::set(const LevelOneVertex& vertex, VertexDepth depth) {
  if (vertex.regular) return set(vertex.patch, depth);
  depth_ = depth;
  blocks_.clear();
  const int k = depth.u;
  if (k == 0) return addPoint(vertex.at, 0, 0);
  const std::int64_t half = std::int64_t{1} << (k - 1);
  add(vertex.split.childInR(), half, 0, k - 1);
  add(vertex.split.childInL(), 0, half, k - 1);
  if (vertex.quadF)
    add(vertex.split.childInF(), half, half, k - 1);
  else
    addInF(*vertex.levelsOfF, vertex.placeInF, half, half, k - 1);
  if (vertex.corner)
    addInCorner(*vertex.corner, k - 1);
  else if (vertex.quadVFace)
    add(vertex.split.childInVFace(), 0, 0, k - 1);
  else
    addInVFace(*vertex.levelsOfVFace, vertex.placeInVFace, k - 1);
}

void VertexArray::add(const Patch& patch, std::int64_t u, std::int64_t v, int k) {
  const auto log2 = static_cast<std::uint8_t>(k);
  blocks_.push_back({patch, u, v, {log2, log2}});
}

/// Adds a block of one irregular vertex.
void VertexArray::addPoint(const Vec3d& point, std::int64_t u, std::int64_t v) {
  add(pointPatch(point), u, v, 0);
}

/// Adds the blocks of a corner of an extraordinary F of level 2, from row u and column v on.
void VertexArray::addInF(ExtraordinaryLevels& levels, std::size_t place, std::int64_t u,
                         std::int64_t v, int k) {
  for (int l = 0;; ++l, --k) {
    if (k == 0) return addPoint(levels.level(l).face.inner[place], u, v);
    const std::int64_t half = std::int64_t{1} << (k - 1);
    const VertexSplit split = levels.split(l, place);
    add(split.childInR(), u + half, v, k - 1);
    add(split.childInL(), u, v + half, k - 1);
    add(split.childInVFace(), u, v, k - 1);
    u += half;
    v += half;
  }
}

/// Adds the blocks of a corner of an extraordinary V-face of level 2, from row and column 0 on. All
/// patches are turned by half a turn, because u and v fall towards the V-face.
void VertexArray::addInVFace(ExtraordinaryLevels& levels, std::size_t place, int k) {
  for (int l = 0;; ++l, --k) {
    if (k == 0) return addPoint(levels.level(l).face.inner[place], 0, 0);
    const std::int64_t half = std::int64_t{1} << (k - 1);
    const VertexSplit split = levels.split(l, place);
    add(turned(split.childInR()), 0, half, k - 1);
    add(turned(split.childInL()), half, 0, k - 1);
    add(turned(split.childInVFace()), half, half, k - 1);
  }
}

void VertexArray::addInCorner(BoundaryCorner corner, int k) {
  for (; k > 0; --k) {
    const std::int64_t half = std::int64_t{1} << (k - 1);
    const VertexSplit split = corner.split();
    add(split.childInR(), half, 0, k - 1);
    add(split.childInL(), 0, half, k - 1);
    add(split.childInF(), half, half, k - 1);
    corner = corner.below(split);
  }
  addPoint(corner.u, 0, 0);
}

void VertexArray::alongV(std::int64_t i, std::int64_t first, std::span<Vec3d> points) const {
  const auto end = first + static_cast<std::int64_t>(points.size());
  for (const Block& block : blocks_) {
    if (i < block.u || i >= block.endU()) continue;
    const std::int64_t from = std::max(first, block.v);
    const std::int64_t to = std::min(end, block.endV());
    if (from >= to) continue;
    const CurvePoints row = rowOf(block.patch, {i - block.u, block.endU() - block.u});
    for (std::int64_t j = from; j < to; ++j)
      points[static_cast<std::size_t>(j - first)] =
          PatchWeights(j - block.v, block.endV() - block.v)(row[0], row[1], row[2]);
  }
}

void VertexArray::alongU(std::int64_t j, std::int64_t first, std::span<Vec3d> points) const {
  const auto end = first + static_cast<std::int64_t>(points.size());
  for (const Block& block : blocks_) {
    if (j < block.v || j >= block.endV()) continue;
    const PatchWeights v(j - block.v, block.endV() - block.v);
    const std::int64_t to = std::min(end, block.endU());
    for (std::int64_t i = std::max(first, block.u); i < to; ++i) {
      const CurvePoints row = rowOf(block.patch, {i - block.u, block.endU() - block.u});
      points[static_cast<std::size_t>(i - first)] = v(row[0], row[1], row[2]);
    }
  }
}

}  // namespace vox
