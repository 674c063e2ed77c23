// Colours of mesh files, from 0 to 1 or 0 to 255, as linear light.

#include "libvox/io/file_colors.h"

#include "libvox/core/color.h"

#include <algorithm>
#include <utility>

namespace vox {

void FileColors::set(Index element, const Vec3d& values) {
  if (element >= values_.size()) {
    values_.resize(std::size_t{element} + 1, Vec3f::Ones());
    isSet_.resize(values_.size(), false);
  }
  values_[element] = values.cast<float>();
  isSet_[element] = true;
  largest_ = std::max(largest_, values_[element].maxCoeff());
}

std::vector<Vec3f> FileColors::takeLinear(Index count) {
  if (values_.empty()) return {};
  constexpr float kBytes = 255;
  const float one = largest_ > 1 ? kBytes : 1;
  const auto linear = [&](float value) {
    const double share = value > 0 ? std::min(value / one, 1.0F) : 0.0F;  // nan becomes 0
    return static_cast<float>(linearFromScreen(share));
  };
  for (std::size_t k = 0; k < values_.size(); ++k)
    if (isSet_[k]) values_[k] = values_[k].unaryExpr(linear);
  values_.resize(count, Vec3f::Ones());
  return std::exchange(values_, {});
}

}  // namespace vox
