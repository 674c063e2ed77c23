// The control mesh cut along its creases: copies of vertices, and edges without length at corners.

#include "libvox/prepare/crease.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace vox {
namespace {

bool endsSector(const Adjacency& adjacency, const SharpFeatures& sharp, Index c) {
  return adjacency.twin[c] == kNone || sharp.edges[c];
}

/// Numbers of sharp and of boundary edges at each vertex.
struct SharpDegrees {
  std::vector<Index> sharp;
  std::vector<Index> all;  ///< sharp and boundary ones
};

SharpDegrees sharpDegrees(const PolygonMesh& mesh, const Adjacency& adjacency,
                          const SharpFeatures& features) {
  SharpDegrees degrees{std::vector<Index>(mesh.pointCount(), 0),
                       std::vector<Index>(mesh.pointCount(), 0)};
  for (Index c = 0; c < mesh.cornerCount(); ++c) {
    const bool boundary = adjacency.twin[c] == kNone;
    const bool leads = boundary || c < adjacency.twin[c];
    if (!leads || !endsSector(adjacency, features, c)) continue;
    for (const Index end : {c, nextCorner(mesh, adjacency, c)}) {
      ++degrees.all[mesh.faceVertices[end]];
      if (!boundary) ++degrees.sharp[mesh.faceVertices[end]];
    }
  }
  return degrees;
}

/// The sharp edges with a dart at both ends, by the lower of their corners.
std::vector<Index> lonelyEdges(const PolygonMesh& mesh, const Adjacency& adjacency,
                               const SharpFeatures& sharp) {
  const std::vector<Index> degree = sharpDegrees(mesh, adjacency, sharp).all;
  const auto isDart = [&](Index v) { return degree[v] == 1 && !sharp.vertices[v]; };
  std::vector<Index> lonely;
  for (Index c = 0; c < mesh.cornerCount(); ++c)
    if (sharp.edges[c] && c < adjacency.twin[c] && isDart(mesh.faceVertices[c]) &&
        isDart(mesh.faceVertices[nextCorner(mesh, adjacency, c)]))
      lonely.push_back(c);
  return lonely;
}

/// Puts a vertex into the middle of some edges. Both halves of the edges are sharp.
void halveEdges(PolygonMesh& mesh, Adjacency& adjacency, SharpFeatures& sharp,
                std::span<const Index> edges) {
  std::vector<Index> middleOf(mesh.cornerCount(), kNone);
  for (const Index c : edges) {
    const Index a = mesh.faceVertices[c];
    const Index b = mesh.faceVertices[nextCorner(mesh, adjacency, c)];
    middleOf[c] = middleOf[adjacency.twin[c]] = mesh.pointCount();
    mesh.points.push_back((mesh.points[a] + mesh.points[b]) / 2.0);
    if (!mesh.pointColors.empty())
      mesh.pointColors.push_back((mesh.pointColors[a] + mesh.pointColors[b]) / 2.0F);
  }
  PolygonMesh halved{
      std::move(mesh.points), {0}, {}, std::move(mesh.pointColors), std::move(mesh.faceColors)};
  std::vector<bool> sharpEdges;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    for (Index c = mesh.faceOffsets[f]; c < mesh.faceOffsets[f + 1]; ++c) {
      halved.faceVertices.push_back(mesh.faceVertices[c]);
      sharpEdges.push_back(sharp.edges[c]);
      if (middleOf[c] == kNone) continue;
      halved.faceVertices.push_back(middleOf[c]);
      sharpEdges.push_back(true);
    }
    halved.faceOffsets.push_back(halved.cornerCount());
  }
  mesh = std::move(halved);
  adjacency = buildAdjacency(mesh);
  sharp.edges = std::move(sharpEdges);
  sharp.vertices.resize(mesh.pointCount(), false);
}

/// The copies of a vertex that a corner takes: `leaving` is the start of its own edge, `arriving`
/// the end of the edge before. They differ at corner vertices only.
struct Copies {
  Index arriving;
  Index leaving;
};

