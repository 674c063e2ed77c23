// Doo-Sabin subdivision of a whole mesh as loops over corners.
// D. Doo, M. Sabin, Behaviour of recursive division surfaces near extraordinary points, 1978;
// Cohen, Kaufman & Wang 1994, section 2.1.

#include "libvox/subdivide/doo_sabin.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/mesh/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>

namespace vox {
namespace {

constexpr Index kCornersPerTask = 4096;
constexpr Index kFacesPerTask = 1024;

/// Cosine and sine of 2 pi i / n. Through long double, so that the rounded value does not depend
/// on which of its double-precision kernels the C library picks for the processor.
struct UnitRoot {
  double cosine;
  double sine;
};
UnitRoot unitRoot(Index i, Index n) {
  const long double angle = 2 * std::numbers::pi_v<long double> * i / n;
  return {static_cast<double>(std::cos(angle)), static_cast<double>(std::sin(angle))};
}

std::vector<UnitRoot> unitRoots(Index n) {
  std::vector<UnitRoot> roots(n);
  for (Index i = 0; i < n; ++i) roots[i] = unitRoot(i, n);
  return roots;
}

/// Weights 9/16, 3/16, 1/16, 3/16: exact in binary, and the same bits for either winding.
void imageOfQuad(const PolygonMesh& mesh, Index begin, std::vector<Vec3d>& image) {
  std::array<const Vec3d*, 4> p;
  for (Index i = 0; i < 4; ++i) p[i] = &mesh.points[mesh.faceVertices[begin + i]];
  for (Index i = 0; i < 4; ++i)
    image[begin + i] =
        (9.0 * *p[i] + 3.0 * (*p[(i + 1) % 4] + *p[(i + 3) % 4]) + *p[(i + 2) % 4]) / 16.0;
}

/// With centroid m and first harmonic (A, B) of the face, in O(n):
/// U_i = V_i / 4 + 3/4 m + 1/(2n) (A cos t_i + B sin t_i),  t_i = 2 pi i / n.
void imageOfPolygon(const PolygonMesh& mesh, Index begin, std::span<const UnitRoot> roots,
                    std::vector<Vec3d>& image) {
  const auto n = static_cast<Index>(roots.size());
  const auto point = [&](Index i) -> const Vec3d& {
    return mesh.points[mesh.faceVertices[begin + i]];
  };
  Vec3d sum = Vec3d::Zero();
  Vec3d sumCosine = Vec3d::Zero();
  Vec3d sumSine = Vec3d::Zero();
  for (Index i = 0; i < n; ++i) {
    sum += point(i);
    sumCosine += roots[i].cosine * point(i);
    sumSine += roots[i].sine * point(i);
  }
  for (Index i = 0; i < n; ++i)
    image[begin + i] = 0.25 * point(i) + (0.75 / n) * sum +
                       (0.5 / n) * (roots[i].cosine * sumCosine + roots[i].sine * sumSine);
}

/// Where the children of the corners of one level stand in the next.
struct ChildLayout {
  Index edgeFaces = 0;            ///< number of E-faces
  Index vertexFaces = 0;          ///< number of V-faces
  std::vector<Index> edge;        ///< per edge leader: number of its E-face
  std::vector<Index> ring;        ///< per ring leader: number of its V-face, else kNone
  std::vector<Index> ringOffset;  ///< per V-face, + 1: first slot of the V-faces' corners
  std::vector<Index> ringSlot;    ///< per corner: its slot among the V-faces' corners, or kNone
};

std::vector<Index> ledRingSizes(const SubdivisionLevel& level) {
  std::vector<Index> sizes(level.mesh.cornerCount());
  forEach(level.mesh.cornerCount(), kCornersPerTask,
          [&](Index c) { sizes[c] = ledRingSize(level.mesh, level.adjacency, c); });
  return sizes;
}

void placeRingSlots(const SubdivisionLevel& level, ChildLayout& layout) {
  layout.ringSlot.assign(level.mesh.cornerCount(), kNone);
  forEach(level.mesh.cornerCount(), kCornersPerTask, [&](Index c) {
    if (layout.ring[c] == kNone) return;
    Index slot = layout.ringOffset[layout.ring[c]];
    Index k = c;
    do {
      layout.ringSlot[k] = slot++;
      k = nextAroundVertex(level.mesh, level.adjacency, k);
    } while (k != c);
  });
}

ChildLayout layOutChildren(const SubdivisionLevel& level) {
  ChildLayout layout;
  const Index corners = level.mesh.cornerCount();
  layout.edge.assign(corners, kNone);
  layout.ring = ledRingSizes(level);
  layout.ringOffset.push_back(0);
  for (Index c = 0; c < corners; ++c) {
    if (leadsEdge(level.adjacency, c)) layout.edge[c] = layout.edgeFaces++;
    const Index valence = layout.ring[c];
    layout.ring[c] = valence < 3 ? kNone : layout.vertexFaces++;
    if (valence >= 3) layout.ringOffset.push_back(layout.ringOffset.back() + valence);
  }
  placeRingSlots(level, layout);
  return layout;
}

/// Writes the faces of the next level and their twins; every corner owns its slots.
///
/// The E-face of the edge c = v->w with twin t = w->v is [next c, c, next t, t]; its edges face, in
/// this order, the F-face edge c, the V-face of v, the F-face edge t, the V-face of w. The V-face
/// edge that starts at corner x leads to y = nextAroundVertex(x) and faces the E-face that runs
/// from y to x.
class ChildTopology {
 public:
  ChildTopology(const SubdivisionLevel& level, const ChildLayout& layout, SubdivisionLevel& child)
      : mesh_(level.mesh),
        adjacency_(level.adjacency),
        layout_(layout),
        child_(child),
        firstEdgeCorner_(mesh_.cornerCount()),
        firstRingCorner_(firstEdgeCorner_ + 4 * layout.edgeFaces) {}

