// Normals, lamps and the sky.

#include "libvox/render/shading.h"

#include "libvox/grid/openvdb.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace vox {
namespace {

// Directions to the lamps and to the top of the sky, by the axes of the camera: right, up, toward
// the viewer.
const Vec3d kLamp = Vec3d(-0.6, 0.7, 0.5).normalized();
const Vec3d kFill = Vec3d(0.9, 0, 0.3).normalized();
constexpr double kLampLight = 0.85;
constexpr double kFillLight = 0.08;
constexpr double kSkyLight = 0.22;
constexpr double kGroundLight = 0.4;  // relative to the sky

/// Colour of a surface that has none.
constexpr double kAlbedo = 0.68;

/// Length of the rays that look for the sky, relative to the longest side of the surface.
constexpr double kOcclusionReach = 0.12;
/// Where such rays start, in voxels above the surface: clear of the steps of its own voxels.
constexpr double kOcclusionStart = 2;

openvdb::Vec3d toOpenVdb(const Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}
template <class Vector>
Vec3d fromOpenVdb(const Vector& v) {
  return Vec3d(v[0], v[1], v[2]);
}

/// The bits of k mirrored behind the point: 0, 1/2, 1/4, 3/4, ...
double radicalInverse(std::uint32_t k) {
  double inverse = 0;
  for (double digit = 0.5; k > 0; k >>= 1U, digit /= 2)
    if ((k & 1U) != 0) inverse += digit;
  return inverse;
}

/// Direction k of `count` about the normal, as dense as its cosine (Malley's method, on a
/// Hammersley set).
Vec3d hemisphereDirection(const Vec3d& normal, const Vec3d& right, const Vec3d& up, int k,
                          int count) {
  const double radius = std::sqrt((k + 0.5) / count);
  const double angle = 2 * std::numbers::pi * radicalInverse(static_cast<std::uint32_t>(k));
  constexpr double kParallel = 0.9;
  const Vec3d& reference = std::abs(normal.dot(right)) < kParallel ? right : up;
  const Vec3d u = (reference - normal.dot(reference) * normal).normalized();
  const Vec3d v = normal.cross(u);
  return radius * std::cos(angle) * u + radius * std::sin(angle) * v +
         std::sqrt(std::max(0.0, 1 - radius * radius)) * normal;
}

/// Diffuse reflection of a lamp that is not a point: light fades out a little past the horizon.
double softened(double cosine) {
  constexpr double kPast = 0.12;
  return std::max(0.0, (cosine + kPast) / (1 + kPast));
}

double longestSide(const std::vector<openvdb::CoordBBox>& boxes) {
  openvdb::CoordBBox all;
  for (const auto& box : boxes) all.expand(box);
  return all.extents().asVec3d()[static_cast<int>(all.maxExtent())];
}

/// Turns a normal to the side of an open surface that the viewer sees. Near a silhouette a smooth
/// normal may point away from the viewer a little.
Vec3d facing(const Vec3d& normal, const Vec3d& face, const Vec3d& direction) {
  const double away = normal.dot(direction);
  constexpr double kLeaning = 0.2;
  return away > kLeaning || (away > 0 && normal.dot(face) < 0) ? Vec3d(-normal) : normal;
}

}  // namespace

Shader::Shader(const VisibleGrids& visible, const RayCaster& surface, const ViewAxes& axes,
               const ShadingOptions& options)
    : options_(options),
      axes_(axes),
      surface_(surface.copy()),
      map_(visible.toWorld->baseMap()),
      occlusionReach_(kOcclusionReach * longestSide(visible.boxes)) {
  if (visible.voxels) congradient_.emplace(*visible.voxels);
  if (visible.normals) normals_.emplace(visible.normals->tree());
  if (visible.colors) colors_.emplace(visible.colors->tree());
  computedColors_ = visible.colorAt;
}

std::optional<Vec3d> Shader::storedNormal(const openvdb::Coord& voxel) {
  if (!normals_ || options_.shading != Shading::kNormals) return std::nullopt;
  const Vec3d world = fromOpenVdb(normals_->getValue(voxel));
  const double length = world.norm();
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  return fromOpenVdb(map_->applyJT(toOpenVdb(world))).normalized();
}

Vec3d Shader::normalAt(const RayHit& hit, const Vec3d& direction) {
  if (options_.shading == Shading::kFlat || !congradient_)
    return facing(hit.face, hit.face, direction);
  if (const auto stored = storedNormal(hit.voxel)) return facing(*stored, hit.face, direction);
  return congradient_->at(hit.voxel, hit.face, -direction);
}

Light Shader::colorAt(const openvdb::Coord& voxel) {
  openvdb::Vec3f color;
  if (computedColors_) {
    const auto computed = computedColors_(voxel);
    if (!computed) return Light::Constant(kAlbedo);
    color = *computed;
  } else if (!colors_ || !colors_->probeValue(voxel, color)) {
    return Light::Constant(kAlbedo);
  }
  Light light = fromOpenVdb(color);
  for (double& part : light) part = part > 0 ? std::min(part, 1.0) : 0;  // NaN, too
  return light;
}

double Shader::skyAt(const IndexRay& ray, const RayHit& hit, const Vec3d& normal, int sample,
                     int samples) {
  const int count = options_.occlusionRays;
  if (count == 0) return 1;
  const Vec3d start = fromOpenVdb(ray(hit.time)) + kOcclusionStart * normal;
  double hidden = 0;
  for (int k = 0; k < count; ++k) {
    const Vec3d direction =
        hemisphereDirection(normal, axes_.right, axes_.up, k * samples + sample, count * samples);
    const IndexRay skyward =
        indexRay(start, direction, openvdb::math::Delta<double>::value(), occlusionReach_);
    const auto blocked = surface_->firstHit(skyward);
    if (!blocked) continue;
    const double distance = 1 - blocked->time / occlusionReach_;
    hidden += distance * distance;
  }
  return 1 - hidden / count;
}

std::optional<Light> Shader::look(const Sight& sight, int sample, int samples) {
  const IndexRay ray = indexRay(sight, *map_);
  const auto hit = surface_->firstHit(ray);
  if (!hit) return std::nullopt;
  const Vec3d normalIndex = normalAt(*hit, fromOpenVdb(ray.dir()));
  const Vec3d normal = fromOpenVdb(map_->applyIJT(toOpenVdb(normalIndex))).normalized();
  const Vec3d seen(normal.dot(axes_.right), normal.dot(axes_.up), -normal.dot(axes_.forward));
  const double sky = skyAt(ray, *hit, normalIndex, sample, samples);
  const double horizon = (1 + kGroundLight) / 2 + (1 - kGroundLight) / 2 * seen.y();
  const double light = kLampLight * softened(seen.dot(kLamp)) +
                       kFillLight * softened(seen.dot(kFill)) + kSkyLight * horizon * sky;
  return light * colorAt(hit->voxel);
}

}  // namespace vox
