// Polygons of the faces of a submesh.

#include "libvox/subdivide/local_polygons.h"

#include "libvox/mesh/chaikin.h"

#include <algorithm>
#include <array>
#include <utility>

namespace vox {
namespace {

/// An array with more than 2^12 vertices goes to the sink as tiles.
constexpr int kMostLog2OfPiece = 12;

SideRow sideOfNext(const VertexArray& array) {
  return {array.depth().v, [&array](std::int64_t first, std::span<Vec3d> row) {
            array.alongV(array.sizeU() - 1, first, row);
          }};
}
SideRow sideOfPrevious(const VertexArray& array) {
  return {array.depth().u, [&array](std::int64_t first, std::span<Vec3d> row) {
            array.alongU(array.sizeV() - 1, first, row);
          }};
}
SideRow sideOfR(const VertexArray& array) {
  return {array.depth().u,
          [&array](std::int64_t first, std::span<Vec3d> row) { array.alongU(0, first, row); }};
}
SideRow sideOfL(const VertexArray& array) {
  return {array.depth().v,
          [&array](std::int64_t first, std::span<Vec3d> row) { array.alongV(0, first, row); }};
}

Vec3d onCurve(const CurvePoints& curve, std::int64_t j, std::int64_t n) {
  return PatchWeights(j, n)(curve[0], curve[1], curve[2]);
}

/// The same points for both directions of a curve, with the same bits.
Vec3d onEitherCurve(const CurvePoints& curve, std::int64_t j, std::int64_t n) {
  const auto& [a, b, c] = curve;
  const bool forward = std::lexicographical_compare(a.begin(), a.end(), c.begin(), c.end());
  return forward ? onCurve(curve, j, n) : onCurve({c, b, a}, n - 1 - j, n);
}

}  // namespace

/// The points of a boundary that descend from one point of level 1.
struct LocalPolygons::BoundaryPoints {
  CurvePoints curve;
  int log2Size;
  bool crease;

  Vec3d at(std::int64_t j) const {
    const std::int64_t n = std::int64_t{1} << log2Size;
    return crease ? onEitherCurve(curve, j, n) : onCurve(curve, j, n);
  }
  Vec3d first() const { return at(0); }
  Vec3d last() const { return at((std::int64_t{1} << log2Size) - 1); }

