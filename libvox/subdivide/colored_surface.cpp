// Refines positions and colours together: whole levels of small pieces of the mesh.

#include "libvox/subdivide/colored_surface.h"

#include "libvox/core/numbered.h"
#include "libvox/mesh/patch_parts.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/stop.h"
#include "libvox/subdivide/strip.h"
#include "libvox/subdivide/vertex_patch.h"

#include <algorithm>
#include <utility>

namespace vox {
namespace {

/// Cuts faces out of a level, with their points and adjacency. The faces stay in their order, so
/// that the corners around each vertex do, and every later sum has the same bits.
class Cutter {
 public:
  Cutter(const SubdivisionLevel& level, std::vector<Index>& slots, std::vector<Index>& points)
      : from_(level), slots_(slots), points_(points) {
    slots_.resize(level.mesh.faceCount(), kNone);
    points_.resize(level.mesh.pointCount(), kNone);
  }

  /// The faces as a level of their own. Resets the tables of the caller afterwards.
  SubdivisionLevel cut(std::span<const Index> faces) {
    SubdivisionLevel piece;
    piece.boundary = from_.boundary;
    for (const Index f : faces) {
      slots_[f] = piece.mesh.faceCount();
      for (const Index v : from_.mesh.face(f)) addCorner(v, piece);
      piece.mesh.faceOffsets.push_back(piece.mesh.cornerCount());
    }
    for (const Index f : faces) addAdjacency(f, piece);
    for (const Index f : faces) {
      slots_[f] = kNone;
      for (const Index v : from_.mesh.face(f)) points_[v] = kNone;
    }
    return piece;
  }

  /// For each point of the last piece, the point of the level.
  const std::vector<Index>& pointOrigin() const { return pointOrigin_; }

 private:
  void addCorner(Index v, SubdivisionLevel& piece) {
    if (points_[v] == kNone) {
      points_[v] = piece.mesh.pointCount();
      piece.mesh.points.push_back(from_.mesh.points[v]);
      pointOrigin_.push_back(v);
    }
    piece.mesh.faceVertices.push_back(points_[v]);
  }

  void addAdjacency(Index f, SubdivisionLevel& piece) const {
    for (Index c = from_.mesh.faceOffsets[f]; c < from_.mesh.faceOffsets[f + 1]; ++c) {
      const Index twin = from_.adjacency.twin[c];
      const Index neighbour = twin == kNone ? kNone : from_.adjacency.cornerFace[twin];
      const Index slot = neighbour == kNone ? kNone : slots_[neighbour];
      piece.adjacency.twin.push_back(slot == kNone ? kNone
                                                   : piece.mesh.faceOffsets[slot] + twin -
                                                         from_.mesh.faceOffsets[neighbour]);
      piece.adjacency.cornerFace.push_back(slots_[f]);
    }
  }

