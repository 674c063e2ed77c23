#pragma once

#include "libvox/core/types.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vox {

/// Kinds of textures: patterns in space (volume/texture.h), and images (volume/image_texture.h).
enum class TextureKind { kChecker, kStripes, kRings, kMarble, kNoise, kGradient, kBrick, kImage };

/// Parameters of a texture. Lengths are in units of the texture's space.
struct TextureSpec {
  TextureKind kind = TextureKind::kChecker;
  bool inWorld = false;            ///< its space: the world; false: the object, so that it moves
                                   ///< with the object
  std::optional<double> scale;     ///< size of a cell, band, ring, vein, blob or brick, > 0;
                                   ///< nothing: an eighth of the object's longest side
  Vec3d axis = Vec3d::UnitZ();     ///< normal of stripes and veins, direction of a gradient, centre
                                   ///< line of rings; not 0
  double turbulence = 0;           ///< displacement of the pattern by noise, in scales, 0 to 100
  int octaves = 1;                 ///< of noise, each half as large as the one before, 1 to 16
  std::uint32_t seed = 0;          ///< selects the noise
  std::optional<double> from, to;  ///< begin and end of a gradient along the axis; nothing: the
                                   ///< ends of the object
  double mortar = 0;               ///< thickness of the joints in heights of a brick, 0 to 1
  std::vector<Vec3d> colors;       ///< kLeastColors to kMostColors, linear, 0 to 1; none: an image
  std::string file;                ///< of an image
  bool clamp = false;              ///< an image ends at its rim; false: it repeats

  bool operator==(const TextureSpec&) const = default;
};

inline constexpr std::size_t kLeastColors = 2;
inline constexpr std::size_t kMostColors = 16;

/// Names of all kinds, as messages list them: "checker, stripes, ...".
std::string allTextureNames();

/// The texture of a kind with its default parameters.
/// @param name  of the kind, such as "marble"
/// @throws UsageError  the name is unknown; the message lists the known ones
TextureSpec textureNamed(std::string_view name);

/// Sets one parameter, given as in scenes and on the command line.
/// @param key    name of the parameter, such as "scale"
/// @param value  a number; "object" or "world"; an axis x, y, z or X:Y:Z; colours R:G:B (linear, 0
///   to 1) or #rrggbb (sRGB) with / between them; "repeat" or "clamp"
/// @throws UsageError  the kind has no such parameter, or the value is wrong
void setTexture(TextureSpec& texture, std::string_view key, std::string_view value);

/// @throws UsageError  an image has no file
void requireComplete(const TextureSpec& texture);

/// The texture of a text KIND or KIND:key=value,key=value, such as "marble:scale=0.2,seed=3".
/// @throws UsageError  as textureNamed, setTexture and requireComplete, or a parameter is given
/// twice
TextureSpec parseTexture(std::string_view text);

/// Text from which parseTexture makes the same texture.
std::string textureText(const TextureSpec& texture);

}  // namespace vox
