// Names of the smoothing options, and which of them prevail.

#include "libvox/mesh/smoothing.h"

#include <array>

namespace vox {
namespace {

constexpr std::array kBoundaryRules = {BoundaryRule::kExtend, BoundaryRule::kFree};
constexpr std::array kInterpolates = {Interpolate::kNothing, Interpolate::kInterior,
                                      Interpolate::kBoundary, Interpolate::kBoth};

}  // namespace

std::string boundaryRuleName(BoundaryRule rule) {
  return rule == BoundaryRule::kExtend ? "extend" : "free";
}

std::string interpolateName(Interpolate which) {
  switch (which) {
    case Interpolate::kNothing:
      return "none";
    case Interpolate::kInterior:
      return "interior";
    case Interpolate::kBoundary:
      return "boundary";
    case Interpolate::kBoth:
      return "both";
  }
  return {};
}

std::optional<BoundaryRule> boundaryRuleNamed(std::string_view name) {
  for (const BoundaryRule rule : kBoundaryRules)
    if (boundaryRuleName(rule) == name) return rule;
  return std::nullopt;
}

std::optional<Interpolate> interpolateNamed(std::string_view name) {
  for (const Interpolate which : kInterpolates)
    if (interpolateName(which) == name) return which;
  return std::nullopt;
}

std::string allBoundaryRuleNames() {
  std::string names;
  for (const BoundaryRule rule : kBoundaryRules)
    names += (names.empty() ? "" : ", ") + boundaryRuleName(rule);
  return names;
}

std::string allInterpolateNames() {
  std::string names;
  for (const Interpolate which : kInterpolates)
    names += (names.empty() ? "" : ", ") + interpolateName(which);
  return names;
}

SmoothingOptions overriding(const SmoothingOptions& first, const SmoothingOptions& second) {
  SmoothingOptions result = first;
  if (!first.boundary) result.boundary = second.boundary;
  if (first.interpolate || first.interpolatedVertices) return result;
  result.interpolate = second.interpolate;
  result.interpolatedVertices = second.interpolatedVertices;
  return result;
}

}  // namespace vox