  /// In the direction of the boundary, or against it.
  SideRow row(bool forward) const {
    return {log2Size, [points = *this, forward](std::int64_t first, std::span<Vec3d> row) {
              const std::int64_t n = std::int64_t{1} << points.log2Size;
              for (Vec3d& point : row) {
                point = points.at(forward ? first : n - 1 - first);
                ++first;
              }
            }};
  }
};

LocalPolygons::BoundaryPoints LocalPolygons::boundaryPoints(const CurvePoints& curve, Index edge,
                                                            int depthBeside) const {
  const std::vector<Index>& seam = vertices_.images().base().seam;
  const bool crease = rule_ != nullptr && !seam.empty() && seam[edge] != kNone;
  return {curve, crease ? rule_->ofCrease(curve) : depthBeside, crease};
}

LocalPolygons::BoundaryPoints LocalPolygons::startOfEdge(const Corner& c) const {
  return boundaryPoints(vertices_.curveAcrossR(c), c.number, depths_[c.number].u);
}

LocalPolygons::BoundaryPoints LocalPolygons::endOfEdge(const Corner& c) const {
  return boundaryPoints(vertices_.curveAcrossL(c.next()), c.number, depths_[c.next().number].v);
}

void LocalPolygons::findDepths(std::span<const Index> faces, const DepthRule& rule,
                               std::span<VertexDepth> depths) {
  vertices_.set(faces);
  vertices_.images().forEachFace([&](Corner c) {
    for (Index i = 0; i < c.size; ++i, c = c.next()) {
      const LevelOneVertex vertex = vertices_.at(c);
      const BoundaryCurves curves = vertices_.curvesAt(c);
      if (vertex.regular) {
        depths[c.number] = rule.of(vertex, nullptr, curves);
        continue;
      }
      const VertexFaces around = vertices_.facesAt(c);
      depths[c.number] = rule.of(vertex, &around, curves);
    }
  });
}

void LocalPolygons::emit(std::span<const Index> faces, std::span<const VertexDepth> depths,
                         const DepthRule* rule, PolygonSink& sink) {
  vertices_.set(faces);
  rule_ = rule;
  depths_ = depths;
  PolygonPieces pieces(sink);
  vertices_.images().forEachFace([&](const Corner& first) { emitFace(first, pieces, sink); });
  pieces.flush();
}

void LocalPolygons::setArray(const Corner& corner, VertexArray& array, bool& whole) {
  const LevelOneVertex vertex = vertices_.at(corner);
  array.set(vertex, depths_[corner.number]);
  whole = vertex.whole();
}

void LocalPolygons::emitFace(const Corner& first, PolygonPieces& pieces, PolygonSink& sink) {
  polygon_.clear();
  bool whole = false;
  setArray(first, next_, whole);
  Corner c = first;
  for (Index i = 0; i < first.size; ++i, c = c.next()) {
    std::swap(here_, next_);
    emitArray(here_, whole, pieces, sink);
    polygon_.push_back(here_.cornerF());
    setArray(c.next(), next_, whole);
    const bool interior = !vertices_.isBoundary(c);
    if (interior || vertices_.images().extends())
      stitch(sideOfNext(here_), sideOfPrevious(next_), pieces);
    if (interior)
      emitEdge(c, here_, next_, pieces);
    else if (vertices_.images().extends())
      emitBoundaryEdge(c, here_, next_, pieces);
    if (vertices_.images().placeInVFace(c.slot()) == 0 && vertices_.images().hasVFace(c.slot()))
      emitVFace(c, pieces);
  }
  pieces.addPolygon(polygon_);
}

/// Emits the faces within an array; there are none if a face around its vertex is missing.
void LocalPolygons::emitArray(const VertexArray& array, bool whole, PolygonPieces& pieces,
                              PolygonSink& sink) {
  if (!whole || array.depth().u == 0 || array.depth().v == 0) return;
  if (array.blocks().size() > 1 && emitBlocks(array, pieces, sink)) return;
  emitGrid(array, pieces, sink);
}

/// Emits the faces between all vertices of an array.
void LocalPolygons::emitGrid(const VertexArray& array, PolygonPieces& pieces, PolygonSink& sink) {
  if (array.depth().u + array.depth().v > kMostLog2OfPiece) {
    sink.tiles(ArrayTiles(std::make_shared<const VertexArray>(array)));
    return;
  }
  const auto width = static_cast<Index>(array.sizeV());
  row_.resize(width);
  for (std::int64_t i = 0; i < array.sizeU(); ++i) {
    array.alongV(i, 0, row_);
    const Index here = pieces.addPoints(row_);
    if (i == 0) continue;
    for (Index j = 0; j + 1 < width; ++j)
      pieces.addFace({here - width + j, here + j, here + j + 1, here - width + j + 1});
  }
  pieces.breathe();
}

/// Emits the array of an irregular vertex block by block, if that saves many vertices.
/// @return whether it does
bool LocalPolygons::emitBlocks(const VertexArray& array, PolygonPieces& pieces, PolygonSink& sink) {
  if (rule_ == nullptr) return false;
  const auto log2Vertices = [](VertexDepth depth) { return depth.u + depth.v; };
  constexpr int kLeastSaving = 2;
  within_.clear();
  bool saves = false;
  for (const VertexArray::Block& block : array.blocks()) {
    VertexDepth least = rule_->within(block.patch, block.depth);
    // The outermost rows of the block stay: 4 x 2^u vertices.
    const bool much = block.depth.u > kLeastSaving + 1 &&
                      log2Vertices(least) + kLeastSaving <= log2Vertices(block.depth);
    if (!much) least = block.depth;
    saves |= much;
    within_.push_back(least);
  }
  if (!saves) return false;
  for (std::size_t b = 0; b < within_.size(); ++b) {
    const VertexArray::Block& block = array.blocks()[b];
    const bool less = !(within_[b] == block.depth);
    inner_.set(block.patch, within_[b]);
    if (block.depth.u > 0 && (less || block.depth.v > 0)) emitGrid(inner_, pieces, sink);
    if (less) emitRim(array, block, pieces);
    emitSeams(array, block, pieces);
  }
  return true;
}

/// Emits the faces between the outermost rows of a block and the fewer vertices within (inner_).
void LocalPolygons::emitRim(const VertexArray& array, const VertexArray::Block& block,
                            PolygonPieces& pieces) {
  const auto alongV = [&](std::int64_t i) {
    return SideRow{block.depth.v, [&array, &block, i](std::int64_t first, std::span<Vec3d> row) {
                     array.alongV(i, block.v + first, row);
                   }};
  };
  const auto alongU = [&](std::int64_t j) {
    return SideRow{block.depth.u, [&array, &block, j](std::int64_t first, std::span<Vec3d> row) {
                     array.alongU(j, block.u + first, row);
                   }};
  };
  stitch(alongV(block.u), sideOfL(inner_), pieces);
  stitch(sideOfNext(inner_), alongV(block.endU() - 1), pieces);
  stitch(sideOfR(inner_), alongU(block.v), pieces);
  stitch(alongU(block.endV() - 1), sideOfPrevious(inner_), pieces);
}

/// Emits the faces between a block and the next blocks along u and v.
void LocalPolygons::emitSeams(const VertexArray& array, const VertexArray::Block& block,
                              PolygonPieces& pieces) {
  constexpr std::int64_t kFaces = 1024;
  const auto addQuads = [&](std::int64_t faces, const auto& before, const auto& after) {
    for (std::int64_t first = 0; first < faces; first += kFaces) {
      const std::int64_t count = std::min(kFaces, faces - first);
      row_.resize(static_cast<std::size_t>(count + 1));
      before(first);
      const Index a = pieces.addPoints(row_);
      after(first);
      const Index b = pieces.addPoints(row_);
      for (Index j = 0; j < count; ++j) pieces.addFace({a + j, b + j, b + j + 1, a + j + 1});
      pieces.breathe();
    }
  };
  if (block.endU() < array.sizeU())
    addQuads(
        std::min(block.endV(), array.sizeV() - 1) - block.v,
        [&](std::int64_t j) { array.alongV(block.endU() - 1, block.v + j, row_); },
        [&](std::int64_t j) { array.alongV(block.endU(), block.v + j, row_); });
  if (block.endV() < array.sizeV())
    addQuads(
        block.endU() - 1 - block.u,
        [&](std::int64_t i) { array.alongU(block.endV(), block.u + i, row_); },
        [&](std::int64_t i) { array.alongU(block.endV() - 1, block.u + i, row_); });
}

/// Emits the faces that a corner owns across its edge: the strip to the corner beyond at the same
/// vertex and, if the corner is the lower one of the edge, the E-face.
void LocalPolygons::emitEdge(const Corner& c, const VertexArray& here, const VertexArray& next,
                             PolygonPieces& pieces) {
  const SubdivisionLevel& base = vertices_.images().base();
  const Index twin = base.adjacency.twin[c.number];
  const Index beyond = nextCorner(base.mesh, base.adjacency, twin);
  const bool strip = vertices_.images().hasVFace(c.slot());
  if (!strip && twin < c.number) return;
  other_.set(vertices_.acrossR(c), depths_[beyond]);
  if (strip) stitch(sideOfR(here), sideOfL(other_), pieces);
  if (twin < c.number) return;
  otherFar_.set(vertices_.acrossRFromNext(c), depths_[twin]);
  pieces.addPolygon(
      std::array{next.cornerL(), here.cornerR(), other_.cornerL(), otherFar_.cornerR()});
}

/// Emits the strips to the boundary points of a boundary edge, and the half E-face between them.
void LocalPolygons::emitBoundaryEdge(const Corner& c, const VertexArray& here,
                                     const VertexArray& next, PolygonPieces& pieces) {
  const BoundaryPoints start = startOfEdge(c);
  const BoundaryPoints end = endOfEdge(c);
  stitch(sideOfR(here), start.row(true), pieces);
  stitch(end.row(false), sideOfL(next), pieces);
  pieces.addPolygon(std::array{next.cornerL(), here.cornerR(), start.last(), end.first()});
}

/// Emits the V-face or half V-face of a fan, given its first corner.
void LocalPolygons::emitVFace(const Corner& c, PolygonPieces& pieces) {
  const SubdivisionLevel& base = vertices_.images().base();
  const Index number = vertices_.images().vFaceNumber(c.slot());
  const LocalImages::VFace& vFace = vertices_.images().vFaces()[number];
  row_.clear();
  Index corner = c.number;
  Index last = corner;
  for (Index place = 0; place < vFace.fan; ++place) {
    const bool quad = base.mesh.faceSize(base.adjacency.cornerFace[corner]) == 4;
    other_.set(vertices_.inVFace(number, place, quad), depths_[corner]);
    row_.push_back(other_.cornerVFace());
    last = corner;
    corner = nextAroundVertex(base.mesh, base.adjacency, corner);
  }
  if (!vFace.closed) {
    // The edge that arrives may belong to a face outside of the submesh.
    const Index edge = previousCorner(base.mesh, base.adjacency, last);
    const Vec3d before = chaikin(base.mesh.points[base.mesh.faceVertices[edge]],
                                 base.mesh.points[base.mesh.faceVertices[last]]);
    row_.push_back(
        boundaryPoints({before, vFace.mEnd, vFace.mStart}, edge, depths_[last].v).last());
    row_.push_back(startOfEdge(c).first());
  }
  pieces.addPolygon(row_);
}

}  // namespace vox