/// Gives the corners around cut vertices their copies.
class VertexCutter {
 public:
  VertexCutter(const PolygonMesh& mesh, const Adjacency& adjacency, const SharpFeatures& sharp)
      : mesh_(mesh),
        adjacency_(adjacency),
        sharp_(sharp),
        degrees_(sharpDegrees(mesh, adjacency, sharp)),
        origin_(mesh.pointCount()),
        copies_(mesh.cornerCount()) {
    std::iota(origin_.begin(), origin_.end(), Index{0});
    for (Index c = 0; c < mesh.cornerCount(); ++c)
      copies_[c] = {mesh.faceVertices[c], mesh.faceVertices[c]};
    std::vector<bool> done(mesh.pointCount(), false);
    for (Index c = 0; c < mesh.cornerCount(); ++c) {
      const Index v = mesh.faceVertices[c];
      if (!done[v]) cutVertex(c);
      done[v] = true;
    }
  }

  const std::vector<Copies>& copies() const { return copies_; }
  std::vector<Index> takeOrigin() { return std::move(origin_); }
  const CreaseCounts& counts() const { return counts_; }

 private:
  bool ends(Index c) const { return endsSector(adjacency_, sharp_, c); }

  void cutVertex(Index c) {
    const Index v = mesh_.faceVertices[c];
    const OneRing ring = oneRing(mesh_, adjacency_, c);
    // The two edges without length of a vertex between two faces would be one.
    const bool hasTwoFaces = ring.closed && ring.corners.size() == 2 && degrees_.all[v] == 0;
    const bool isCorner =
        !hasTwoFaces && (sharp_.vertices[v] || (degrees_.sharp[v] > 0 && degrees_.all[v] > 2));
    if (isCorner) ++counts_.cornerVertices;
    if (!isCorner && degrees_.all[v] == 1) ++counts_.darts;
    if (!isCorner && degrees_.sharp[v] < 2) return;

    const auto& corners = ring.corners;
    const auto first =
        std::find_if(corners.begin(), corners.end(), [&](Index k) { return ends(k); });
    std::vector<Index> turned(corners);
    if (first != corners.end())
      std::rotate(turned.begin(), turned.begin() + (first - corners.begin()), turned.end());
    bool keepsNumber = true;  // one of the copies is the vertex itself
    for (std::size_t begin = 0, end = 0; begin < turned.size(); begin = end) {
      for (end = begin + 1; end < turned.size() && !ends(turned[end]);) ++end;
      const std::span<const Index> sector(turned.data() + begin, end - begin);
      if (isCorner)
        pinSector(sector, first == corners.end(), keepsNumber);
      else
        copySector(sector, keepsNumber);
    }
  }

  Index newCopy(Index v, bool& keepsNumber) {
    if (std::exchange(keepsNumber, false)) return v;
    origin_.push_back(v);
    return static_cast<Index>(origin_.size() - 1);
  }

  void copySector(std::span<const Index> sector, bool& keepsNumber) {
    const Index copy = newCopy(mesh_.faceVertices[sector[0]], keepsNumber);
    for (const Index c : sector) copies_[c] = {copy, copy};
  }

  /// Counter-clockwise, each face leaves the vertex where the face before has arrived.
  /// @param closed  the sector is the whole ring, without any sharp edge
  void pinSector(std::span<const Index> sector, bool closed, bool& keepsNumber) {
    const Index v = mesh_.faceVertices[sector[0]];
    const Index start = newCopy(v, keepsNumber);
    Index leaving = start;
    for (std::size_t i = 0; i < sector.size(); ++i) {
      const bool last = closed && i + 1 == sector.size();
      const Index arriving = last ? start : newCopy(v, keepsNumber);
      copies_[sector[i]] = {arriving, leaving};
      leaving = arriving;
    }
  }

  const PolygonMesh& mesh_;
  const Adjacency& adjacency_;
  const SharpFeatures& sharp_;
  SharpDegrees degrees_;
  std::vector<Index> origin_;
  std::vector<Copies> copies_;
  CreaseCounts counts_;
};

