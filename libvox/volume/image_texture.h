#pragma once

#include "libvox/core/image.h"
#include "libvox/core/types.h"
#include "libvox/mesh/material.h"

#include <memory>

namespace vox {

/// An image that can be evaluated at texture coordinates. A *texel* is a pixel of the image; the
/// centre of that in column i and row j is at u = (i + 1/2) / width, v = 1 - (j + 1/2) / height.
/// Between centres the texels are interpolated bilinearly, in linear light. Colours count by their
/// coverage, so transparent texels do not shine into their neighbours; where all are transparent,
/// they count alike. The image keeps its 8 bits. Thread-safe.
class ImageTexture {
 public:
  /// @param image  at least one pixel
  /// @param map    how texture coordinates lie on the image; its `file` is not used
  explicit ImageTexture(std::shared_ptr<const Image> image, ImageMap map = {});

  /// Linear colour (not multiplied by coverage) and coverage, 0 to 1. A coordinate that is not
  /// finite counts as 0.
  Vec4f at(const Vec2d& uv) const;

  /// Size, in texels, of a part of the surface: the longer one of two sides of a parallelogram.
  /// @param alongA, alongB  the sides in texture coordinates
  double texelsAcross(const Vec2d& alongA, const Vec2d& alongB) const;

  /// Samples along each side that a mean over a part needs: 1 for at most a texel, and at most
  /// kMostSamples. Images so fine that this is not enough are noise, and few samples do.
  static int samplesAcross(double texels);
  static constexpr int kMostSamples = 64;
  static constexpr int kSamplesOfNoise = 16;

  /// Mean over a part of the surface, of n x n samples at the centres of equal parts.
  /// @param uvOf  the texture coordinates of a sample, as Vec2d(double a, double b), from its place
  ///   between the sides of the part, 0 < a, b < 1
  template <class UvOf>
  Vec4f mean(int n, UvOf&& uvOf) const {
    Sum sum;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) addSample(uvOf((i + 0.5) / n, (j + 0.5) / n), sum);
    return sum.mean();
  }

 private:
  struct Sum {
    Vec3f covered = Vec3f::Zero();  // colours times coverage
    Vec3f plain = Vec3f::Zero();    // colours
    float coverage = 0;
    float weight = 0;

    Vec4f mean() const;
  };

  void addSample(const Vec2d& uv, Sum& sum) const;
  void addTexel(int x, int y, double weight, Sum& sum) const;

  std::shared_ptr<const Image> image_;
  ImageMap map_;
};

}  // namespace vox
