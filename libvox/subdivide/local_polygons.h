#pragma once

#include "libvox/subdivide/local_vertices.h"
#include "libvox/subdivide/polygon_sink.h"

#include <span>
#include <vector>

namespace vox {

/// Refines submeshes of a base mesh into polygons, each level-1 vertex to a depth of its own. The
/// refined mesh is never built.
///
/// Every level-1 vertex (one per corner of the base) becomes an array of vertices (vertex_array.h).
/// There are three kinds of polygons: the faces within each array; strips between the facing rows
/// of neighbouring arrays; and for each level-1 face one polygon between the corners of the arrays
/// around it. For any depths they form one mesh without gaps; with depth k everywhere it is level
/// k + 1. A corner owns its array, the strip to the next corner, and the strip across its edge at
/// its vertex. A face owns its F-face, the first corner of an edge the E-face, the first corner of
/// a fan the V-face. At an extended boundary, the row of boundary points beside a vertex is as long
/// as the row of the vertex. Along a crease its length follows from the curve alone, and its points
/// have the same bits on both sides.
///
/// One object per thread. Source: DESIGN section 10.
class LocalPolygons {
 public:
  /// @param base  level 0, in index space: an oriented manifold with one fan of faces at each
  ///   vertex, and no interior vertex of two faces
  explicit LocalPolygons(const SubdivisionLevel& base) : vertices_(base) {}

  /// Computes the depths of the corners of some faces.
  /// @param depths  one per corner of the base mesh; only those of these corners are written
  /// @throws LimitError  coordinates are out of range
  void findDepths(std::span<const Index> faces, const DepthRule& rule,
                  std::span<VertexDepth> depths);

  /// Gives the sink the polygons that some faces own.
  /// @param faces   of the base
  /// @param depths  one per corner of the base mesh; u = v for irregular vertices
  /// @param rule    if not null, a block of the array of an irregular vertex gets only the vertices
  ///   that it needs by this rule, except for its outermost rows
  void emit(std::span<const Index> faces, std::span<const VertexDepth> depths,
            const DepthRule* rule, PolygonSink& sink);

 private:
  using Corner = SubmeshCorner;

  void emitFace(const Corner& first, PolygonPieces& pieces, PolygonSink& sink);
  void emitArray(const VertexArray& array, bool whole, PolygonPieces& pieces, PolygonSink& sink);
  bool emitBlocks(const VertexArray& array, PolygonPieces& pieces, PolygonSink& sink);
  void emitGrid(const VertexArray& array, PolygonPieces& pieces, PolygonSink& sink);
  void emitRim(const VertexArray& array, const VertexArray::Block& block, PolygonPieces& pieces);
  void emitSeams(const VertexArray& array, const VertexArray::Block& block, PolygonPieces& pieces);
  void emitEdge(const Corner& corner, const VertexArray& here, const VertexArray& next,
                PolygonPieces& pieces);
  void emitBoundaryEdge(const Corner& corner, const VertexArray& here, const VertexArray& next,
                        PolygonPieces& pieces);
  void emitVFace(const Corner& corner, PolygonPieces& pieces);

  struct BoundaryPoints;
  /// @param edge         corner of the boundary edge, in the base mesh
  /// @param depthBeside  depth of the vertex beside the points
  BoundaryPoints boundaryPoints(const CurvePoints& curve, Index edge, int depthBeside) const;
  BoundaryPoints startOfEdge(const Corner& corner) const;
  BoundaryPoints endOfEdge(const Corner& corner) const;
  void setArray(const Corner& corner, VertexArray& array, bool& whole);

  LocalVertices vertices_;
  std::span<const VertexDepth> depths_;
  const DepthRule* rule_ = nullptr;
  VertexArray here_, next_, other_, otherFar_;
  VertexArray inner_;                // the vertices within a block
  std::vector<VertexDepth> within_;  // depths within the blocks of an array
  std::vector<Vec3d> polygon_;
  std::vector<Vec3d> row_;
};

}  // namespace vox
