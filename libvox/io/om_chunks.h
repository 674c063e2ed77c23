#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vox {

/// An OM file without anything but the mesh: header, vertex positions, connectivity, face status.
struct OmMesh {
  std::string bytes;
  std::uint32_t vertexCount;
  std::uint32_t faceCount;
};

/// Checks the chunks of an OM file (versions up to 2.2) against its size and drops those that are
/// not part of the mesh. OpenMesh's reader can take the result: it allocates what a file claims,
/// asserts (aborts) on chunks of odd dimension, and reads past a file's end. Indices are unchecked.
///
/// @throws InputError  truncated, damaged, too new, or no OM file
OmMesh omMeshOnly(std::string_view data, const std::string& fileName);

}  // namespace vox