  void writeFaceOffsets() {
    auto& offsets = child_.mesh.faceOffsets;
    offsets.resize(std::size_t{mesh_.faceCount()} + layout_.edgeFaces + layout_.vertexFaces + 1);
    std::copy(mesh_.faceOffsets.begin(), mesh_.faceOffsets.end(), offsets.begin());
    for (Index e = 0; e < layout_.edgeFaces; ++e)
      offsets[mesh_.faceCount() + e] = firstEdgeCorner_ + 4 * e;
    for (Index v = 0; v <= layout_.vertexFaces; ++v)
      offsets[mesh_.faceCount() + layout_.edgeFaces + v] = firstRingCorner_ + layout_.ringOffset[v];
  }

  void writeFaceCorner(Index c) {
    const Index t = adjacency_.twin[c];
    Index twin = kNone;
    if (t != kNone) twin = c < t ? edgeCorner(c, 0) : edgeCorner(t, 2);
    set(c, c, adjacency_.cornerFace[c], twin);
  }

  void writeEdgeFace(Index c) {
    const Index t = adjacency_.twin[c];
    const Index nextC = nextCorner(mesh_, adjacency_, c);
    const Index nextT = nextCorner(mesh_, adjacency_, t);
    const Index face = mesh_.faceCount() + layout_.edge[c];
    set(edgeCorner(c, 0), nextC, face, c);
    set(edgeCorner(c, 1), c, face, acrossVertex(nextT));
    set(edgeCorner(c, 2), nextT, face, t);
    set(edgeCorner(c, 3), t, face, acrossVertex(nextC));
  }

  void writeVertexFace(Index leader) {
    const Index face = mesh_.faceCount() + layout_.edgeFaces + layout_.ring[leader];
    Index x = leader;
    do {
      set(firstRingCorner_ + layout_.ringSlot[x], x, face, edgeFacing(x));
      x = nextAroundVertex(mesh_, adjacency_, x);
    } while (x != leader);
  }

 private:
  Index edgeCorner(Index leader, Index i) const {
    return firstEdgeCorner_ + 4 * layout_.edge[leader] + i;
  }

  /// E-face corner whose edge runs from y = nextAroundVertex(x) to x.
  Index edgeFacing(Index x) const {
    const Index y = nextAroundVertex(mesh_, adjacency_, x);
    return leadsEdge(adjacency_, y) ? edgeCorner(y, 1) : edgeCorner(adjacency_.twin[y], 3);
  }

