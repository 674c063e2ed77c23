#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vox {

/// An OM file cut down to the mesh: header, vertex positions, connectivity, face status.
struct OmMesh {
  std::string bytes;
  std::uint32_t vertexCount;
  std::uint32_t faceCount;
};

/// Checks the chunks of an OM file (versions up to 2.2) against the size of the file, and drops
/// chunks that are not part of the mesh. The result is safe for OpenMesh's reader, which trusts its
/// input: it allocates the sizes that a file states, aborts on chunks of wrong dimension, and reads
/// past the end of a file. Indices are not checked.
///
/// @throws InputError  the file is truncated, damaged, too new, or no OM file
OmMesh omMeshOnly(std::string_view data, const std::string& fileName);

}  // namespace vox
