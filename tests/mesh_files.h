#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

/// Contents of mesh files, for tests of the readers.
namespace vox::test {

using Polygons = std::vector<std::vector<Index>>;

inline Polygons polygonsOf(const PolygonMesh& mesh) {
  Polygons polygons;
  for (Index f = 0; f < mesh.faceCount(); ++f)
    polygons.emplace_back(mesh.face(f).begin(), mesh.face(f).end());
  return polygons;
}

/// Appends the bytes of a number.
template <typename T>
void append(std::string& bytes, T number, std::endian order = std::endian::little) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &number, sizeof(T));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

inline const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";  // 3 lines of OBJ
inline const Polygons kOneTriangle = {{0, 1, 2}};

}  // namespace vox::test
