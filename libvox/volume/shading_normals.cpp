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

/// Columns of the window to each side. A wide window averages the rounding of voxels down to a
/// fraction of a degree; small features and edges need a narrow window.
constexpr int kReach = 6;
constexpr int kNarrowReach = 3;
constexpr int kSide = 2 * kReach + 1;

/// Largest step up or down from a column of a sheet to the next: for slopes up to 45 degrees, and
/// rounding.
constexpr int kMostStep = 2;
constexpr std::size_t kKnownLog2 = 9;

constexpr int kNoHeight = std::numeric_limits<int>::max();

/// Coordinates of a height field: columns over the plane of axes u and v, heights along the third
/// axis, toward the viewer.
struct HeightFrame {
  Coord origin;
  int up, u, v;
  int sign;  // whether heights grow along the axis (1) or against it (-1)

  Coord at(int i, int j, int height) const {
    Coord voxel = origin;
    voxel[u] += i;
    voxel[v] += j;
    voxel[up] += sign * height;
    return voxel;
  }
};

using Heights = std::array<std::array<int, kSide>, kSide>;  // [i + kReach][j + kReach]

/// Top of the run of active voxels that holds a height; at most kMostStep above the height.
int climb(Voxels& voxels, const HeightFrame& frame, int i, int j, int height) {
  const int most = height + kMostStep;
  while (height < most && voxels.isValueOn(frame.at(i, j, height + 1))) ++height;
  return height;
}

/// Height of the sheet in a column, given the height in a neighbouring column; kNoHeight if the
/// sheet ends there.
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

/// Moments of columns, from which a plane h = a + p i + q j is fitted: sums of 1, i, j, h and their
/// products over the columns. (This is an Eigen array because GCC 12 with -O3 loses terms of plain
/// members that are added one by one.)
using Moments = Eigen::Array<int, 10, 1>;
enum Moment { kCount, kI, kJ, kH, kII, kJJ, kHH, kIJ, kIH, kJH };

Moments momentsOf(int i, int j, int h) {
  Moments moments;
  moments << 1, i, j, h, i * i, j * j, h * h, i * j, i * h, j * h;
  return moments;
}

/// Moments of nine blocks of columns: before, at and after the middle, along i and along j.
using Blocks = std::array<std::array<Moments, 3>, 3>;

/// Moments of the columns in the windows around a voxel.
struct Windows {
  Windows() {
    for (auto& row : narrow) row.fill(Moments::Zero());
  }
  Blocks narrow;
  Moments wide = Moments::Zero();
};

Windows windowsOf(const Heights& heights) {
  Windows windows;
  const auto block = [](int i) { return static_cast<std::size_t>((i > 0) - (i < 0) + 1); };
  for (int i = -kReach; i <= kReach; ++i)
    for (int j = -kReach; j <= kReach; ++j) {
      const int height =
          heights[static_cast<std::size_t>(i + kReach)][static_cast<std::size_t>(j + kReach)];
      if (height == kNoHeight) continue;
      windows.wide += momentsOf(i, j, height);
      if (std::max(std::abs(i), std::abs(j)) <= kNarrowReach)
        windows.narrow[block(i)][block(j)] += momentsOf(i, j, height);
    }
  return windows;
}

struct Plane {
  std::array<double, 2> slope{};   // along i and j
  std::array<double, 2> weight{};  // of the slopes; 0 if the columns do not span a plane
};

/// Plane through columns, by least squares.
Plane planeThrough(const Moments& m) {
  constexpr int kLeastColumns = 6;
  Plane plane;
  if (m[kCount] < kLeastColumns) return plane;
  const double n = m[kCount];
  const auto centred = [&](Moment product, Moment a, Moment b) {
    return m[product] - m[a] * m[b] / n;
  };
  const double ii = centred(kII, kI, kI);
  const double jj = centred(kJJ, kJ, kJ);
  const double ij = centred(kIJ, kI, kJ);
  const double ih = centred(kIH, kI, kH);
  const double jh = centred(kJH, kJ, kH);
  const double determinant = ii * jj - ij * ij;
  constexpr double kLeastSpread = 1e-6;  // from integers: it is 0 or much larger
  if (determinant < kLeastSpread) return plane;
  plane.slope = {(ih * jj - jh * ij) / determinant, (jh * ii - ih * ij) / determinant};
  const double hh = centred(kHH, kH, kH);
  const double misfit = (hh - plane.slope[0] * ih - plane.slope[1] * jh) / n;
  // Rounding alone causes a misfit of about 1/12, by chance half of it or less; the variance of a
  // slope depends on the spread of the columns. An edge of 45 degrees causes three times the
  // misfit.
  constexpr double kLuck = 0.04;
  constexpr double kSoftness = 0.1;
  const double small = 1 / (1 + std::max(0.0, misfit - kLuck) / kSoftness);
  const double fit = small * small * small * small;
  plane.weight = {ii * fit, jj * fit};
  return plane;
}