/// The mesh whose corners have the given copies, with its seam.
CutMesh meshOfCopies(PolygonMesh mesh, const Adjacency& adjacency, const SharpFeatures& sharp,
                     VertexCutter& cutter) {
  CutMesh cut;
  cut.counts = cutter.counts();
  std::vector<Index> cornerOf(mesh.cornerCount());  // the corner of the same edge in the result
  PolygonMesh& result = cut.mesh;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    for (Index c = mesh.faceOffsets[f]; c < mesh.faceOffsets[f + 1]; ++c) {
      const auto [arriving, leaving] = cutter.copies()[c];
      if (arriving != leaving) {
        cut.seam.push_back(result.cornerCount());
        result.faceVertices.push_back(arriving);
      }
      cornerOf[c] = result.cornerCount();
      cut.seam.push_back(kNone);
      result.faceVertices.push_back(leaving);
    }
    result.faceOffsets.push_back(result.cornerCount());
  }
  for (Index c = 0; c < mesh.cornerCount(); ++c) {
    if (adjacency.twin[c] == kNone || !sharp.edges[c]) continue;
    cut.seam[cornerOf[c]] = cornerOf[adjacency.twin[c]];
    if (c < adjacency.twin[c]) ++cut.counts.sharpEdges;
  }
  cut.pointOrigin = cutter.takeOrigin();
  result.points = std::move(mesh.points);
  result.pointColors = std::move(mesh.pointColors);
  result.faceColors = std::move(mesh.faceColors);
  for (std::size_t v = result.points.size(); v < cut.pointOrigin.size(); ++v) {
    result.points.push_back(Vec3d(result.points[cut.pointOrigin[v]]));
    if (!result.pointColors.empty())
      result.pointColors.push_back(Vec3f(result.pointColors[cut.pointOrigin[v]]));
  }
  return cut;
}

}  // namespace

CutMesh cutCreases(PolygonMesh mesh, Adjacency adjacency, SharpFeatures sharp) {
  const std::vector<Index> lonely = lonelyEdges(mesh, adjacency, sharp);
  if (!lonely.empty()) halveEdges(mesh, adjacency, sharp, lonely);
  VertexCutter cutter(mesh, adjacency, sharp);
  const bool cuts = std::find(sharp.edges.begin(), sharp.edges.end(), true) != sharp.edges.end() ||
                    cutter.counts().cornerVertices > 0;
  CutMesh cut;
  if (cuts) {
    cut = meshOfCopies(std::move(mesh), adjacency, sharp, cutter);
  } else {
    cut.mesh = std::move(mesh);
    cut.pointOrigin = cutter.takeOrigin();
  }
  cut.counts.sharpEdges -= static_cast<Index>(lonely.size());  // each was halved
  return cut;
}

PolygonMesh joinedAlongCreases(const PolygonMesh& mesh, const Adjacency& adjacency) {
  std::vector<Index> boundary;
  for (Index c = 0; c < mesh.cornerCount(); ++c)
    if (adjacency.twin[c] == kNone) {
      boundary.push_back(mesh.faceVertices[c]);
      boundary.push_back(mesh.faceVertices[nextCorner(mesh, adjacency, c)]);
    }
  const auto before = [&](Index a, Index b) {
    const Vec3d& p = mesh.points[a];
    const Vec3d& q = mesh.points[b];
    if (p == q) return a < b;
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::sort(boundary.begin(), boundary.end(), before);
  boundary.erase(std::unique(boundary.begin(), boundary.end()), boundary.end());
  std::vector<Index> first(mesh.pointCount());  // the lowest vertex at the place of each
  std::iota(first.begin(), first.end(), Index{0});
  for (std::size_t i = 1; i < boundary.size(); ++i)
    if (mesh.points[boundary[i]] == mesh.points[boundary[i - 1]])
      first[boundary[i]] = first[boundary[i - 1]];

  PolygonMesh joined;
  std::vector<Index> number(mesh.pointCount(), kNone);
  for (Index v = 0; v < mesh.pointCount(); ++v) {
    if (first[v] != v) continue;
    number[v] = joined.pointCount();
    joined.points.push_back(mesh.points[v]);
    if (!mesh.pointColors.empty()) joined.pointColors.push_back(mesh.pointColors[v]);
  }
  std::vector<Index> face;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    face.clear();
    for (const Index v : mesh.face(f)) {
      const Index joint = number[first[v]];
      if (face.empty() || face.back() != joint) face.push_back(joint);
    }
    while (face.size() > 1 && face.front() == face.back()) face.pop_back();
    joined.addFace(face);
  }
  joined.faceColors = mesh.faceColors;
  return joined;
}

}  // namespace vox
