// How smoothing options from two sources combine.

#include "libvox/options/smoothing_options.h"

namespace vox {

SmoothingOptions overriding(const SmoothingOptions& first, const SmoothingOptions& second) {
  SmoothingOptions result = first;
  if (!first.boundary) result.boundary = second.boundary;
  if (first.interpolate || first.interpolatedVertices) return result;
  result.interpolate = second.interpolate;
  result.interpolatedVertices = second.interpolatedVertices;
  return result;
}

}  // namespace vox
