#pragma once

#include "libvox/core/types.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vox {

/// Where the smooth surface of an open mesh ends (DESIGN section 4).
enum class BoundaryRule {
  kExtend,  ///< at the closed uniform quadratic B-spline of each boundary loop
  kFree,    ///< plain Doo-Sabin: half a face inside, so the surface shrinks from its boundary
};

/// Which vertices of the input the smooth surface passes through.
enum class Interpolate { kNothing, kInterior, kBoundary, kBoth };

/// Names in scenes and on the command line: "extend", "interior".
std::string boundaryRuleName(BoundaryRule rule);
std::string interpolateName(Interpolate which);

/// Value of that name, or nothing.
std::optional<BoundaryRule> boundaryRuleNamed(std::string_view name);
std::optional<Interpolate> interpolateNamed(std::string_view name);

/// For messages: "extend, free".
std::string allBoundaryRuleNames();
std::string allInterpolateNames();

/// How to smooth an object, as far as somebody said.
struct SmoothingOptions {
  std::optional<BoundaryRule> boundary;                    ///< default: kExtend
  std::optional<Interpolate> interpolate;                  ///< default: kNone
  std::optional<std::vector<Index>> interpolatedVertices;  ///< interior ones, besides `interpolate`
};

/// What `first` says, and `second` where it is silent. `interpolate` and `interpolatedVertices` are
/// one choice: whoever makes one of them makes both.
SmoothingOptions overriding(const SmoothingOptions& first, const SmoothingOptions& second);

}  // namespace vox
