// Congradient shading. Source: paper section 9.

#include "libvox/volume/shading_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace vox {
namespace {

using openvdb::Coord;
using Voxels = openvdb::tree::ValueAccessor<const openvdb::MaskTree>;

/// Columns to each side. Wider smooths more and rounds edges and small features further; at 3 the
/// rounding of voxels is averaged down to a degree or two.
constexpr int kReach = 3;
constexpr int kSide = 2 * kReach + 1;

/// Most steps up or down to the next column of a sheet: slopes to 45 degrees, and rounding.
constexpr int kMostStep = 2;
constexpr int kNoHeight = std::numeric_limits<int>::max();

/// Columns over the plane of axes u and v, heights along the third, toward the viewer.
struct HeightFrame {
  Coord origin;
  int up, u, v;
  int sign;  // of the direction up

  Coord at(int i, int j, int height) const {
    Coord voxel = origin;
    voxel[u] += i;
    voxel[v] += j;
    voxel[up] += sign * height;
    return voxel;
  }
};

using Heights = std::array<std::array<int, kSide>, kSide>;  // [i + kReach][j + kReach]

/// Top of the run of voxels that holds a height, no more than kMostStep higher.
int climb(Voxels& voxels, const HeightFrame& frame, int i, int j, int height) {
  const int most = height + kMostStep;
  while (height < most && voxels.isValueOn(frame.at(i, j, height + 1))) ++height;
  return height;
}

/// Height of the sheet in a column, given that of a neighbour.
int heightBeside(Voxels& voxels, const HeightFrame& frame, int i, int j, int neighbour) {
  if (neighbour == kNoHeight) return kNoHeight;
  const auto isOn = [&](int height) { return voxels.isValueOn(frame.at(i, j, height)); };
  if (isOn(neighbour)) return climb(voxels, frame, i, j, neighbour);
  if (isOn(neighbour + 1)) return isOn(neighbour + 2) ? neighbour + 2 : neighbour + 1;
  for (const int step : {-1, 2, -2})
    if (isOn(neighbour + step)) return neighbour + step;
  return kNoHeight;
}

Heights heightsAround(Voxels& voxels, const HeightFrame& frame) {
  Heights heights;
  const auto at = [&](int i, int j) -> int& {
    return heights[static_cast<std::size_t>(i + kReach)][static_cast<std::size_t>(j + kReach)];
  };
  at(0, 0) = climb(voxels, frame, 0, 0, 0);
  for (const int side : {-1, 1})
    for (int j = side; std::abs(j) <= kReach; j += side)
      at(0, j) = heightBeside(voxels, frame, 0, j, at(0, j - side));
  for (int j = -kReach; j <= kReach; ++j)
    for (const int side : {-1, 1})
      for (int i = side; std::abs(i) <= kReach; i += side)
        at(i, j) = heightBeside(voxels, frame, i, j, at(i - side, j));
  return heights;
}

/// What a plane h = a + p i + q j through columns is fitted from.
struct Moments {
  int n = 0, i = 0, j = 0, h = 0, ii = 0, jj = 0, hh = 0, ij = 0, ih = 0, jh = 0;

