#pragma once

#include "libvox/core/types.h"
#include "libvox/mesh/material.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace vox {

/// Triangles of one material, with vertices of their own, as renderers want them.
struct ShadedPart {
  std::size_t material = 0;      ///< number in the scene
  std::vector<Vec3f> positions;  ///< relative to the origin of the object
  std::vector<Vec3f> normals;    ///< of length 1
  std::vector<Vec2f> texcoords;  ///< as ImageMap takes them, or empty
  std::vector<Vec3f> colors;     ///< linear, 0 to 1, or empty
  std::vector<std::array<Index, 3>> triangles;
};

struct ShadedObject {
  std::string name;
  Vec3d origin = Vec3d::Zero();  ///< world units
  std::vector<ShadedPart> parts = {};
};

/// Objects as triangles, and their materials. Colour of a material, of vertices and image are
/// multiplied, whatever Material::multiplies says. An image has its content, and lies on texture
/// coordinates as they are: `scale` and `offset` are done.
struct ShadedScene {
  std::vector<Material> materials;
  std::vector<ShadedObject> objects;
};

}  // namespace vox
