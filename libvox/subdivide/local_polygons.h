#pragma once

#include "libvox/subdivide/local_vertices.h"
#include "libvox/subdivide/polygon_sink.h"

#include <span>
#include <vector>

namespace vox {

/// Refines submeshes of a base mesh into polygons, each level-1 vertex to a depth of its own, and
/// never builds the refined mesh.
///
/// Every level-1 vertex (one per corner of the base) becomes an array of vertices (vertex_array.h).
/// The faces within it, the strips between the facing rows of neighbours, and one polygon per
/// level-1 face of the corners of the arrays around it make one mesh without gaps for any depths:
/// at depth k everywhere it is level k + 1. A corner owns its array, the strip to the next corner
/// and the strip across its edge at its vertex; a face owns its F-face, the first corner of an edge
/// its E-face, the first corner of a fan its V-face. At an extended boundary the row of boundary
/// points beside a vertex is as long as the vertex's own.
///
/// One object per thread. Source: DESIGN section 10.
class LocalPolygons {
 public:
  /// @param base  level 0, in index space: an oriented manifold with one fan of faces at each
  ///   vertex, and no interior vertex of two faces
  explicit LocalPolygons(const SubdivisionLevel& base) : vertices_(base) {}

  /// Writes the depths of the corners of these faces.
  /// @param depths  one per corner of the base mesh
  /// @throws LimitError  coordinates out of all range
  void findDepths(std::span<const Index> faces, const DepthRule& rule,
                  std::span<VertexDepth> depths);

  /// Gives the sink the polygons that these faces own. Normals, where the sink wants them, cost a
  /// look at the faces beyond: all around a vertex then is known, on either side of an edge.
  /// @param depths  one per corner of the base mesh; of irregular vertices u = v
  /// @param rule    where given, parts of the arrays of irregular vertices that need fewer vertices
  ///   by it, along u or v or both, get them: all but their outermost rows
  void emit(std::span<const Index> faces, std::span<const VertexDepth> depths,
            const DepthRule* rule, PolygonSink& sink);

 private:
  using Corner = LocalVertices::Corner;

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
  void setArray(const Corner& corner, VertexArray& array, bool& whole);
  void setAcrossR(const Corner& corner, Index beyond);
  void setAcrossRFromNext(const Corner& corner, Index twin);
  void setInVFace(Index number, Index place, Index corner);

  LocalVertices vertices_;
  std::span<const VertexDepth> depths_;
  const DepthRule* rule_ = nullptr;
  VertexArray here_, next_, other_, otherFar_;
  VertexArray inner_;                // of a block
  std::vector<VertexDepth> within_;  // of the blocks of an array
  PointRow polygon_;
  PointRow row_;
};

}  // namespace vox
