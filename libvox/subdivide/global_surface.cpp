// Subdivides whole levels, and notes for each vertex how many more levels it needs.

#include "libvox/subdivide/global_surface.h"

#include "libvox/core/error.h"
#include "libvox/mesh/chaikin.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/stop.h"
#include "libvox/subdivide/thin_patch.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace vox {
namespace {

// In place of the number of levels that a vertex still needs:
constexpr int kUndecided = -1;  ///< it is irregular and not fine enough
constexpr int kEmitted = -2;    ///< it or an ancestor has been emitted

/// The points of a quad, from one of its corners on. If two of them are on the boundary of an
/// extended surface, they are replaced by the mirror images of the other two about them.
std::array<Vec3d, 4> quadFrom(const SubdivisionLevel& level, Index corner) {
  std::array<Vec3d, 4> points;
  std::array<Index, 4> corners;
  Index c = corner;
  for (std::size_t i = 0; i < 4; ++i, c = nextCorner(level.mesh, level.adjacency, c)) {
    corners[i] = c;
    points[i] = level.mesh.points[level.mesh.faceVertices[c]];
  }
  if (level.boundary != BoundaryStage::kStrips) return points;
  for (std::size_t i = 0; i < 4; ++i) {
    if (level.adjacency.twin[corners[i]] != kNone) continue;
    const std::size_t start = i;
    const std::size_t end = (i + 1) % 4;
    points[start] = mirrored(points[(start + 3) % 4], points[start]);
    points[end] = mirrored(points[(end + 1) % 4], points[end]);
  }
  return points;
}

/// The patch around a vertex of a level >= 1; nothing if the vertex is not regular. It is regular
/// if its faces are quads: four of them, or fewer at a free boundary. Boundary points of an
/// extended surface are replaced by mirror images, so that strip faces become whole quads.
std::optional<Patch> patchAround(const SubdivisionLevel& level, const OneRing& ring) {
  if (ring.closed ? ring.corners.size() != 4 : ring.corners.size() > 3) return {};
  for (const Index c : ring.corners)
    if (level.mesh.faceSize(level.adjacency.cornerFace[c]) != 4) return {};
  // Quadrants in counter-clockwise order, and the steps to the next vertex along each face.
  constexpr std::array<std::array<int, 2>, 4> kAlong = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  constexpr std::array<unsigned, 4> kQuadrant = {3, 1, 0, 2};
  Patch patch;
  for (auto& row : patch.points)
    row.fill(level.mesh.points[level.mesh.faceVertices[ring.corners[0]]]);
  unsigned quadrants = 0;
  for (std::size_t k = 0; k < ring.corners.size(); ++k) {
    const auto& a = kAlong[k];
    const auto& b = kAlong[(k + 1) % 4];
    const auto put = [&](int u, int v, const Vec3d& p) {
      patch.points[static_cast<std::size_t>(u + 1)][static_cast<std::size_t>(v + 1)] = p;
    };
    const auto face = quadFrom(level, ring.corners[k]);
    put(a[0], a[1], face[1]);
    put(a[0] + b[0], a[1] + b[1], face[2]);
    put(b[0], b[1], face[3]);
    quadrants |= 1U << kQuadrant[k];
  }
  patch.quadrants = static_cast<std::uint8_t>(quadrants);
  return patch;
}

/// L-inf diameter of the largest face around a vertex.
double largestFace(const PolygonMesh& mesh, const Adjacency& adjacency, const OneRing& ring) {
  double largest = 0;
  std::vector<Vec3d> points;
  for (const Index c : ring.corners) {
    points.clear();
    for (const Index v : mesh.face(adjacency.cornerFace[c])) points.push_back(mesh.points[v]);
    largest = std::max(largest, diameter(points));
  }
  return largest;
}

/// Decides for one level >= 1 how many more levels each vertex needs.
class Decisions {
 public:
  Decisions(const SubdivisionLevel& level, int number, std::vector<int> levelsToGo,
            SurfaceSink& sink)
      : number_(number),
        sink_(sink),
        level_(level),
        mesh_(level.mesh),
        adjacency_(level.adjacency),
        strips_(level.boundary == BoundaryStage::kStrips),
        levelsToGo_(std::move(levelsToGo)),
        cornerAt_(mesh_.pointCount(), kNone),
        onBoundary_(mesh_.pointCount(), false) {
    for (Index c = 0; c < mesh_.cornerCount(); ++c) {
      const Index v = mesh_.faceVertices[c];
      cornerAt_[v] = std::min(cornerAt_[v], c);
      if (adjacency_.twin[c] == kNone) onBoundary_[v] = onBoundary_[endOf(c)] = true;
    }
  }