  const SubdivisionLevel& from_;
  std::vector<Index>& slots_;
  std::vector<Index>& points_;
  std::vector<Index> pointOrigin_;
};

/// Number of rows or columns, a power of 2, that are at most half a voxel apart if control points
/// are `step` voxels apart. Unlike the faces of vertex conversion (stop.h), the faces between them
/// need not be small in both directions; so needles have far fewer samples.
std::int64_t samplesFor(double step) {
  constexpr double kMostStep = 0.5;
  std::int64_t n = 1;
  while (step > kMostStep * static_cast<double>(n)) n *= 2;
  return n;
}

/// Steps from row to row of the control points; L-inf, in voxels.
struct StepAcross {
  double length = 0;    ///< of the longest step
  double distance = 0;  ///< largest distance of a step's end from the line of its row
};

StepAcross stepAcross(const Patch& patch) {
  StepAcross across;
  const auto& p = patch.points;
  for (std::size_t u = 0; u < 2; ++u)
    for (std::size_t v = 0; v < 3; ++v) {
      const Vec3d step = p[u + 1][v] - p[u][v];
      across.length = std::max(across.length, step.cwiseAbs().maxCoeff());
      for (const std::size_t row : {u, u + 1})
        for (const std::size_t column : {v == 2 ? 1 : v, v == 0 ? 0 : v - 1}) {
          const Vec3d along = p[row][column + 1] - p[row][column];
          const double square = along.squaredNorm();
          const Vec3d beside = square > 0 ? Vec3d(step - step.dot(along) / square * along) : step;
          across.distance = std::max(across.distance, beside.cwiseAbs().maxCoeff());
        }
    }
  return across;
}

/// Upper bound of the width of a patch: twice the largest distance of a control point from a line
/// through two control points.
double widthOf(const Patch& patch) {
  const auto farthestFrom = [&](const Vec3d& from) {
    Vec3d farthest = from;
    for (const auto& row : patch.points)
      for (const Vec3d& p : row)
        if ((p - from).squaredNorm() > (farthest - from).squaredNorm()) farthest = p;
    return farthest;
  };
  const Vec3d start = farthestFrom(patch.points[1][1]);
  const Vec3d line = (farthestFrom(start) - start).stableNormalized();
  double most = 0;
  for (const auto& row : patch.points)
    for (const Vec3d& p : row)
      most = std::max(most, (p - start - (p - start).dot(line) * line).cwiseAbs().maxCoeff());
  return 2 * most;
}

/// Gives the sink the descendants of a regular vertex. If rows and columns run nearly the same way,
/// as around a face of thousands of sides, a few rows and the outermost columns are enough.
void emitPatch(const Patch& position, const Patch& color, ColoredSink& sink) {
  const Patch turned = quarterTurn(position);
  const StepAcross fromRow = stepAcross(position);
  const StepAcross fromColumn = stepAcross(turned);
  const std::int64_t rows = samplesFor(fromRow.length);
  const std::int64_t columns = samplesFor(fromColumn.length);
  const double width = widthOf(position);
  const std::int64_t fewRows = std::min(rows, samplesFor(std::min(fromRow.distance, width)));
  const std::int64_t fewColumns =
      std::min(columns, samplesFor(std::min(fromColumn.distance, width)));
  constexpr std::int64_t kFarFewer = 4;  // a smaller factor is not worth it
  if (kFarFewer * std::min(fewRows * columns, fewColumns * rows) > rows * columns)
    return sink.patch(position, color, rows, columns);
  const auto emit = [&](const Patch& p, const Patch& c, std::int64_t few, std::int64_t along,
                        std::int64_t across) {
    sink.patch(p, c, few, along);
    const Patch turnedP = quarterTurn(p);
    const Patch turnedC = quarterTurn(c);
    for (const std::int64_t column : {std::int64_t{0}, along - 1})
      sink.curve(rowOf(turnedP, {column, along}), rowOf(turnedC, {column, along}), across);
  };
  if (fewRows * columns <= fewColumns * rows)
    emit(position, color, fewRows, columns, rows);
  else
    emit(turned, quarterTurn(color), fewColumns, rows, columns);
}

/// A piece of a level >= 1. Emits the vertices that are fine enough or regular, and keeps the
/// others for the next level.
class Piece {
 public:
  /// @param owned  for each point, whether it is to be emitted
  Piece(ColoredLevel colored, std::vector<std::uint8_t> owned, ColoredSink& sink)
      : colored_(std::move(colored)), owned_(std::move(owned)), sink_(&sink) {}

  /// @return whether a vertex is left for the next level
  bool emit() {
    const PolygonMesh& mesh = colored_.level.mesh;
    inside_.assign(mesh.faceCount(), 0);
    measureFaces();
    std::vector<std::uint8_t> seen(mesh.pointCount(), 0);
    bool left = false;
    for (Index c = 0; c < mesh.cornerCount(); ++c) {
      const Index v = mesh.faceVertices[c];
      if (owned_[v] == 0 || std::exchange(seen[v], 1) != 0) continue;
      const OneRing ring = oneRing(mesh, colored_.level.adjacency, c);
      owned_[v] = emitVertex(v, ring) ? 0 : 1;
      if (owned_[v] == 0) continue;
      left = true;
      for (const Index k : ring.corners) addNeighbourhood(colored_.level.adjacency.cornerFace[k]);
    }
    return left;
  }

  /// The vertices that are left and the faces around them, one level down.
  Piece next() {
    std::vector<Index> faces;
    for (Index f = 0; f < inside_.size(); ++f)
      if (inside_[f] != 0) faces.push_back(f);
    std::vector<Index> slots, points;
    Cutter cutter(colored_.level, slots, points);
    ColoredLevel piece{cutter.cut(faces), {}};
    std::vector<std::uint8_t> ownedPoints;
    for (const Index v : cutter.pointOrigin()) {
      piece.colors.push_back(colored_.colors[v]);
      ownedPoints.push_back(owned_[v]);
    }
    std::vector<std::uint8_t> owned;
    for (const Index v : piece.level.mesh.faceVertices) owned.push_back(ownedPoints[v]);
    return {nextColoredLevel(std::move(piece)), std::move(owned), *sink_};
  }

 private:
  void measureFaces() {
    diameters_.clear();
    std::vector<Vec3d> points;
    for (Index f = 0; f < colored_.level.mesh.faceCount(); ++f) {
      points.clear();
      for (const Index v : colored_.level.mesh.face(f))
        points.push_back(colored_.level.mesh.points[v]);
      diameters_.push_back(diameter(points));
    }
  }

  bool emitVertex(Index v, const OneRing& ring) {
    const PolygonMesh& mesh = colored_.level.mesh;
    double largest = 0;
    for (const Index c : ring.corners)
      largest = std::max(largest, diameters_[colored_.level.adjacency.cornerFace[c]]);
    if (largest <= kVertexConversionSpan) {
      sink_->point(mesh.points[v], colored_.colors[v]);
      return true;
    }
    if (!ring.closed) return false;
    const auto position = patchAround(colored_.level, ring, mesh.points);
    if (!position) return false;
    emitPatch(*position, *patchAround(colored_.level, ring, colored_.colors), *sink_);
    return true;
  }

