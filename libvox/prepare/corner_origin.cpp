// From corners of a prepared mesh back to those of the input.

#include "libvox/prepare/corner_origin.h"

#include "libvox/core/parallel.h"

#include <algorithm>
#include <limits>

namespace vox {
namespace {

class OriginFinder {
 public:
  OriginFinder(const PolygonMesh& input, const PolygonMesh& mesh, const InputElements& origin)
      : input_(input), mesh_(mesh), origin_(origin) {}

  /// @param f  face of the prepared mesh
  /// @param i  number of a corner in it
  EdgePlace of(Index f, Index i) const {
    const Index from = origin_.faces[f];
    const Index first = input_.faceOffsets[from];
    const Index n = input_.faceSize(from);
    const Index size = mesh_.faceSize(f);
    const Index here = vertexAt(f, i);
    const Index before = vertexAt(f, (i + size - 1) % size);
    const Index after = vertexAt(f, (i + 1) % size);
    Index best = kNone;
    int most = -1;
    for (Index k = 0; k < n && here != kNone; ++k) {
      if (weldedAt(first + k) != here) continue;
      const Index previous = weldedAt(first + (k + n - 1) % n);
      const Index next = weldedAt(first + (k + 1) % n);
      const int same = std::max((previous == before) + (next == after),  // the face may be turned
                                (previous == after) + (next == before));
      if (same <= most) continue;
      most = same;
      best = first + k;
    }
    if (best != kNone) return {best, 0};
    return nearest(from, mesh_.points[mesh_.faceVertices[mesh_.faceOffsets[f] + i]]);
  }

 private:
  Index weldedAt(Index inputCorner) const {
    return origin_.weldedTo[input_.faceVertices[inputCorner]];
  }
  Index vertexAt(Index f, Index i) const {
    return origin_.points[mesh_.faceVertices[mesh_.faceOffsets[f] + i]];
  }

  EdgePlace nearest(Index face, const Vec3d& point) const {
    EdgePlace best{input_.faceOffsets[face], 0};
    double least = std::numeric_limits<double>::infinity();
    const Index n = input_.faceSize(face);
    for (Index k = 0; k < n; ++k) {
      const Index corner = input_.faceOffsets[face] + k;
      const Vec3d& a = input_.points[input_.faceVertices[corner]];
      const Vec3d edge =
          input_.points[input_.faceVertices[input_.faceOffsets[face] + (k + 1) % n]] - a;
      const double length2 = edge.squaredNorm();
      const double along = length2 > 0 ? std::clamp(edge.dot(point - a) / length2, 0.0, 1.0) : 0.0;
      const double distance2 = (a + along * edge - point).squaredNorm();
      if (!(distance2 < least)) continue;
      least = distance2;
      best = {corner, along};
    }
    return best;
  }

  const PolygonMesh& input_;
  const PolygonMesh& mesh_;
  const InputElements& origin_;
};

}  // namespace

std::vector<EdgePlace> cornerOrigins(const PolygonMesh& input, const PolygonMesh& mesh,
                                     const InputElements& origin) {
  constexpr Index kFacesPerTask = 1024;
  const OriginFinder finder(input, mesh, origin);
  std::vector<EdgePlace> places(mesh.cornerCount());
  parallelForEach(mesh.faceCount(), kFacesPerTask, [&](Index f) {
    for (Index i = 0; i < mesh.faceSize(f); ++i) places[mesh.faceOffsets[f] + i] = finder.of(f, i);
  });
  return places;
}

std::vector<Vec2f> followedTexcoords(const PolygonMesh& input, const PolygonMesh& mesh,
                                     const InputElements& origin) {
  const std::vector<Vec2f>& all = input.attributes.texcoords;
  std::vector<Vec2f> followed;
  if (all.empty()) return followed;
  const std::vector<EdgePlace> places = cornerOrigins(input, mesh, origin);
  followed.reserve(places.size());
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Index from = origin.faces[f];
    for (Index c = mesh.faceOffsets[f]; c < mesh.faceOffsets[f + 1]; ++c) {
      const auto& [corner, along] = places[c];
      const Index next =
          corner + 1 == input.faceOffsets[from + 1] ? input.faceOffsets[from] : corner + 1;
      const auto t = static_cast<float>(along);
      followed.emplace_back(t > 0 ? Vec2f((1 - t) * all[corner] + t * all[next]) : all[corner]);
    }
  }
  return followed;
}

}  // namespace vox
