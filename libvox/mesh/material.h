#pragma once

#include "libvox/core/color.h"
#include "libvox/core/types.h"

#include <memory>
#include <optional>
#include <string>

namespace vox {

/// An image on a surface, and how texture coordinates (u, v) lie on it. The image covers the unit
/// square; u goes right and v up, so v = 0 is the lower edge of the lowest row.
struct ImageMap {
  std::string file =
      {};  ///< path of the image; if it is inside of a mesh file: its name for messages
  std::shared_ptr<const std::string> content = {};  ///< of an image inside of a mesh file
  Vec2d scale = Vec2d::Ones();  ///< the point of the image is uv * scale + offset
  Vec2d offset = Vec2d::Zero();
  bool opaque = false;  ///< its alpha is not used
  bool clamp = false;   ///< outside of the unit square: its edge; false: it repeats
};

/// What faces look like.
struct Material {
  std::string name;
  Vec3f color = Vec3f::Constant(kPlainColor);  ///< linear, 0 to 1; for faces without the image
  std::optional<ImageMap> image = {};          ///< takes the place of the colour
  double opacity = 1;                          ///< 0 to 1
  /// Colour, colours of the mesh and image are multiplied; else the image replaces the others.
  bool multiplies = false;
};

}  // namespace vox
