#pragma once

#include "libvox/core/image.h"

#include <array>
#include <string>
#include <vector>

namespace vox {

/// A picture of a report.
struct Picture {
  Image image;
  std::string title;        ///< a few words
  std::string description;  ///< what is seen; stands for the picture where there is none
  std::vector<std::array<double, 2>> marks;  ///< places to circle, 0 .. 1 from the upper left
};

/// A picture with half the pixels each way: means of four.
Image halved(const Image& image);

/// The picture with its title as HTML.
std::string figureOf(const Picture& picture);

}  // namespace vox