  /// What the E-face edge into corner x faces across the vertex: the V-face, or at a vertex with
  /// two faces the other E-face, or nothing at the boundary.
  Index acrossVertex(Index x) const {
    if (layout_.ringSlot[x] != kNone) return firstRingCorner_ + layout_.ringSlot[x];
    const Index y = nextAroundVertex(mesh_, adjacency_, x);
    const bool valenceTwo = y != kNone && nextAroundVertex(mesh_, adjacency_, y) == x;
    return valenceTwo ? edgeFacing(y) : kNone;
  }

  void set(Index corner, Index point, Index face, Index twin) {
    child_.mesh.faceVertices[corner] = point;
    child_.adjacency.cornerFace[corner] = face;
    child_.adjacency.twin[corner] = twin;
  }

  const PolygonMesh& mesh_;
  const Adjacency& adjacency_;
  const ChildLayout& layout_;
  SubdivisionLevel& child_;
  Index firstEdgeCorner_;
  Index firstRingCorner_;
};

void requireFits(std::uint64_t corners) {
  if (corners >= kNone)
    throw LimitError("the next subdivision level would have " + std::to_string(corners) +
                     " corners, more than fit in 32 bits; use fewer levels or larger voxels");
}

}  // namespace

SubdivisionLevel baseLevel(PolygonMesh mesh) {
  requireValidArrays(mesh);
  SubdivisionLevel level{std::move(mesh), {}};
  level.adjacency = buildAdjacency(level.mesh);
  requireManifold(level.mesh, level.adjacency);
  return level;
}

std::vector<Vec3d> imageVertices(const PolygonMesh& mesh) {
  std::vector<Vec3d> image(mesh.cornerCount());
  forParts(mesh.faceCount(), kFacesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<UnitRoot> roots;
    for (Index f = static_cast<Index>(begin); f != end; ++f) {
      const Index n = mesh.faceSize(f);
      if (n == 4) {
        imageOfQuad(mesh, mesh.faceOffsets[f], image);
        continue;
      }
      if (roots.size() != n) roots = unitRoots(n);
      imageOfPolygon(mesh, mesh.faceOffsets[f], roots, image);
    }
  });
  return image;
}

Index ledRingSize(const PolygonMesh& mesh, const Adjacency& adjacency, Index c) {
  Index left = c;
  Index right = c;
  for (Index steps = 1;; ++steps) {
    left = nextAroundVertex(mesh, adjacency, left);
    if (left == kNone || left < c) return 0;
    if (left == c) return steps;
    right = previousAroundVertex(mesh, adjacency, right);
    if (right == kNone || right < c) return 0;
  }
}

std::uint64_t nextCornerCount(const SubdivisionLevel& level) {
  // Each interior edge has two corners and makes an E-face of four; each V-face corner is a corner
  // of a closed ring, so the corner count bounds their number.
  std::uint64_t interior = 0;
  for (const Index t : level.adjacency.twin) interior += t != kNone;
  return level.mesh.cornerCount() + 2 * interior + level.mesh.cornerCount();
}

SubdivisionLevel nextLevel(const SubdivisionLevel& level, std::vector<Vec3d> image) {
  requireFits(nextCornerCount(level));
  const ChildLayout layout = layOutChildren(level);
  const Index corners = level.mesh.cornerCount();
  const std::size_t childCorners =
      std::size_t{corners} + 4 * std::size_t{layout.edgeFaces} + layout.ringOffset.back();

  SubdivisionLevel child;
  child.mesh.points = std::move(image);
  child.mesh.faceVertices.resize(childCorners);
  child.adjacency.twin.resize(childCorners);
  child.adjacency.cornerFace.resize(childCorners);

  ChildTopology topology(level, layout, child);
  topology.writeFaceOffsets();
  forEach(corners, kCornersPerTask, [&](Index c) {
    topology.writeFaceCorner(c);
    if (layout.edge[c] != kNone) topology.writeEdgeFace(c);
    if (layout.ring[c] != kNone) topology.writeVertexFace(c);
  });
  return child;
}

SubdivisionLevel subdivide(SubdivisionLevel level, int levels) {
  for (int k = 0; k < levels; ++k) level = nextLevel(level, imageVertices(level.mesh));
  return level;
}

}  // namespace vox
