#pragma once

#include "libvox/io/scene_file.h"
#include "libvox/mesh/shaded_mesh.h"
#include "libvox/options/preparation_options.h"
#include "libvox/options/run_options.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vox {

struct ShadedRefinement {
  ShadedScene scene;
  std::uint64_t vertexCount = 0;
  std::uint64_t triangleCount = 0;
  std::vector<std::string> warnings;  ///< one line each
};

/// The refined meshes that refine() makes, as triangles to look at. Vertices have the normals of
/// the limit surface (limitNormals), also across creases, where there is one for each side. Colours
/// and texture coordinates are those of the grid `color`: functions of the place on the input, so
/// the texture coordinates of a face never mix with those of others. If a seam crosses a refined
/// face, of material or of texture coordinates, the face belongs to one side, and its vertices
/// beyond have the texture coordinates of the seam. Solid textures become colours of vertices.
/// @throws as refine; InputError  the image of a texture cannot be read
ShadedRefinement shadedRefinement(const Scene& scene, int levels,
                                  const PreparationOptions& preparation, const RunOptions& run);

}  // namespace vox
