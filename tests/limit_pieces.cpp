// The pieces of a limit surface, by Doo-Sabin steps of the whole mesh.

#include "tests/limit_pieces.h"

#include "libvox/mesh/chaikin.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/image_vertices.h"
#include "libvox/subdivide/strip.h"

#include <algorithm>
#include <utility>

namespace vox::test {
namespace {

/// One level, and which of its vertices wait for a patch.
class PieceLevel {
 public:
  PieceLevel(SubdivisionLevel level, std::vector<bool> waiting)
      : level_(std::move(level)), waiting_(std::move(waiting)) {}

  /// Makes patches of regular vertices that wait; the others wait on.
  void takePatches(std::vector<Patch>& patches) {
    const bool extends = level_.boundary == BoundaryStage::kExtend;
    open_.assign(mesh().cornerCount(), extends);  // images at a new boundary get all faces
    for (Index c = 0; c < mesh().cornerCount(); ++c) {
      const Index valence = ledOneRingSize(mesh(), adjacency(), c);
      if (valence == 0) continue;
      const std::vector<Index> ring = ringOf(c, valence);
      const bool waits = waiting_[mesh().faceVertices[c]];
      const bool regular = isRegular(ring);
      if (waits && regular) patches.push_back(patchOf(ring));
      for (const Index k : ring) open_[k] = waits && !regular;
      if (waits && !regular) openRings_.push_back(ring);
    }
  }

  /// Triangles around the vertices that still wait.
  void close(std::vector<std::array<Vec3d, 3>>& triangles) const {
    const std::vector<Vec3d> image = imageVertices(level_);
    for (const std::vector<Index>& ring : openRings_) {
      Vec3d middleOfRing = Vec3d::Zero();
      for (const Index c : ring) middleOfRing += image[c] / static_cast<double>(ring.size());
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec3d a = limitOfFace(faceOf(ring[i]));
        const Vec3d b = limitOfFace(faceOf(ring[(i + 1) % ring.size()]));
        if (!normalOfTangents(a - middleOfRing, b - middleOfRing).isZero(0))
          triangles.push_back({middleOfRing, a, b});
      }
    }
  }

  /// The next level of all faces near vertices that wait.
  PieceLevel next() const {
    if (level_.boundary == BoundaryStage::kExtend) return stepOf(level_, open_);
    return stepOf(nearOpen(), openNear());
  }

 private:
  const PolygonMesh& mesh() const { return level_.mesh; }
  const Adjacency& adjacency() const { return level_.adjacency; }
  Index faceOf(Index c) const { return adjacency().cornerFace[c]; }
  Index after(Index c) const { return nextCorner(mesh(), adjacency(), c); }
  Index before(Index c) const { return previousCorner(mesh(), adjacency(), c); }
  const Vec3d& at(Index c) const { return mesh().points[mesh().faceVertices[c]]; }

  static PieceLevel stepOf(const SubdivisionLevel& level, std::vector<bool> open) {
    SubdivisionLevel next = nextLevel(level, imageVertices(level));
    open.resize(next.mesh.pointCount(), false);  // points of the boundary have no patches
    return {std::move(next), std::move(open)};
  }

  std::vector<Index> ringOf(Index c, Index valence) const {
    std::vector<Index> ring;
    for (Index i = 0; i < valence; ++i, c = nextAroundVertex(mesh(), adjacency(), c))
      ring.push_back(c);
    return ring;
  }

  bool isRegular(const std::vector<Index>& ring) const {
    return ring.size() == 4 && std::all_of(ring.begin(), ring.end(), [&](Index c) {
             return mesh().faceSize(faceOf(c)) == 4;
           });
  }

  /// The boundary corner of a strip face; else kNone.
  Index stripCorner(Index f) const {
    return level_.boundary == BoundaryStage::kStrips ? boundaryCornerOf(level_, f) : kNone;
  }

  /// The control point at a corner of a quad. Beyond the boundary, it is the mirror image of the
  /// inner point.
  Vec3d controlPoint(Index c) const {
    const Index edge = stripCorner(faceOf(c));
    if (edge != kNone && c == edge) return mirrored(at(before(c)), at(c));
    if (edge != kNone && c == after(edge)) return mirrored(at(after(c)), at(c));
    return at(c);
  }

