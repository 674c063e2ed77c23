// A canonical form of each cycle of vertices, so that results do not depend on the first corner of
// a face or its winding.

#include "libvox/prepare/face_order.h"

#include "libvox/core/numbered.h"
#include "libvox/core/parallel.h"

#include <algorithm>

namespace vox {

void startAtLowest(std::span<Index> face) {
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
}

bool canonicalize(std::span<Index> face) {
  startAtLowest(face);
  const bool reversed = face.back() < face[1];
  if (reversed) std::reverse(face.begin() + 1, face.end());
  return reversed;
}

void startFacesAtLowest(PolygonMesh& mesh) {
  parallelForEach(mesh.faceCount(), kElementsPerTask, [&](Index f) {
    startAtLowest({mesh.faceVertices.data() + mesh.faceOffsets[f], mesh.faceSize(f)});
  });
}

std::vector<std::uint8_t> canonicalizeFaces(PolygonMesh& mesh) {
  std::vector<std::uint8_t> reversed(mesh.faceCount());
  parallelForEach(mesh.faceCount(), kElementsPerTask, [&](Index f) {
    reversed[f] = canonicalize({mesh.faceVertices.data() + mesh.faceOffsets[f], mesh.faceSize(f)});
  });
  return reversed;
}

std::vector<Index> firstAlike(const PolygonMesh& mesh) {
  PolygonMesh canonical;
  canonical.faceOffsets = mesh.faceOffsets;
  canonical.faceVertices = mesh.faceVertices;
  canonicalizeFaces(canonical);
  std::vector<Index> order = numbered(mesh.faceCount());
  parallelSort(order, [&](Index f, Index g) {
    const auto a = canonical.face(f);
    const auto b = canonical.face(g);
    if (a.size() != b.size()) return a.size() < b.size();
    const auto [x, y] = std::mismatch(a.begin(), a.end(), b.begin());
    return x == a.end() ? f < g : *x < *y;
  });

  std::vector<Index> first = numbered(mesh.faceCount());
  for (std::size_t k = 1; k < order.size(); ++k) {
    const auto a = canonical.face(order[k - 1]);
    const auto b = canonical.face(order[k]);
    if (std::equal(a.begin(), a.end(), b.begin(), b.end())) first[order[k]] = first[order[k - 1]];
  }
  return first;
}

}  // namespace vox
