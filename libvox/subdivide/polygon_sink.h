#pragma once

#include "libvox/mesh/polygon_mesh.h"
#include "libvox/subdivide/vertex_array.h"

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <utility>
#include <vector>

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
  /// Whether polygons() is to get normals.
  virtual bool wantsNormals() const { return false; }
  /// Receives some polygons, counter-clockwise from outside, with their points: at most some ten
  /// thousand, unless a single polygon has more. Where pieces meet, points and normals have the
  /// same bits.
  /// @param piece    valid during the call
  /// @param normals  one per point if wantsNormals(), else empty: of the smooth surface at the
  /// limit
  ///   point of the vertex; unit, outward, or 0 if there is none
  virtual void polygons(const PolygonMesh& piece, std::span<const Vec3d> normals) = 0;
  /// Receives the faces within a large array. By default emits its tiles one after another.
  virtual void tiles(const ArrayTiles& tiles);
};

/// A list of points, with or without normals.
struct PointRow {
  explicit PointRow(bool withNormals = false) : hasNormals(withNormals) {}

  bool hasNormals;
  std::vector<Vec3d> points;
  std::vector<Vec3d> normals;  ///< one per point, or empty

  void clear() { resize(0); }
  void resize(std::size_t size) {
    points.resize(size);
    if (hasNormals) normals.resize(size);
  }
  /// Another row of some size, with normals if this one has them.
  PointRow ofSize(std::size_t size) const {
    PointRow row(hasNormals);
    row.resize(size);
    return row;
  }
  /// Sets all points of the row to vertices of an array: (i, first), (i, first + 1), ...
  void setAlongV(const VertexArray& array, std::int64_t i, std::int64_t first) {
    array.alongV(i, first, points);
    if (hasNormals) array.normalsAlongV(i, first, normals);
  }
  /// Sets all points of the row to vertices of an array: (first, j), (first + 1, j), ...
  void setAlongU(const VertexArray& array, std::int64_t j, std::int64_t first) {
    array.alongU(j, first, points);
    if (hasNormals) array.normalsAlongU(j, first, normals);
  }
  /// Appends vertex (i, j) of an array.
  void add(const VertexArray& array, std::int64_t i, std::int64_t j) {
    points.push_back(array.at(i, j));
    if (hasNormals) normals.push_back(array.normalAt(i, j));
  }
  void add(const PointRow& row) {
    points.insert(points.end(), row.points.begin(), row.points.end());
    normals.insert(normals.end(), row.normals.begin(), row.normals.end());
  }
  void addCornerF(const VertexArray& array) { add(array, array.sizeU() - 1, array.sizeV() - 1); }
  void addCornerVFace(const VertexArray& array) { add(array, 0, 0); }
  void addCornerR(const VertexArray& array) { add(array, array.sizeU() - 1, 0); }
  void addCornerL(const VertexArray& array) { add(array, 0, array.sizeV() - 1); }
};

/// Collects points and faces into pieces for a sink.
class PolygonPieces {
 public:
  explicit PolygonPieces(PolygonSink& sink) : sink_(sink), wantsNormals_(sink.wantsNormals()) {}

  bool wantsNormals() const { return wantsNormals_; }
  /// Adds points.
  /// @return the number of the first one, for addFace; valid until breathe or flush
  Index addPoints(const PointRow& row);
  void addFace(std::initializer_list<Index> corners) {
    piece_.addFace({corners.begin(), corners.size()});
  }
  /// Adds points and the one face that has them as its corners; then calls breathe.
  void addPolygon(const PointRow& row);
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
  bool wantsNormals_;
  PolygonMesh piece_;
  std::vector<Vec3d> normals_;
};

/// A row of 2^log2Size points along the side of an array, or along a boundary.
struct SideRow {
  int log2Size = 0;
  /// Sets all points of `row` to the points from number `first` on.
  std::function<void(std::int64_t first, PointRow& row)> set;
};

/// Adds the faces between two rows that face each other. Seen from outside, with both rows running
/// upwards, `a` lies on the left. If the sizes differ, the points of the shorter row are spread
/// evenly over the longer one: there is a quad at each edge of the shorter row and a fan of
/// triangles at each of its points.
void stitch(const SideRow& a, const SideRow& b, PolygonPieces& pieces);

}  // namespace vox
