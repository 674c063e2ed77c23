// Faces within arrays and between rows, in pieces.

#include "libvox/subdivide/polygon_sink.h"

#include <algorithm>
#include <vector>

namespace vox {

void PolygonSink::tiles(const ArrayTiles& tiles) {
  for (std::int64_t tile = 0; tile < tiles.count(); ++tile) tiles.emit(tile, *this);
}

void ArrayTiles::emit(std::int64_t tile, PolygonSink& sink) const {
  const std::int64_t beginU = tile / tilesV() * kSide;
  const std::int64_t beginV = tile % tilesV() * kSide;
  const std::int64_t endU = std::min(beginU + kSide + 1, array_->sizeU());
  const auto width =
      static_cast<std::size_t>(std::min(beginV + kSide + 1, array_->sizeV()) - beginV);
  PolygonPieces pieces(sink);
  std::vector<Vec3d> row(width);
  for (std::int64_t i = beginU; i < endU; ++i) {
    array_->alongV(i, beginV, row);
    const Index here = pieces.addPoints(row);
    if (i == beginU) continue;
    const Index before = here - static_cast<Index>(width);
    for (Index j = 0; j + 1 < width; ++j)
      pieces.addFace({before + j, here + j, here + j + 1, before + j + 1});
  }
  pieces.flush();
}

Index PolygonPieces::addPoints(std::span<const Vec3d> points) {
  const Index first = piece_.pointCount();
  piece_.points.insert(piece_.points.end(), points.begin(), points.end());
  return first;
}

void PolygonPieces::addPolygon(std::span<const Vec3d> points) {
  const Index first = addPoints(points);
  for (Index i = 0; i < points.size(); ++i) piece_.faceVertices.push_back(first + i);
  piece_.faceOffsets.push_back(piece_.cornerCount());
  breathe();
}

void PolygonPieces::flush() {
  if (piece_.faceCount() > 0) sink_.polygons(piece_);
  piece_.points.clear();
  piece_.faceVertices.clear();
  piece_.faceOffsets.assign(1, 0);
}

void stitch(const SideRow& a, const SideRow& b, PolygonPieces& pieces) {
  constexpr std::int64_t kEdges = 1024;  // of the row with more points
  const int log2More = std::max(a.log2Size, b.log2Size);
  const int downA = log2More - a.log2Size;
  const int downB = log2More - b.log2Size;
  std::vector<Vec3d> points;
  const auto add = [&](const SideRow& side, std::int64_t first, std::int64_t last) {
    points.resize(static_cast<std::size_t>(last - first + 1));
    side.set(first, points);
    return pieces.addPoints(points);
  };
  const std::int64_t edges = (std::int64_t{1} << log2More) - 1;
  for (std::int64_t begin = 0; begin < edges; begin += kEdges) {
    const std::int64_t end = std::min(begin + kEdges, edges);
    const Index firstA = add(a, begin >> downA, end >> downA);
    const Index firstB = add(b, begin >> downB, end >> downB);
    for (std::int64_t j = begin; j < end; ++j) {
      const auto inA = [&](std::int64_t i) {
        return firstA + static_cast<Index>((i >> downA) - (begin >> downA));
      };
      const auto inB = [&](std::int64_t i) {
        return firstB + static_cast<Index>((i >> downB) - (begin >> downB));
      };
      if (inA(j) == inA(j + 1))
        pieces.addFace({inA(j), inB(j), inB(j + 1)});
      else if (inB(j) == inB(j + 1))
        pieces.addFace({inA(j), inB(j), inA(j + 1)});
      else
        pieces.addFace({inA(j), inB(j), inB(j + 1), inA(j + 1)});
    }
    pieces.breathe();
  }
}

}  // namespace vox
