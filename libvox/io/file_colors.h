#pragma once

#include "libvox/core/types.h"

#include <vector>

namespace vox {

/// Collects the colours of points or faces while a file is read.
///
/// Files store sRGB values from 0 to 1 or from 0 to 255. The range is 0 to 255 if any value of the
/// file is above 1; so the colours can be converted only after the last one is read.
class FileColors {
 public:
  /// Sets the colour of an element, in the range of the file.
  void set(Index element, const Vec3d& values);

  /// Linear colours, 0 to 1, of `count` elements; white for an element whose colour was not set.
  /// Empty if no colour was set. Leaves this object empty.
  std::vector<Vec3f> takeLinear(Index count);

 private:
  std::vector<Vec3f> values_;
  std::vector<bool> isSet_;
  float largest_ = 0;
};

}  // namespace vox
