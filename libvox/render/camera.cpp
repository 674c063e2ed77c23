// Views, and how to frame a model in them.

#include "libvox/render/camera.h"

#include "libvox/core/error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

namespace vox {
namespace {

/// From above a corner of a cube, so that its three faces look alike.
constexpr double kIsoElevation = 35.26438968275465;

constexpr std::array<std::pair<const char*, View>, 7> kViews = {{{"front", {0, 0}},
                                                                 {"back", {180, 0}},
                                                                 {"left", {270, 0}},
                                                                 {"right", {90, 0}},
                                                                 {"top", {0, 90}},
                                                                 {"bottom", {0, -90}},
                                                                 {"iso", {45, kIsoElevation}}}};

/// Tangent of half the angle of view, along the longer side of a picture: a normal lens.
constexpr double kTangent = 0.3;
/// Margin on each side, as a part of the picture.
constexpr double kMargin = 0.04;

/// The whole text as a finite number.
std::optional<double> numberIn(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0;
  const bool read = stream >> value && stream.peek() == std::istringstream::traits_type::eof();
  return read && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Sine and cosine that are exact for quarters of a turn, so that such views look along an axis.
std::pair<double, double> sinCos(double degrees) {
  const double turned = std::remainder(degrees, 360.0);
  const double quarter = std::round(turned / 90);
  const double rest = (turned - 90 * quarter) * std::numbers::pi / 180;
  const double s = std::sin(rest);
  const double c = std::cos(rest);
  switch (static_cast<int>(quarter) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace

std::optional<View> viewNamed(std::string_view name) {
  for (const auto& [known, view] : kViews)
    if (known == name) return view;
  return std::nullopt;
}

std::string allViewNames() {
  std::string names;
  for (const auto& [name, view] : kViews) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

std::vector<View> parseViews(const std::string& text) {
  std::vector<View> views;
  std::istringstream list(text);
  for (std::string word; std::getline(list, word, ',');) {
    if (const auto known = viewNamed(word)) {
      views.push_back(*known);
      continue;
    }
    const auto azimuth = numberIn(word);
    if (!azimuth)
      throw UsageError("a view must be one of " + allViewNames() +
                       ", or azimuth and elevation in degrees such as 30,20; not '" + word + "'");
    std::getline(list, word, ',');
    const auto elevation = numberIn(word);
    constexpr double kZenith = 90;
    if (!list || !elevation || std::abs(*elevation) > kZenith)
      throw UsageError(
          "the azimuth of a view must be followed by its elevation, -90 to 90 degrees");
    views.push_back({*azimuth, *elevation});
  }
  if (views.empty()) throw UsageError("no view is given; known are " + allViewNames());
  return views;
}

ViewAxes axesOf(const View& view, UpAxis up) {
  const auto [sinA, cosA] = sinCos(view.azimuth);
  const auto [sinE, cosE] = sinCos(view.elevation);
  // With z up; the eye is at azimuth 0 on the side of -y.
  ViewAxes axes;
  axes.right = {cosA, sinA, 0};
  axes.forward = {-sinA * cosE, cosA * cosE, -sinE};
  axes.up = axes.right.cross(axes.forward);
  if (up == UpAxis::kZ) return axes;
  for (Vec3d* axis : {&axes.right, &axes.up, &axes.forward})
    *axis = Vec3d(axis->x(), axis->z(), -axis->y());
  return axes;
}

Sight Camera::through(double x, double y) const {
  const Vec3d across = (2 * x - 1) * halfWidth * axes.right + (1 - 2 * y) * halfHeight * axes.up;
  if (projection == Projection::kOrthographic) return {origin + across, axes.forward};
  return {origin, (axes.forward + across).normalized()};
}

std::array<double, 2> Camera::place(const Vec3d& point) const {
  const Vec3d away = point - origin;
  const double depth = projection == Projection::kOrthographic ? 1 : away.dot(axes.forward);
  return {(1 + away.dot(axes.right) / (depth * halfWidth)) / 2,
          (1 - away.dot(axes.up) / (depth * halfHeight)) / 2};
}

Framing::Framing(const View& view, UpAxis up, Projection projection, double aspect)
    : axes_(axesOf(view, up)), projection_(projection), aspect_(aspect) {
  most_.fill(-std::numeric_limits<double>::infinity());
}

void Framing::add(const Vec3d& point) {
  const double x = point.dot(axes_.right);
  const double y = point.dot(axes_.up);
  const double depth = point.dot(axes_.forward);
  nearest_ = std::min(nearest_, depth);
  double tangentX = 0;
  double tangentY = 0;
  if (projection_ == Projection::kPerspective) {
    tangentX = (1 - 2 * kMargin) * kTangent * std::min(1.0, aspect_);
    tangentY = (1 - 2 * kMargin) * kTangent * std::min(1.0, 1 / aspect_);
  }
  const std::array<double, 4> here = {x - tangentX * depth, -x - tangentX * depth,
                                      y - tangentY * depth, -y - tangentY * depth};
  for (std::size_t i = 0; i < here.size(); ++i) most_[i] = std::max(most_[i], here[i]);
}

double Framing::halfHeight() const {
  if (projection_ == Projection::kPerspective) return 0;
  const double width = (most_[0] + most_[1]) / 2;
  const double height = (most_[2] + most_[3]) / 2;
  return std::max(width / aspect_, height) / (1 - 2 * kMargin);
}

Camera Framing::orthographic(double leastHalfHeight) const {
  Camera camera{Projection::kOrthographic, axes_, Vec3d::Zero(), 0, 0};
  camera.halfHeight = std::max(halfHeight(), leastHalfHeight);
  camera.halfWidth = camera.halfHeight * aspect_;
  camera.origin = (most_[0] - most_[1]) / 2 * axes_.right + (most_[2] - most_[3]) / 2 * axes_.up +
                  (nearest_ - camera.halfHeight) * axes_.forward;
  return camera;
}

/// A point p is in sight if (p - eye).right <= tangent (p - eye).forward, and likewise for the
/// other three sides; most_ holds the extremes of these conditions.
Camera Framing::perspective() const {
  Camera camera{Projection::kPerspective, axes_, Vec3d::Zero(), 0, 0};
  camera.halfWidth = kTangent * std::min(1.0, aspect_);
  camera.halfHeight = kTangent * std::min(1.0, 1 / aspect_);
  const double shrink = 1 - 2 * kMargin;
  const double depth = std::min(-(most_[0] + most_[1]) / (2 * shrink * camera.halfWidth),
                                -(most_[2] + most_[3]) / (2 * shrink * camera.halfHeight));
  camera.origin = (most_[0] - most_[1]) / 2 * axes_.right + (most_[2] - most_[3]) / 2 * axes_.up +
                  depth * axes_.forward;
  return camera;
}

Camera Framing::camera(double leastHalfHeight) const {
  return projection_ == Projection::kOrthographic ? orthographic(leastHalfHeight) : perspective();
}

}  // namespace vox