  std::vector<int> run() {
    for (Index v = 0; v < mesh_.pointCount(); ++v)
      if (levelsToGo_[v] == kUndecided && cornerAt_[v] != kNone) decide(v);
    return std::move(levelsToGo_);
  }

 private:
  Index endOf(Index c) const { return mesh_.faceVertices[nextCorner(mesh_, adjacency_, c)]; }
  Index faceOf(Index c) const { return adjacency_.cornerFace[c]; }

  void decide(Index v) {
    const OneRing ring = oneRing(mesh_, adjacency_, cornerAt_[v]);
    const double largest = largestFace(mesh_, adjacency_, ring);
    if (strips_ && onBoundary_[v]) {
      levelsToGo_[v] = curveDepth(largest);
      return;
    }
    if (const auto patch = patchAround(level_, ring))
      decideRegular(v, *patch);
    else if (largest <= kVertexConversionSpan)
      levelsToGo_[v] = 0;
    else if (ring.closed && !touchesStrip(ring) &&
             childrenFineEnough(largest, largestContraction(ring)))
      levelsToGo_[v] = 1;
  }

  /// A thin patch is emitted at once, in closed form; no vertices of it come from later levels.
  void decideRegular(Index v, const Patch& patch) {
    levelsToGo_[v] = patchDepth(patch);
    const PatchPart part(patch, levelsToGo_[v]);
    if (!part.thin) return;
    emitRegular(part, number_, sink_);
    levelsToGo_[v] = kEmitted;
  }

  bool touchesStrip(const OneRing& ring) const {
    return strips_ && std::any_of(ring.corners.begin(), ring.corners.end(), [&](Index c) {
             const auto face = mesh_.face(faceOf(c));
             return std::any_of(face.begin(), face.end(), [&](Index v) { return onBoundary_[v]; });
           });
  }

  double largestContraction(const OneRing& ring) const {
    double largest = 0;
    for (const Index c : ring.corners)
      largest = std::max(largest, contraction(mesh_.faceSize(faceOf(c))));
    return largest;
  }

  int number_;  // of the level
  SurfaceSink& sink_;
  const SubdivisionLevel& level_;
  const PolygonMesh& mesh_;
  const Adjacency& adjacency_;
  bool strips_;
  std::vector<int> levelsToGo_;
  std::vector<Index> cornerAt_;  // lowest corner at each vertex
  std::vector<bool> onBoundary_;
};

/// Emits the vertices that need no further level.
/// @return for each point of the next level, the number of levels that it needs
std::vector<int> emitLevel(const SubdivisionLevel& level, const std::vector<int>& levelsToGo,
                           int number, SurfaceSink& sink) {
  std::vector<Vec3d> finished;
  for (Index v = 0; v < level.mesh.pointCount(); ++v)
    if (levelsToGo[v] == 0) finished.push_back(level.mesh.points[v]);
  if (!finished.empty()) sink.points(finished, number);
  std::vector<int> next(level.mesh.cornerCount());
  for (Index c = 0; c < level.mesh.cornerCount(); ++c) {
    const int parent = levelsToGo[level.mesh.faceVertices[c]];
    next[c] = parent > 0 ? parent - 1 : parent == 0 ? kEmitted : parent;
  }
  return next;
}

}  // namespace

void emitGlobally(SubdivisionLevel base, SurfaceSink& sink,
                  const std::function<void(const SubdivisionLevel&)>& requireRoom) {
  SubdivisionLevel level = std::move(base);
  std::vector<int> levelsToGo(nextPointCount(level), kUndecided);
  for (int number = 1;; ++number) {
    requireRoom(level);
    level = nextLevel(level, imageVertices(level));
    levelsToGo = Decisions(level, number, std::move(levelsToGo), sink).run();
    levelsToGo = emitLevel(level, levelsToGo, number, sink);
    if (std::all_of(levelsToGo.begin(), levelsToGo.end(), [](int n) { return n == kEmitted; }))
      return;
  }
}

}  // namespace vox