  Patch patchOf(const std::vector<Index>& ring) const {
    Patch patch;
    auto& p = patch.points;
    p[1][1] = at(ring[0]);
    p[2][1] = controlPoint(after(ring[0]));
    p[1][2] = controlPoint(after(ring[1]));
    p[0][1] = controlPoint(after(ring[2]));
    p[1][0] = controlPoint(after(ring[3]));
    p[2][2] = controlPoint(after(after(ring[0])));
    p[0][2] = controlPoint(after(after(ring[1])));
    p[0][0] = controlPoint(after(after(ring[2])));
    p[2][0] = controlPoint(after(after(ring[3])));
    return patch;
  }

  Vec3d limitOfFace(Index f) const {
    const Index edge = stripCorner(f);
    if (edge != kNone) return middle(at(edge), at(after(edge)));
    Vec3d sum = Vec3d::Zero();
    for (const Index v : mesh().face(f)) sum += mesh().points[v];
    return sum / mesh().faceSize(f);
  }

  /// Faces of vertices that wait, and all faces that share a vertex with these. The steps of the
  /// former and the rings of all their corners then are those of the whole mesh.
  std::vector<bool> keptFaces() const {
    std::vector<bool> core(mesh().faceCount(), false);
    for (Index c = 0; c < mesh().cornerCount(); ++c)
      if (open_[c]) core[faceOf(c)] = true;
    std::vector<bool> near(mesh().pointCount(), false);
    for (Index c = 0; c < mesh().cornerCount(); ++c)
      if (core[faceOf(c)]) near[mesh().faceVertices[c]] = true;
    std::vector<bool> kept(mesh().faceCount(), false);
    for (Index c = 0; c < mesh().cornerCount(); ++c)
      if (near[mesh().faceVertices[c]]) kept[faceOf(c)] = true;
    return kept;
  }

  SubdivisionLevel nearOpen() const {
    const std::vector<bool> kept = keptFaces();
    SubdivisionLevel part;
    part.boundary = level_.boundary;
    std::vector<Index> newCorner(mesh().cornerCount(), kNone);
    std::vector<Index> newPoint(mesh().pointCount(), kNone);
    for (Index f = 0; f < mesh().faceCount(); ++f) {
      if (!kept[f]) continue;
      for (Index c = mesh().faceOffsets[f]; c < mesh().faceOffsets[f + 1]; ++c) {
        newCorner[c] = part.mesh.cornerCount();
        Index& v = newPoint[mesh().faceVertices[c]];
        if (v == kNone) {
          v = part.mesh.pointCount();
          part.mesh.points.push_back(at(c));
        }
        part.mesh.faceVertices.push_back(v);
      }
      part.mesh.faceOffsets.push_back(part.mesh.cornerCount());
    }
    for (Index c = 0; c < mesh().cornerCount(); ++c) {
      if (newCorner[c] == kNone) continue;
      const Index twin = adjacency().twin[c];
      part.adjacency.twin.push_back(twin == kNone ? kNone : newCorner[twin]);
    }
    part.adjacency.cornerFace = CornerFaces(part.mesh);
    return part;
  }

  /// open_ of the corners of nearOpen().
  std::vector<bool> openNear() const {
    const std::vector<bool> kept = keptFaces();
    std::vector<bool> open;
    for (Index c = 0; c < mesh().cornerCount(); ++c)
      if (kept[faceOf(c)]) open.push_back(open_[c]);
    return open;
  }

  SubdivisionLevel level_;
  std::vector<bool> waiting_;                  // per vertex
  std::vector<bool> open_;                     // per corner: its image waits in the next level
  std::vector<std::vector<Index>> openRings_;  // closed rings of vertices that wait on
};

}  // namespace

LimitPieces limitPieces(const SubdivisionLevel& base, int levels) {
  LimitPieces pieces;
  PieceLevel level(base, std::vector<bool>(base.mesh.pointCount(), true));
  level.takePatches(pieces.patches);
  for (int k = 0; k < std::max(levels, 2); ++k) {
    level = level.next();
    level.takePatches(pieces.patches);
  }
  level.close(pieces.triangles);
  return pieces;
}

}  // namespace vox::test
