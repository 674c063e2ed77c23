// Greedy cover: submeshes grow by breadth-first search.

#include "libvox/localize/partition.h"

#include "libvox/core/origins.h"
#include "libvox/core/parallel.h"
#include "libvox/mesh/spatial_order.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace vox {
namespace {

constexpr Index kFacesPerBlock = 16384;

/// About so many submeshes may share the faces around one vertex or face, so that several threads
/// share their work, too.
constexpr Index kSubmeshesPerNeighbourhood = 8;

/// An order of the faces, and the place of each face in it.
struct FaceOrder {
  Origins faces;
  Origins places;
};

FaceOrder inputOrder(Index count) {
  return {Origins(count), Origins(count)};
}

/// Order of the faces by the positions of their first corners.
FaceOrder orderInSpace(const PolygonMesh& mesh) {
  std::vector<Vec3d> firstCorners(mesh.faceCount());
  parallelForEach(mesh.faceCount(), kFacesPerBlock, [&](Index f) {
    firstCorners[f] = mesh.points[mesh.faceVertices[mesh.faceOffsets[f]]];
  });
  std::vector<Index> faces = spatialOrder(firstCorners);
  std::vector<Index> places(faces.size());
  for (Index place = 0; place < faces.size(); ++place) places[faces[place]] = place;
  return {std::move(faces), std::move(places)};
}

/// Cover of the faces at the places [first, last) of an order.
class BlockCover {
 public:
  BlockCover(const PolygonMesh& mesh, const Adjacency& adjacency, const FaceOrder& order,
             std::span<const std::uint8_t> leftOut, Index first, Index last)
      : mesh_(mesh),
        adjacency_(adjacency),
        order_(order),
        first_(first),
        last_(last),
        covered_(last - first, false) {
    if (leftOut.empty()) return;
    for (Index place = first; place < last; ++place)
      covered_[place - first] = leftOut[order.faces[place]];
  }

  Partition run(Index most) {
    for (const bool onBoundary : {false, true})
      for (Index place = first_; place < last_; ++place)
        if (!covered_[place - first_] && hasBoundaryEdge(order_.faces[place]) == onBoundary)
          gather(order_.faces[place], most);
    return std::move(cover_);
  }

  /// Number of centres around which faces were gathered: one for each submesh and for each
  /// remainder that was added to the submesh before.
  std::size_t centres() const { return centres_; }

 private:
  bool hasBoundaryEdge(Index f) const {
    const auto begin = adjacency_.twin.begin() + mesh_.faceOffsets[f];
    const auto end = adjacency_.twin.begin() + mesh_.faceOffsets[f + 1];
    return std::find(begin, end, kNone) != end;
  }

  void gather(Index centre, Index most) {
    ++centres_;
    auto& faces = cover_.faces;
    const std::size_t begin = faces.size();
    add(centre);
    for (std::size_t k = begin; k < faces.size() && faces.size() - begin < most; ++k) {
      const Index f = faces[k];
      for (Index c = mesh_.faceOffsets[f]; c < mesh_.faceOffsets[f + 1]; ++c) {
        if (faces.size() - begin == most) break;
        const Index t = adjacency_.twin[c];
        if (t == kNone) continue;
        const Index g = adjacency_.cornerFace[t];
        const Index place = order_.places[g];
        if (place >= first_ && place < last_ && !covered_[place - first_]) add(g);
      }
    }
    const bool remains = 2 * (faces.size() - begin) < most && cover_.size() > 0 &&
                         faces.size() - cover_.offsets.end()[-2] <= std::size_t{2} * most;
    if (remains) cover_.offsets.pop_back();
    cover_.offsets.push_back(static_cast<Index>(faces.size()));
  }

  void add(Index f) {
    covered_[order_.places[f] - first_] = true;
    cover_.faces.push_back(f);
  }

  const PolygonMesh& mesh_;
  const Adjacency& adjacency_;
  const FaceOrder& order_;
  Index first_;
  Index last_;
  std::vector<std::uint8_t> covered_;
  std::size_t centres_ = 0;
  Partition cover_;
};

struct Cover {
  Partition partition;
  std::size_t centres = 0;
};

Cover coverInOrder(const PolygonMesh& mesh, const Adjacency& adjacency, const FaceOrder& order,
                   Index most, std::span<const std::uint8_t> leftOut) {
  const Index facesPerBlock = std::max(kFacesPerBlock, most);
  const Index faces = mesh.faceCount();
  const Index blocks = faces / facesPerBlock + (faces % facesPerBlock == 0 ? 0 : 1);
  std::vector<Cover> covers(blocks);
  parallelForEach(blocks, 1, [&](Index b) {
    const Index first = b * facesPerBlock;
    const Index last = first + std::min(facesPerBlock, faces - first);
    BlockCover block(mesh, adjacency, order, leftOut, first, last);
    covers[b].partition = block.run(most);
    covers[b].centres = block.centres();
  });
  if (blocks == 1) return std::move(covers[0]);
  Cover all;
  Partition& partition = all.partition;
  partition.faces.reserve(mesh.faceCount());
  for (const auto& [part, centres] : covers) {
    const auto before = static_cast<Index>(partition.faces.size());
    partition.faces.insert(partition.faces.end(), part.faces.begin(), part.faces.end());
    for (Index s = 0; s < part.size(); ++s)
      partition.offsets.push_back(before + part.offsets[s + 1]);
    all.centres += centres;
  }
  return all;
}

}  // namespace

Index largestNeighbourhood(const PolygonMesh& mesh) {
  std::vector<Index> valences(mesh.pointCount(), 0);
  for (const Index v : mesh.faceVertices) ++valences[v];
  Index largest = valences.empty() ? 0 : *std::max_element(valences.begin(), valences.end());
  for (Index f = 0; f < mesh.faceCount(); ++f) largest = std::max(largest, mesh.faceSize(f));
  return largest;
}

Partition coverGreedily(const PolygonMesh& mesh, const Adjacency& adjacency, Index most,
                        std::span<const std::uint8_t> leftOut) {
  const Index faces = mesh.faceCount();
  most = std::max<Index>(most, 1);
  if (faces / kSubmeshesPerNeighbourhood > most)
    most = std::max(most, largestNeighbourhood(mesh) / kSubmeshesPerNeighbourhood);
  Cover cover = coverInOrder(mesh, adjacency, inputOrder(faces), most, leftOut);
  constexpr std::size_t kScattered = 4;
  const bool scattered = faces > kFacesPerBlock && cover.centres > kScattered * (faces / most + 1);
  if (scattered) cover = coverInOrder(mesh, adjacency, orderInSpace(mesh), most, leftOut);
  return std::move(cover.partition);
}

}  // namespace vox
