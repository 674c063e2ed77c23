// The guarantees of the readers for any input. The program aborts if one is broken.
#pragma once

#include "libvox/core/error.h"
#include "libvox/io/read_mesh.h"
#include "libvox/mesh/polygon_mesh.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace vox::fuzz {

inline void require(bool kept, const char* law) {
  if (kept) return;
  std::fprintf(stderr, "broken: %s\n", law);
  std::abort();
}

/// Checks the guarantees of read_mesh.h.
inline void requireSoundMesh(const PolygonMesh& mesh) {
  require(mesh.faceCount() > 0, "a mesh has at least one face");
  require(mesh.faceOffsets.front() == 0 && mesh.faceOffsets.back() == mesh.faceVertices.size(),
          "the offsets span the corners");
  for (Index f = 0; f < mesh.faceCount(); ++f)
    require(mesh.faceOffsets[f] + 3 <= mesh.faceOffsets[f + 1], "a face has at least 3 corners");
  for (const Index v : mesh.faceVertices) require(v < mesh.pointCount(), "every index is in range");
  for (const Vec3d& point : mesh.points)
    require(point.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= kMaxCoordinate,
            "coordinates are finite and within kMaxCoordinate");
}

/// Checks that a message is one printable line that starts with the name of the file.
inline void requireClearRefusal(const InputError& error, std::string_view file) {
  const std::string_view message = error.what();
  require(message.starts_with(file) && message.substr(file.size()).starts_with(":"),
          "a refusal names the file");
  require(std::none_of(message.begin(), message.end(),
                       [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }),
          "a refusal is one line");
}

}  // namespace vox::fuzz
