// Doo-Sabin subdivision of the whole mesh down to the voxel, then rounding; on one thread, as one
// would write it from a textbook in an afternoon. Edges are found by a hash table. Boundaries
// shrink.

#include "apps/bench/peers/peer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_map>
#include <vector>

namespace {

using vox::Index;
using vox::kNone;
using vox::PolygonMesh;
using vox::Vec3d;

/// For each corner of a mesh: the next and the previous corner in its face, and the twin across its
/// edge.
struct Corners {
  std::vector<Index> next;
  std::vector<Index> previous;
  std::vector<Index> twin;
};

std::uint64_t edgeKey(Index from, Index to) {
  return std::uint64_t{from} << 32 | to;
}

Corners cornersOf(const PolygonMesh& mesh) {
  const std::size_t count = mesh.cornerCount();
  Corners corners;
  corners.next.resize(count);
  corners.previous.resize(count);
  corners.twin.assign(count, kNone);
  std::unordered_map<std::uint64_t, Index> cornerOfEdge;
  cornerOfEdge.reserve(count);
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Index first = mesh.faceOffsets[f];
    const Index n = mesh.faceSize(f);
    for (Index i = 0; i < n; ++i) {
      const Index c = first + i;
      corners.next[c] = first + (i + 1) % n;
      corners.previous[corners.next[c]] = c;
      cornerOfEdge[edgeKey(mesh.faceVertices[c], mesh.faceVertices[corners.next[c]])] = c;
    }
  }
  for (Index c = 0; c < count; ++c) {
    const auto found =
        cornerOfEdge.find(edgeKey(mesh.faceVertices[corners.next[c]], mesh.faceVertices[c]));
    if (found != cornerOfEdge.end()) corners.twin[c] = found->second;
  }
  return corners;
}

/// Weights of the corners of an n-gon in the image vertex of its corner 0.
std::vector<double> weightsOf(Index n) {
  std::vector<double> weights(n);
  weights[0] = (n + 5.0) / (4.0 * n);
  for (Index j = 1; j < n; ++j)
    weights[j] = (3 + 2 * std::cos(2 * std::numbers::pi * j / n)) / (4.0 * n);
  return weights;
}

/// One image vertex per corner, in corner order.
std::vector<Vec3d> imageVertices(const PolygonMesh& mesh) {
  std::vector<Vec3d> image;
  image.reserve(mesh.cornerCount());
  std::vector<double> weights;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    const Index n = mesh.faceSize(f);
    if (weights.size() != n) weights = weightsOf(n);
    for (Index i = 0; i < n; ++i) {
      Vec3d sum = Vec3d::Zero();
      for (Index j = 0; j < n; ++j) sum += weights[j] * mesh.points[face[(i + j) % n]];
      image.push_back(sum);
    }
  }
  return image;
}

/// Adds the V-faces: the corners around each point that is not on the boundary.
void addVertexFaces(const Corners& corners, PolygonMesh& next) {
  std::vector<bool> seen(corners.next.size());
  std::vector<Index> face;
  for (Index start = 0; start < seen.size(); ++start) {
    if (seen[start]) continue;
    face.clear();
    Index c = start;
    do {
      seen[c] = true;
      face.push_back(c);
      c = corners.twin[corners.previous[c]];
    } while (c != kNone && !seen[c]);
    if (c == start && face.size() > 2) next.addFace(face);
  }
}

PolygonMesh dooSabin(const PolygonMesh& mesh) {
  const Corners corners = cornersOf(mesh);
  PolygonMesh next;
  next.points = imageVertices(mesh);
  const std::size_t faces = mesh.faceCount() + mesh.cornerCount() / 2 + mesh.points.size();
  next.faceOffsets.reserve(faces + 1);
  next.faceVertices.reserve(4 * std::size_t{mesh.cornerCount()});
  for (Index c = 0; c < mesh.cornerCount(); ++c) next.faceVertices.push_back(c);  // F-faces
  next.faceOffsets = mesh.faceOffsets;
  for (Index c = 0; c < mesh.cornerCount(); ++c) {
    const Index t = corners.twin[c];
    if (t != kNone && c < t)
      next.addFace(std::vector<Index>{corners.next[c], c, corners.next[t], t});
  }
  addVertexFaces(corners, next);
  return next;
}

double largestSpan(const PolygonMesh& mesh) {
  double largest = 0;
  std::vector<Vec3d> corners;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    corners.clear();
    for (const Index v : mesh.face(f)) corners.push_back(mesh.points[v]);
    largest = std::max(largest, vox::peer::spanOf(corners));
  }
  return largest;
}

openvdb::GridBase::Ptr voxelize(const PolygonMesh& meshIndex, double span) {
  PolygonMesh mesh = dooSabin(meshIndex);
  while (largestSpan(mesh) > span) mesh = dooSabin(mesh);
  const auto mask = vox::peer::newMask();
  auto voxels = mask->getAccessor();
  for (const Vec3d& p : mesh.points) voxels.setValueOn(vox::peer::voxelOf(p.x(), p.y(), p.z()));
  return mask;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Doo-Sabin on one thread, down to the voxel, and rounding.", "vox_peer_naive");
  return vox::peer::run(argc, argv, app, voxelize);
}
