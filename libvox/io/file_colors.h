#pragma once

#include "libvox/core/types.h"
#include "libvox/io/read_report.h"

#include <cstddef>
#include <vector>

namespace vox {

/// Collects the colours of points or faces while a file is read.
///
/// Files store sRGB values in several ranges. The range is known only after the last one is read:
/// - floats and texts: 0 to 1 if all values are below 2, else 0 to 255;
/// - integers: 0 to 255 if no value is larger, else 0 to 65535 or to the largest of their type.
/// Values above the range are clamped and counted.
class FileColors {
 public:
  /// The type of the values is an integer that holds values up to this one.
  void setIntegers(double largestOfType) { largestOfType_ = largestOfType; }

  /// Sets the colour of an element, in the range of the file.
  /// @param line  of the file; 0: it is binary
  void set(Index element, const Vec3d& values, std::size_t line = 0);

  /// Adds the colours of a later part of the file, which numbers its elements and lines from 0.
  /// @param firstElement  number of the part's first element; no colour here has it or a later one
  /// @param linesBefore   lines before the part
  void append(const FileColors& part, Index firstElement, std::size_t linesBefore = 0);

  bool empty() const { return values_.empty(); }

  /// Linear colours, 0 to 1, of `count` elements; white for an element whose colour was not set.
  /// Empty if no colour was set. Leaves this object empty.
  std::vector<Vec3f> takeLinear(Index count, ReadReport& report);

 private:
  /// The first colour with a value above a limit, and how many values are.
  struct Above {
    float limit;
    std::uint64_t values = 0;
    std::size_t line = 0;
    Index element = 0;
  };

  float fullBrightness() const;

  std::vector<Vec3f> values_;
  std::vector<bool> isSet_;
  double largestOfType_ = 0;  // 0: no integers
  float largest_ = 0;
  Above aboveOne_{1.00001F};  // the rest is rounding
  Above above255_{255.001F};
};

}  // namespace vox