  /// Adds a face at a vertex that is left, and all faces that share a vertex with it. So one level
  /// down, the faces around the children of the vertex are complete, and so are their neighbours.
  void addNeighbourhood(Index f) {
    if ((inside_[f] & kExpanded) != 0) return;
    inside_[f] |= kExpanded;
    const SubdivisionLevel& level = colored_.level;
    for (Index c = level.mesh.faceOffsets[f]; c < level.mesh.faceOffsets[f + 1]; ++c)
      for (const Index k : oneRing(level.mesh, level.adjacency, c).corners)
        inside_[level.adjacency.cornerFace[k]] |= kInside;
  }

  static constexpr std::uint8_t kInside = 1;
  static constexpr std::uint8_t kExpanded = 2;
  ColoredLevel colored_;
  std::vector<std::uint8_t> owned_;
  std::vector<std::uint8_t> inside_;  // per face
  std::vector<double> diameters_;     // per face, L-inf
  ColoredSink* sink_;
};

}  // namespace

std::vector<Vec3d> cornerColors(const PolygonMesh& mesh) {
  std::vector<Vec3d> colors;
  if (!mesh.pointColors.empty()) {
    for (const Index v : mesh.faceVertices) colors.push_back(mesh.pointColors[v].cast<double>());
  } else if (!mesh.faceColors.empty()) {
    for (Index f = 0; f < mesh.faceCount(); ++f)
      colors.insert(colors.end(), mesh.faceSize(f), mesh.faceColors[f].cast<double>());
  }
  return colors;
}

ColoredLevel firstColoredLevel(const ColoredLevel& base) {
  SubdivisionLevel corners{{}, base.level.adjacency, base.level.boundary};
  corners.mesh.points = base.colors;
  corners.mesh.faceOffsets = base.level.mesh.faceOffsets;
  corners.mesh.faceVertices = numbered(base.colors.size());  // each corner has its own point
  return {nextLevel(base.level, imageVertices(base.level)), imageVertices(corners)};
}

ColoredLevel nextColoredLevel(ColoredLevel level) {
  std::vector<Vec3d> positions = imageVertices(level.level);
  std::swap(level.level.mesh.points, level.colors);
  std::vector<Vec3d> colors = imageVertices(level.level);
  return {nextLevel(level.level, std::move(positions)), std::move(colors)};
}

ColoredSurface::ColoredSurface(const SubdivisionLevel& base, std::span<const Vec3d> colors)
    : base_(base),
      colors_(colors),
      inside_(base.mesh.faceCount(), 0),
      seen_(base.mesh.pointCount(), 0) {}

void ColoredSurface::addOneRing(Index corner) {
  if (std::exchange(seen_[base_.mesh.faceVertices[corner]], 1) != 0) return;
  for (const Index k : oneRing(base_.mesh, base_.adjacency, corner).corners) {
    const Index f = base_.adjacency.cornerFace[k];
    if (std::exchange(inside_[f], 1) == 0) faces_.push_back(f);
  }
}

ColoredLevel ColoredSurface::cutOut(std::span<const Index> faces) {
  faces_.clear();
  for (const Index f : faces)
    for (Index c = base_.mesh.faceOffsets[f]; c < base_.mesh.faceOffsets[f + 1]; ++c) addOneRing(c);
  for (const Index f : faces_) inside_[f] = 0;
  for (const Index f : faces)
    for (const Index v : base_.mesh.face(f)) seen_[v] = 0;
  std::sort(faces_.begin(), faces_.end());
  ColoredLevel piece{Cutter(base_, slots_, points_).cut(faces_), {}};
  for (const Index f : faces_)
    for (Index c = base_.mesh.faceOffsets[f]; c < base_.mesh.faceOffsets[f + 1]; ++c)
      piece.colors.push_back(colors_[c]);
  return piece;
}

void ColoredSurface::emit(std::span<const Index> faces, ColoredSink& sink) {
  const ColoredLevel base = cutOut(faces);
  for (const Index f : faces) inside_[f] = 1;
  std::vector<std::uint8_t> owned;
  for (const Index f : base.level.adjacency.cornerFace) owned.push_back(inside_[faces_[f]]);
  if (base.level.boundary == BoundaryStage::kExtend)
    for (const Index c : boundaryCorners(base.level.adjacency))
      owned.insert(owned.end(), 2, owned[c]);
  for (const Index f : faces) inside_[f] = 0;

  Piece piece(firstColoredLevel(base), std::move(owned), sink);
  while (piece.emit()) piece = piece.next();
}

}  // namespace vox
