#pragma once

#include "libvox/core/types.h"

#include <vector>

namespace vox {

/// Colours of points or faces as a text has them, until all are read.
///
/// Files store what a screen shows, from 0 to 1 or from 0 to 255; it is the latter if any number
/// of the file is above 1. Alpha is not kept.
class FileColors {
 public:
  /// Colour of an element; those left out are white.
  void set(Index element, const Vec3d& values);

  /// Linear colours of `count` elements, or none if none was set.
  std::vector<Vec3f> takeLinear(Index count);

 private:
  std::vector<Vec3f> values_;
  std::vector<bool> isSet_;
  float largest_ = 0;
};

}  // namespace vox
