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

/// The faces within a large array, as tiles. Tiles can be made in any order and by any thread.
class ArrayTiles {
 public:
  explicit ArrayTiles(std::shared_ptr<const VertexArray> array) : array_(std::move(array)) {}

  std::int64_t count() const { return tilesU() * tilesV(); }
  double vertices() const {
    return static_cast<double>(array_->sizeU()) * static_cast<double>(array_->sizeV());
  }
  /// Gives the faces of a tile to a sink.
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
  /// Receives some polygons, counter-clockwise from outside, with their points: at most some ten
  /// thousand, unless a single polygon has more. Where pieces meet, points have the same bits.
  /// @param piece  valid during the call
  virtual void polygons(const PolygonMesh& piece) = 0;
  /// Receives the faces within a large array. By default emits its tiles one after another.
  virtual void tiles(const ArrayTiles& tiles);
};

/// Collects points and faces into pieces for a sink.
class PolygonPieces {
 public:
  explicit PolygonPieces(PolygonSink& sink) : sink_(sink) {}

  /// Adds points.
  /// @return the number of the first one, for addFace; valid until breathe or flush
  Index addPoints(std::span<const Vec3d> points);
  void addFace(std::initializer_list<Index> corners) {
    piece_.addFace({corners.begin(), corners.size()});
  }
  /// Adds points and the one face that has them as its corners; then calls breathe.
  void addPolygon(std::span<const Vec3d> points);
  /// Sends the points and faces to the sink if they are many. To be called when no later face uses
  /// the points.
  void breathe() {
    if (piece_.points.size() >= kPoints) flush();
  }
  /// Sends all points and faces to the sink.
  void flush();

 private:
  static constexpr std::size_t kPoints = 4096;

  PolygonSink& sink_;
  PolygonMesh piece_;
};

/// A row of 2^log2Size points along the side of an array, or along a boundary.
struct SideRow {
  int log2Size = 0;
  /// Sets `points` to those from number `first` on.
  std::function<void(std::int64_t first, std::span<Vec3d> points)> set;
};

/// Adds the faces between two rows that face each other. Seen from outside, with both rows running
/// upwards, `a` lies on the left. If the sizes differ, the points of the shorter row are spread
/// evenly over the longer one: there is a quad at each edge of the shorter row and a fan of
/// triangles at each of its points.
void stitch(const SideRow& a, const SideRow& b, PolygonPieces& pieces);

}  // namespace vox
