#pragma once

#include "libvox/core/names.h"
#include "libvox/core/types.h"
#include "libvox/options/crease_rule.h"

#include <optional>
#include <vector>

namespace vox {

/// How the smooth surface of an open mesh ends (DESIGN section 4).
enum class BoundaryRule {
  kExtend,   ///< at the closed uniform quadratic B-spline of each boundary loop
  kFree,     ///< plain Doo-Sabin: the surface ends half a face inside the boundary of the mesh
  kCorners,  ///< as kExtend, but boundary vertices with a single face are corners (section 19)
};
inline constexpr NameTable<BoundaryRule, 3> kBoundaryRuleNames = {
    {{BoundaryRule::kExtend, "extend"},
     {BoundaryRule::kFree, "free"},
     {BoundaryRule::kCorners, "corners"}}};

/// Which vertices of the input the smooth surface passes through.
enum class Interpolate { kNothing, kInterior, kBoundary, kBoth };
inline constexpr NameTable<Interpolate, 4> kInterpolateNames = {
    {{Interpolate::kNothing, "none"},
     {Interpolate::kInterior, "interior"},
     {Interpolate::kBoundary, "boundary"},
     {Interpolate::kBoth, "both"}}};

/// What happens to faces that smoothing would fold over: those that are not star-shaped about the
/// mean of their corners.
enum class FaceRule {
  kSplit,  ///< they are split into convex faces
  kKeep,   ///< they stay as they are
};
inline constexpr NameTable<FaceRule, 2> kFaceRuleNames = {
    {{FaceRule::kSplit, "split"}, {FaceRule::kKeep, "keep"}}};

/// How to smooth an object. A value that is not set comes from the object, else from the default.
struct SmoothingOptions {
  std::optional<BoundaryRule> boundary;                    ///< default: kExtend
  std::optional<Interpolate> interpolate;                  ///< default: kNothing
  std::optional<std::vector<Index>> interpolatedVertices;  ///< interior, added to `interpolate`
  std::optional<FaceRule> faces;                           ///< default: kSplit
  std::optional<CreaseRule> crease;                        ///< default: nothing is sharp
  std::optional<std::vector<PointPair>> creaseEdges;       ///< sharp, added to `crease`
  std::optional<std::vector<Index>> cornerVertices;        ///< where the surface has a corner
};

}  // namespace vox
