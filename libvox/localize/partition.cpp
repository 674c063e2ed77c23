// Greedy cover by breadth-first search.

#include "libvox/localize/partition.h"

#include "libvox/core/parallel.h"

#include <algorithm>

namespace vox {
namespace {

constexpr Index kFacesPerBlock = 16384;

/// Cover of the faces [first, last).
class BlockCover {
 public:
  BlockCover(const PolygonMesh& mesh, const Adjacency& adjacency, Index first, Index last)
      : mesh_(mesh),
        adjacency_(adjacency),
        first_(first),
        last_(last),
        covered_(last - first, false) {}

  Partition run(Index most) {
    for (const bool onBoundary : {false, true})
      for (Index f = first_; f < last_; ++f)
        if (!covered_[f - first_] && hasBoundaryEdge(f) == onBoundary) gather(f, most);
    return std::move(cover_);
  }

 private:
  bool hasBoundaryEdge(Index f) const {
    const auto begin = adjacency_.twin.begin() + mesh_.faceOffsets[f];
    const auto end = adjacency_.twin.begin() + mesh_.faceOffsets[f + 1];
    return std::find(begin, end, kNone) != end;
  }

  void gather(Index centre, Index most) {
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
        if (g >= first_ && g < last_ && !covered_[g - first_]) add(g);
      }
    }
    const bool remains = 2 * (faces.size() - begin) < most && cover_.size() > 0 &&
                         faces.size() - cover_.offsets.end()[-2] <= std::size_t{2} * most;
    if (remains) cover_.offsets.pop_back();
    cover_.offsets.push_back(static_cast<Index>(faces.size()));
  }

  void add(Index f) {
    covered_[f - first_] = true;
    cover_.faces.push_back(f);
  }

  const PolygonMesh& mesh_;
  const Adjacency& adjacency_;
  Index first_;
  Index last_;
  std::vector<std::uint8_t> covered_;
  Partition cover_;
};

}  // namespace

Partition coverGreedily(const PolygonMesh& mesh, const Adjacency& adjacency, Index most) {
  const Index blocks = (mesh.faceCount() + kFacesPerBlock - 1) / kFacesPerBlock;
  std::vector<Partition> covers(blocks);
  forEach(blocks, 1, [&](Index b) {
    const Index first = b * kFacesPerBlock;
    const Index last = std::min(first + kFacesPerBlock, mesh.faceCount());
    covers[b] = BlockCover(mesh, adjacency, first, last).run(std::max<Index>(most, 1));
  });
  if (blocks == 1) return std::move(covers[0]);
  Partition all;
  all.faces.reserve(mesh.faceCount());
  for (const Partition& cover : covers) {
    const auto before = static_cast<Index>(all.faces.size());
    all.faces.insert(all.faces.end(), cover.faces.begin(), cover.faces.end());
    for (Index s = 0; s < cover.size(); ++s) all.offsets.push_back(before + cover.offsets[s + 1]);
  }
  return all;
}

}  // namespace vox
