#pragma once

#include "libvox/core/types.h"
#include "libvox/grid/transform.h"
#include "libvox/options/texture_spec.h"

namespace vox {

/// A solid texture that can be evaluated.
///
/// checker: cells; stripes: bands across the axis; rings: wood around the axis; marble: veins
/// across the axis; noise: blobs; gradient: from one end to the other along the axis; brick:
/// courses stacked along z, mortar in the last colour. Noise displaces stripes, rings and veins.
/// The same bits on every processor that conforms to IEEE 754.
class SolidTexture {
 public:
  /// @param extent  box of the object in the texture's space, for the defaults of `spec`
  SolidTexture(const TextureSpec& spec, const Box& extent);

  /// Linear colour at a position in the texture's space. Thread-safe.
  Vec3d colorAt(const Vec3d& place) const;

 private:
  double displacement(const Vec3d& p) const;
  Vec3d ringColor(const Vec3d& p) const;
  Vec3d brickColor(const Vec3d& p) const;

  TextureSpec spec_;
  Vec3d axis_;  // unit
  double scale_;
  double from_;
  double to_;
};

}  // namespace vox
