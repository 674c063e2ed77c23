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
  /// Whether points come with normals.
  virtual bool wantsNormals() const { return false; }
  /// Some polygons, counter-clockwise from outside, with the points they use: at most some ten
  /// thousand, but for a single polygon of more corners. Where pieces meet, their points have the
  /// same bits, and so have their normals. Valid during the call.
  /// @param normals  if wanted: one per point, of the smooth surface where the vertex comes to lie
  ///   on it; unit, outward, or 0 where there is none
  virtual void polygons(const PolygonMesh& piece, std::span<const Vec3d> normals) = 0;
  /// The faces within a large array; by default its tiles follow one another.
  virtual void tiles(const ArrayTiles& tiles);
};

/// Points that follow one another, with normals where these are wanted.
struct PointRow {
  explicit PointRow(bool withNormals = false) : hasNormals(withNormals) {}

  bool hasNormals;
  std::vector<Vec3d> points;
  std::vector<Vec3d> normals;  ///< as many, or none

  void clear() { resize(0); }
  void resize(std::size_t size) {
    points.resize(size);
    if (hasNormals) normals.resize(size);
  }
  /// Another one of that size.
  PointRow ofSize(std::size_t size) const {
    PointRow row(hasNormals);
    row.resize(size);
    return row;
  }
  /// Vertices of an array, as many as the row has points.
  void setAlongV(const VertexArray& array, std::int64_t i, std::int64_t first) {
    array.alongV(i, first, points);
    if (hasNormals) array.normalsAlongV(i, first, normals);
  }
  void setAlongU(const VertexArray& array, std::int64_t j, std::int64_t first) {
    array.alongU(j, first, points);
    if (hasNormals) array.normalsAlongU(j, first, normals);
  }
  /// One more.
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

/// Collects faces into pieces.
class PolygonPieces {
 public:
  explicit PolygonPieces(PolygonSink& sink) : sink_(sink), wantsNormals_(sink.wantsNormals()) {}

  bool wantsNormals() const { return wantsNormals_; }
  /// Faces of points that come next: numbers count from the first of them.
  Index addPoints(const PointRow& row);
  void addFace(std::initializer_list<Index> corners) {
    piece_.addFace({corners.begin(), corners.size()});
  }
  /// One face of its own points.
  void addPolygon(const PointRow& row);
  /// Between pieces of work that share no points: passes on what has become much.
  void breathe() {
    if (piece_.points.size() >= kPoints) flush();
  }
  void flush();

 private:
  static constexpr std::size_t kPoints = 4096;

  PolygonSink& sink_;
  bool wantsNormals_;
  PolygonMesh piece_;
  std::vector<Vec3d> normals_;
};

/// A row of 2^size points along the side of a vertex, or along a boundary.
struct SideRow {
  int log2Size = 0;
  std::function<void(std::int64_t first, PointRow& row)> set;  ///< as many as the row has points
};

/// Faces between two rows that face each other. Seen from outside, with both running upwards, A
/// lies on the left. Every edge of the row with fewer points gets as many of the other: a quad
/// across, and a fan at each of its points.
void stitch(const SideRow& a, const SideRow& b, PolygonPieces& pieces);

}  // namespace vox
