#pragma once

#include "libvox/core/types.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vox {

/// Patterns that fill space (volume/texture.h makes them).
enum class TextureKind { kChecker, kStripes, kRings, kMarble, kNoise, kGradient, kBrick };

/// A solid texture as it is asked for. Lengths are in units of the space it lives in.
struct TextureSpec {
  TextureKind kind = TextureKind::kChecker;
  bool inWorld = false;            ///< false: in the object's own space, so that it moves with it
  std::optional<double> scale;     ///< size of a cell, band, ring, vein, blob or brick, > 0;
                                   ///< nothing: an eighth of the object's longest side
  Vec3d axis = Vec3d::UnitZ();     ///< across stripes and veins, along gradients, of rings; not 0
  double turbulence = 0;           ///< how far noise displaces the pattern, in scales, 0 to 100
  int octaves = 1;                 ///< of noise, each half as large as the one before, 1 to 16
  std::uint32_t seed = 0;          ///< another number, another noise
  std::optional<double> from, to;  ///< where along the axis a gradient begins and ends; nothing: at
                                   ///< the ends of the object
  double mortar = 0;               ///< thickness in heights of a brick, 0 to 1
  std::vector<Vec3d> colors;       ///< kLeastColors to kMostColors, linear, 0 to 1

  bool operator==(const TextureSpec&) const = default;
};

inline constexpr std::size_t kLeastColors = 2;
inline constexpr std::size_t kMostColors = 16;

/// "checker, stripes, ...": for messages.
std::string allTextureNames();

/// The texture of that name as it is unless more is said.
/// @throws UsageError  an unknown name; the message has the known ones
TextureSpec textureNamed(std::string_view name);

/// Sets one parameter by its name in scenes and on the command line. Values: numbers; "object" or
/// "world"; an axis x, y, z or X:Y:Z; colours R:G:B (linear, 0 to 1) or #rrggbb (as on a screen)
/// with / between them.
/// @throws UsageError  an unknown parameter or one that the kind does not have, or a wrong value
void setTexture(TextureSpec& texture, std::string_view key, std::string_view value);

/// A texture from KIND or KIND:key=value,key=value: "marble:scale=0.2,seed=3".
/// @throws UsageError  as above, or a parameter is there twice
TextureSpec parseTexture(std::string_view text);

/// The text that parseTexture makes the same texture of.
std::string textureText(const TextureSpec& texture);

}  // namespace vox