  void addColumn(int atI, int atJ, int height) {
    add({1, atI, atJ, height, atI * atI, atJ * atJ, height * height, atI * atJ, atI * height,
         atJ * height});
  }
  void add(const Moments& other) {
    n += other.n;
    i += other.i;
    j += other.j;
    h += other.h;
    ii += other.ii;
    jj += other.jj;
    hh += other.hh;
    ij += other.ij;
    ih += other.ih;
    jh += other.jh;
  }
};

/// Moments of the columns before, at and after the middle, along i and j.
using Blocks = std::array<std::array<Moments, 3>, 3>;

Blocks blocksOf(const Heights& heights) {
  Blocks blocks;
  const auto block = [](int i) { return static_cast<std::size_t>((i > 0) - (i < 0) + 1); };
  for (int i = -kReach; i <= kReach; ++i)
    for (int j = -kReach; j <= kReach; ++j) {
      const int height =
          heights[static_cast<std::size_t>(i + kReach)][static_cast<std::size_t>(j + kReach)];
      if (height != kNoHeight) blocks[block(i)][block(j)].addColumn(i, j, height);
    }
  return blocks;
}

struct Plane {
  double p = 0, q = 0;  // slopes along i and j
  double weight = 0;    // 0: columns that do not span a plane
};

/// Least squares.
Plane planeThrough(const Moments& m) {
  constexpr int kLeastColumns = 6;
  Plane plane;
  if (m.n < kLeastColumns) return plane;
  const double n = m.n;
  const double ii = m.ii - m.i * m.i / n;
  const double jj = m.jj - m.j * m.j / n;
  const double ij = m.ij - m.i * m.j / n;
  const double ih = m.ih - m.i * m.h / n;
  const double jh = m.jh - m.j * m.h / n;
  const double determinant = ii * jj - ij * ij;
  constexpr double kLeastSpread = 1e-6;  // of integers: it is 0 or larger by far
  if (determinant < kLeastSpread) return plane;
  plane.p = (ih * jj - jh * ij) / determinant;
  plane.q = (jh * ii - ih * ij) / determinant;
  const double hh = m.hh - m.h * m.h / n;
  const double misfit = std::max(0.0, hh - plane.p * ih - plane.q * jh) / n;
  // Rounding alone leaves a misfit of 1/12, an edge of 45 degrees three times as much.
  constexpr double kSoftness = 0.05;
  const double small = 1 / (1 + misfit / kSoftness);
  plane.weight = n * small * small * small * small;
  return plane;
}

/// Moments of the blocks [i0, i1] x [j0, j1].
Plane planeOver(const Blocks& blocks, std::size_t i0, std::size_t i1, std::size_t j0,
                std::size_t j1) {
  Moments all;
  for (std::size_t i = i0; i <= i1; ++i)
    for (std::size_t j = j0; j <= j1; ++j) all.add(blocks[i][j]);
  return planeThrough(all);
}

/// A one-sided difference sees half as much and bends with a curved surface: it has to fit far
/// better before it counts.
constexpr double kTrustInCentral = 16;

/// The three differences as one slope.
double mixed(const Plane& backward, const Plane& central, const Plane& forward,
             double Plane::*slope) {
  const double trusted = kTrustInCentral * central.weight;
  const double sum = backward.weight + trusted + forward.weight;
  if (sum <= 0) return 0;
  return (backward.weight * (backward.*slope) + trusted * (central.*slope) +
          forward.weight * (forward.*slope)) /
         sum;
}

Vec3d normalIn(Voxels& voxels, const HeightFrame& frame) {
  const Blocks blocks = blocksOf(heightsAround(voxels, frame));
  const Plane central = planeOver(blocks, 0, 2, 0, 2);
  Vec3d normal;
  normal[frame.up] = frame.sign;
  normal[frame.u] =
      -mixed(planeOver(blocks, 0, 1, 0, 2), central, planeOver(blocks, 1, 2, 0, 2), &Plane::p);
  normal[frame.v] =
      -mixed(planeOver(blocks, 0, 2, 0, 1), central, planeOver(blocks, 0, 2, 1, 2), &Plane::q);
  return normal.normalized();
}

int largestComponent(const Vec3d& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return axis;
}

/// The axis of the free face that looks most toward the viewer; or of any such face.
int axisToStart(Voxels& voxels, const Coord& voxel, const Vec3d& towardViewer) {
  int best = -1;
  for (int axis = 0; axis < 3; ++axis) {
    Coord beside = voxel;
    beside[axis] += towardViewer[axis] < 0 ? -1 : 1;
    const bool better = best < 0 || std::abs(towardViewer[axis]) > std::abs(towardViewer[best]);
    if (better && !voxels.isValueOn(beside)) best = axis;
  }
  return best < 0 ? largestComponent(towardViewer) : best;
}

}  // namespace

Vec3d CongradientNormals::at(const Coord& voxel, const Vec3d& towardViewer) {
  int up = axisToStart(voxels_, voxel, towardViewer);
  Vec3d normal;
  // A plane that the surface leans over is left for the one it faces.
  constexpr int kMostPlanes = 3;
  constexpr double kLeaning = 1.15;
  for (int plane = 0; plane < kMostPlanes; ++plane) {
    const HeightFrame frame{voxel, up, (up + 1) % 3, (up + 2) % 3, towardViewer[up] < 0 ? -1 : 1};
    normal = normalIn(voxels_, frame);
    const int facing = largestComponent(normal);
    if (std::abs(normal[facing]) < kLeaning * std::abs(normal[up])) break;
    up = facing;
  }
  return normal.dot(towardViewer) < 0 ? Vec3d(-normal) : normal;
}

}  // namespace vox
