#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>

namespace vox {

using Vec2d = Eigen::Vector2d;
using Vec2f = Eigen::Vector2f;
using Vec3d = Eigen::Vector3d;
using Vec3f = Eigen::Vector3f;
using Vec4f = Eigen::Vector4f;

/// Index of a point, face or corner. Meshes hold fewer than 2^32 - 1 of each.
using Index = std::uint32_t;

/// The points at the ends of an edge.
using PointPair = std::array<Index, 2>;

/// "No such element", such as the twin of a boundary corner.
inline constexpr Index kNone = 0xffffffffU;

}  // namespace vox
