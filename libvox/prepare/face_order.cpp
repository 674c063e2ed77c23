// A canonical name for each cycle of vertices, so that nothing depends on how a file wrote it.

#include "libvox/prepare/face_order.h"

#include "libvox/core/parallel.h"

#include <algorithm>

namespace vox {
namespace {

constexpr Index kFacesPerTask = 2048;

}  // namespace

void startAtLowest(std::span<Index> face) {
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
}

bool canonicalize(std::span<Index> face) {
  startAtLowest(face);
  const bool reversed = face.back() < face[1];
  if (reversed) std::reverse(face.begin() + 1, face.end());
  return reversed;
}

std::vector<std::uint8_t> canonicalizeFaces(PolygonMesh& mesh) {
  std::vector<std::uint8_t> reversed(mesh.faceCount());
  forEach(mesh.faceCount(), kFacesPerTask, [&](Index f) {
    reversed[f] = canonicalize({mesh.faceVertices.data() + mesh.faceOffsets[f], mesh.faceSize(f)});
  });
  return reversed;
}

}  // namespace vox