/// Sum of the moments of the blocks [i0, i1] x [j0, j1].
Moments momentsOver(const Blocks& blocks, std::size_t i0, std::size_t i1, std::size_t j0,
                    std::size_t j1) {
  Moments all = Moments::Zero();
  for (std::size_t i = i0; i <= i1; ++i)
    for (std::size_t j = j0; j <= j1; ++j) all += blocks[i][j];
  return all;
}

/// Weight of differences that are not one-sided. One-sided ones are biased on a curved surface, so
/// they must fit better to count as much.
constexpr double kTrustInCentral = 4;

struct Differences {
  Plane backward, central, forward, wide;

  /// Weighted mean of their slopes.
  double mixed(std::size_t axis) const {
    double sum = 0;
    double weights = 0;
    const auto add = [&](const Plane& plane, double trust) {
      sum += trust * plane.weight[axis] * plane.slope[axis];
      weights += trust * plane.weight[axis];
    };
    add(backward, 1);
    add(central, kTrustInCentral);
    add(forward, 1);
    add(wide, kTrustInCentral);
    return weights > 0 ? sum / weights : 0;
  }
};

/// A normal, and the quality of the plane over which it was estimated.
struct Estimate {
  Vec3d normal;
  int columns;   // number of columns in the narrow window
  double score;  // columns times the cosine between the normal and the plane's normal
};

Estimate estimateIn(Voxels& voxels, const HeightFrame& frame) {
  const Windows windows = windowsOf(heightsAround(voxels, frame));
  const Blocks& blocks = windows.narrow;
  const Moments all = momentsOver(blocks, 0, 2, 0, 2);
  const Plane central = planeThrough(all);
  const Plane wide = planeThrough(windows.wide);
  const Differences alongU = {planeThrough(momentsOver(blocks, 0, 1, 0, 2)), central,
                              planeThrough(momentsOver(blocks, 1, 2, 0, 2)), wide};
  const Differences alongV = {planeThrough(momentsOver(blocks, 0, 2, 0, 1)), central,
                              planeThrough(momentsOver(blocks, 0, 2, 1, 2)), wide};
  Estimate estimate;
  estimate.normal[frame.up] = frame.sign;
  estimate.normal[frame.u] = -alongU.mixed(0);
  estimate.normal[frame.v] = -alongV.mixed(1);
  estimate.normal.normalize();
  estimate.columns = all[kCount];
  estimate.score = all[kCount] * std::abs(estimate.normal[frame.up]);
  return estimate;
}

int largestComponent(const Vec3d& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return axis;
}

}  // namespace

CongradientNormals::CongradientNormals(const openvdb::MaskTree& voxels)
    : voxels_(voxels), known_(std::size_t{1} << kKnownLog2) {}

Vec3d CongradientNormals::at(const Coord& voxel, const Vec3d& face, const Vec3d& towardViewer) {
  const int start = largestComponent(face);
  const int side = 2 * start + (face[start] < 0 ? 1 : 0);
  Known& known = known_[voxel.hash<kKnownLog2>()];
  if (known.side != side || known.voxel != voxel)
    known = {voxel, side, estimate(voxel, start, face[start] < 0 ? -1 : 1)};
  // At the silhouette, the direction to the viewer alone does not decide which side is outside.
  return known.normal.dot(towardViewer + face) < 0 ? Vec3d(-known.normal) : known.normal;
}

Vec3d CongradientNormals::estimate(const Coord& voxel, int start, int sign) {
  // Another plane is tried if the surface faces another axis much more, or if too few columns have
  // a height.
  constexpr int kEnoughColumns = 40;
  constexpr double kLeaning = 1.15;
  Vec3d first = Vec3d::Zero();
  Estimate best{Vec3d::Zero(), 0, -1};
  std::array<bool, 3> tried{};
  for (int up = start; !tried[static_cast<std::size_t>(up)];) {
    tried[static_cast<std::size_t>(up)] = true;
    if (up != start && first[up] != 0) sign = first[up] < 0 ? -1 : 1;
    const HeightFrame frame{voxel, up, (up + 1) % 3, (up + 2) % 3, sign};
    const Estimate estimate = estimateIn(voxels_, frame);
    if (up == start) first = estimate.normal;
    if (estimate.score > best.score) best = estimate;
    const int facing = largestComponent(estimate.normal);
    const bool leans = std::abs(estimate.normal[facing]) > kLeaning * std::abs(estimate.normal[up]);
    if (!leans && estimate.columns >= kEnoughColumns) break;
    const int next = leans ? facing : (up + 1) % 3;
    for (int axis = next; axis < next + 3; ++axis) {
      up = axis % 3;
      if (!tried[static_cast<std::size_t>(up)]) break;
    }
  }
  return best.normal;
}

}  // namespace vox
