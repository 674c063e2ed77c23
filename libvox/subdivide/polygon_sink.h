#pragma once

#include "libvox/mesh/polygon_mesh.h"
#include "libvox/subdivide/vertex_array.h"

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <utility>

namespace vox {

class PolygonSink;

/// The faces within the array of a vertex that became many: tiles that can be made in any order,
/// by any thread.
class ArrayTiles {
 public:
  explicit ArrayTiles(std::shared_ptr<const VertexArray> array) : array_(std::move(array)) {}

  std::int64_t count() const { return tilesU() * tilesV(); }
  double vertices() const {
    return static_cast<double>(array_->sizeU()) * static_cast<double>(array_->sizeV());
  }
  void emit(std::int64_t tile, PolygonSink& sink) const;

 private:
  static constexpr std::int64_t kSide = 128;  ///< faces along a side of a tile
  std::int64_t tilesU() const { return (array_->sizeU() + kSide - 1) / kSide; }
  std::int64_t tilesV() const { return (array_->sizeV() + kSide - 1) / kSide; }

  std::shared_ptr<const VertexArray> array_;
};

/// Receives the polygons of a refined surface, in pieces.
class PolygonSink {
 public:
  virtual ~PolygonSink() = default;
  /// Some polygons, counter-clockwise from outside, with the points they use: at most some ten
  /// thousand, but for a single polygon of more corners. Where pieces meet, their points have the
  /// same bits. Valid during the call. (Whatever more a point is to have, such as a normal, goes
  /// beside the points.)
  virtual void polygons(const PolygonMesh& piece) = 0;
  /// The faces within a large array; by default its tiles follow one another.
  virtual void tiles(const ArrayTiles& tiles);
};

/// Collects faces into pieces.
class PolygonPieces {
 public:
  explicit PolygonPieces(PolygonSink& sink) : sink_(sink) {}

  /// Faces of points that come next: numbers count from the first of them.
  Index addPoints(std::span<const Vec3d> points);
  void addFace(std::initializer_list<Index> corners) {
    piece_.addFace({corners.begin(), corners.size()});
  }
  /// One face of its own points.
  void addPolygon(std::span<const Vec3d> points);
  /// Between pieces of work that share no points: passes on what has become much.
  void breathe() {
    if (piece_.points.size() >= kPoints) flush();
  }
  void flush();

 private:
  static constexpr std::size_t kPoints = 4096;

  PolygonSink& sink_;
  PolygonMesh piece_;
};

/// A row of 2^size points along the side of a vertex, or along a boundary.
struct SideRow {
  int log2Size = 0;
  std::function<void(std::int64_t first, std::span<Vec3d> points)> points;
};

/// Faces between two rows that face each other. Seen from outside, with both running upwards, A
/// lies on the left. Every edge of the row with fewer points gets as many of the other: a quad
/// across, and a fan at each of its points.
void stitch(const SideRow& a, const SideRow& b, PolygonPieces& pieces);

}  // namespace vox
