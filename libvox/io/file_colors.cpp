// Colours of mesh files, in the range of each file, as linear light.

#include "libvox/io/file_colors.h"

#include "libvox/core/color.h"
#include "libvox/core/parallel.h"

#include <algorithm>
#include <utility>

namespace vox {

namespace {

constexpr float kByteRange = 255;
constexpr float kWordRange = 65535;

}  // namespace

void FileColors::set(Index element, const Vec3d& values, std::size_t line) {
  if (element >= values_.size()) {
    values_.resize(std::size_t{element} + 1, Vec3f::Ones());
    isSet_.resize(values_.size(), false);
  }
  const Vec3f color = values.cast<float>();
  values_[element] = color;
  isSet_[element] = true;
  const float most = color.maxCoeff<Eigen::PropagateNumbers>();
  largest_ = std::max(largest_, most);
  for (Above* above : {&aboveOne_, &above255_}) {
    if (!(most > above->limit)) continue;
    if (above->values == 0) {
      above->line = line;
      above->element = element;
    }
    above->values += static_cast<std::uint64_t>((color.array() > above->limit).count());
  }
}

void FileColors::append(const FileColors& part, Index firstElement, std::size_t linesBefore) {
  largestOfType_ = std::max(largestOfType_, part.largestOfType_);
  if (part.empty()) return;
  values_.resize(firstElement, Vec3f::Ones());
  isSet_.resize(firstElement, false);
  values_.insert(values_.end(), part.values_.begin(), part.values_.end());
  isSet_.insert(isSet_.end(), part.isSet_.begin(), part.isSet_.end());
  largest_ = std::max(largest_, part.largest_);
  const auto add = [&](Above& above, const Above& other) {
    if (above.values == 0 && other.values > 0) {
      above.line = other.line == 0 ? 0 : other.line + linesBefore;
      above.element = other.element + firstElement;
    }
    above.values += other.values;
  };
  add(aboveOne_, part.aboveOne_);
  add(above255_, part.above255_);
}

float FileColors::fullBrightness() const {
  if (largestOfType_ == 0) return largest_ < 2 ? 1 : kByteRange;
  if (largest_ <= kByteRange) return kByteRange;
  return largest_ <= kWordRange ? std::min(kWordRange, static_cast<float>(largestOfType_))
                                : static_cast<float>(largestOfType_);
}

std::vector<Vec3f> FileColors::takeLinear(Index count, ReadReport& report) {
  if (values_.empty()) return {};
  const float one = fullBrightness();
  if (const Above& above = one == 1 ? aboveOne_ : above255_;
      largestOfType_ == 0 && above.values > 0)
    report.add(Oddity::kBrightColor, above.line, above.element, above.values);
  const auto linear = [&](float value) {
    const double share = value > 0 ? std::min(value / one, 1.0F) : 0.0F;  // nan becomes 0
    return static_cast<float>(linearFromScreen(share));
  };
  constexpr std::size_t kColorsPerTask = 1 << 12;
  parallelForEach(values_.size(), kColorsPerTask, [&](std::size_t k) {
    if (isSet_[k]) values_[k] = values_[k].unaryExpr(linear);
  });
  values_.resize(count, Vec3f::Ones());
  return std::exchange(values_, {});
}

}  // namespace vox
