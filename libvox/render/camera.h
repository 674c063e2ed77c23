#pragma once

#include "libvox/core/names.h"
#include "libvox/core/types.h"
#include "libvox/options/volume_options.h"

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vox {

/// Direction from which a model is seen, in degrees.
struct View {
  double azimuth = 0;    ///< around the up axis: 0 front, 90 right, 180 back, 270 left
  double elevation = 0;  ///< above the horizon, -90 .. 90
  bool operator==(const View&) const = default;
};

/// The view of that name ("front", "iso"); empty if there is none.
std::optional<View> viewNamed(std::string_view name);
/// For messages: "front, back, left, right, top, bottom, iso".
std::string allViewNames();

/// Views in a list with commas, each a name or azimuth and elevation: "front,iso,30,-15".
/// @throws UsageError
std::vector<View> parseViews(const std::string& text);

enum class Projection { kOrthographic, kPerspective };
inline constexpr NameTable<Projection, 2> kProjectionNames = {
    {{Projection::kOrthographic, "orthographic"}, {Projection::kPerspective, "perspective"}}};

/// A line of sight in world space.
struct Sight {
  Vec3d origin;
  Vec3d direction;  ///< unit
};

/// Unit vectors to the right, upward and into the picture.
struct ViewAxes {
  Vec3d right, up, forward;
};
/// @param up  the axis of the world that is up in pictures. Z: the front is seen along +y, x to the
///   right, as in Blender. Y: along -z, x to the right, as mesh files often have it
ViewAxes axesOf(const View& view, UpAxis up);

struct Camera {
  Projection projection = Projection::kOrthographic;
  ViewAxes axes;
  Vec3d origin;       ///< the eye, or the middle of the plane that parallel rays start from
  double halfWidth;   ///< of the picture: world units, or tangents for a perspective
  double halfHeight;  ///< the same

  /// @param x, y  0 .. 1 from the upper left corner of the picture
  Sight through(double x, double y) const;

  /// Where a point of world space appears: x and y of through().
  std::array<double, 2> place(const Vec3d& point) const;
};

/// Finds the camera that shows all points as large as possible, in the middle, with a margin.
class Framing {
 public:
  /// @param aspect  width of the picture / its height
  Framing(const View& view, UpAxis up, Projection projection, double aspect);

  void add(const Vec3d& point);

  /// Half the height that a parallel projection needs; 0 for a perspective. World units.
  double halfHeight() const;

  /// @param leastHalfHeight  least half height of the picture: for several views at one scale
  Camera camera(double leastHalfHeight = 0) const;

 private:
  Camera orthographic(double leastHalfHeight) const;
  Camera perspective() const;

  ViewAxes axes_;
  Projection projection_;
  double aspect_;
  // The largest of right, left, up and down of all points, reduced by what a perspective allows for
  // their depth; and their smallest depth.
  std::array<double, 4> most_;
  double nearest_ = std::numeric_limits<double>::infinity();
};

}  // namespace vox
