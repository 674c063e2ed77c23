// Level sets against the truth: voxels chosen by hashes, in the band, around it and far off.

#include "tests/level_set_errors.h"

#include "libvox/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vox::test {
namespace {

using openvdb::Coord;

constexpr double kTolerance = 0.02;
constexpr std::size_t kVoxelsPerTask = 64;

std::uint64_t hashOf(const Coord& voxel) {
  std::uint64_t hash = 0;
  for (const int x : {voxel.x(), voxel.y(), voxel.z()})
    hash = mixed(hash ^ static_cast<std::uint32_t>(x));
  return hash;
}

Vec3d positionOf(const Coord& voxel) {
  return {double(voxel.x()), double(voxel.y()), double(voxel.z())};
}
Coord voxelAt(const Vec3d& p) {
  return Coord::round(openvdb::Vec3d(p.data()));
}

std::vector<Coord> someActive(const openvdb::FloatGrid& grid, std::size_t samples) {
  const double share = static_cast<double>(samples) /
                       static_cast<double>(std::max<openvdb::Index64>(grid.activeVoxelCount(), 1));
  std::vector<Coord> voxels;
  for (auto value = grid.cbeginValueOn(); value; ++value)
    if (mixedFraction(hashOf(value.getCoord())) < share) voxels.push_back(value.getCoord());
  return voxels;
}

Vec3d randomDirection(std::uint64_t number) {
  constexpr double kTurn = 6.283185307179586;
  const double z = 2 * mixedFraction(number) - 1;
  const double angle = kTurn * mixedFraction(mixed(number));
  const double radius = std::sqrt(1 - z * z);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// Voxels near the surface: every second one along the normal, the others in any direction.
std::vector<Coord> someNear(const Surface& truth, double in, double out, std::size_t samples) {
  std::vector<Coord> voxels;
  for (std::uint64_t k = 0; k < samples; ++k) {
    const Surface::Sample sample = truth.sample(k);
    const double way = -in + (in + out) * mixedFraction(~k);
    const Vec3d direction = k % 2 == 0 ? sample.normal : randomDirection(k);
    voxels.push_back(voxelAt(sample.point + way * direction));
  }
  return voxels;
}

/// Voxels of the box around the active ones, and of a margin.
std::vector<Coord> someOfBox(const openvdb::FloatGrid& grid, std::size_t samples) {
  constexpr int kMargin = 16;
  openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  std::vector<Coord> voxels;
  if (box.empty()) return voxels;
  box.expand(kMargin);
  for (std::uint64_t k = 0; k < samples; ++k) {
    Coord voxel = box.min();
    for (int axis = 0; axis < 3; ++axis)
      voxel[axis] +=
          static_cast<int>(mixedFraction(4 * k + static_cast<unsigned>(axis)) * box.dim()[axis]);
    voxels.push_back(voxel);
  }
  return voxels;
}

/// Closest points of voxels, in their order. Parallel.
std::vector<Surface::Foot> feetOf(const std::vector<Coord>& voxels, const Surface& truth) {
  std::vector<Surface::Foot> feet(voxels.size());
  parallelForEach(voxels.size(), kVoxelsPerTask,
                  [&](std::size_t i) { feet[i] = truth.of(positionOf(voxels[i])); });
  return feet;
}

class LevelSetComparison {
 public:
  LevelSetComparison(const openvdb::FloatGrid& grid, double voxelSize, double bandIn,
                     double bandOut)
      : values_(grid.getConstAccessor()),
        background_(grid.background() / voxelSize),
        voxelSize_(voxelSize),
        bandIn_(bandIn),
        bandOut_(bandOut) {}

  void addActive(const Coord& voxel, const Surface::Foot& foot) {
    const double value = valueAt(voxel);
    const bool flipped = isFlipped(value, foot);
    const double off = flipped && std::abs(foot.signedDistance) > kTolerance
                           ? std::abs(value) - std::abs(foot.signedDistance)
                           : value - foot.signedDistance;
    ++errors_.active;
    sum_ += off * off;
    // Not std::max: a NaN must show.
    if (!(std::abs(off) <= errors_.largest)) errors_.largest = std::abs(off);
    errors_.wrongSigns += flipped && signCounts(foot);
    errors_.surplus +=
        foot.signedDistance < -bandIn_ - kTolerance || foot.signedDistance > bandOut_ + kTolerance;
  }

  void addAny(const Coord& voxel, const Surface::Foot& foot) {
    const bool near =
        foot.signedDistance > -bandIn_ + kTolerance && foot.signedDistance < bandOut_ - kTolerance;
    const bool on = values_.isValueOn(voxel);
    errors_.near += near;
    errors_.missing += near && !on;
    if (on) return;
    const double value = valueAt(voxel);
    const auto is = [&](double size) { return std::abs(value - size) <= 1e-5 * std::abs(size); };
    ++errors_.inactive;
    errors_.wrongBackgrounds += !is(background_) && !is(-bandIn_);
    errors_.wrongSides += isFlipped(value, foot) && signCounts(foot);
  }

  LevelSetErrors result() const {
    LevelSetErrors errors = errors_;
    if (errors.active > 0) errors.rms = std::sqrt(sum_ / static_cast<double>(errors.active));
    return errors;
  }

 private:
  double valueAt(const Coord& voxel) const { return double{values_.getValue(voxel)} / voxelSize_; }
  static bool isFlipped(double value, const Surface::Foot& foot) {
    return (value < 0) != (foot.signedDistance < 0);
  }
  static bool signCounts(const Surface::Foot& foot) {
    return std::abs(foot.signedDistance) * foot.cosine > kTolerance;
  }

  openvdb::FloatGrid::ConstAccessor values_;
  double background_;
  double voxelSize_;
  double bandIn_;
  double bandOut_;
  double sum_ = 0;
  LevelSetErrors errors_;
};

}  // namespace

LevelSetErrors compareLevelSet(const openvdb::FloatGrid& grid, const Surface& truth,
                               double voxelSize, double bandIn, double bandOut,
                               std::size_t samples) {
  LevelSetComparison comparison(grid, voxelSize, bandIn, bandOut);
  const std::vector<Coord> active = someActive(grid, samples);
  const std::vector<Surface::Foot> activeFeet = feetOf(active, truth);
  for (std::size_t i = 0; i < active.size(); ++i) comparison.addActive(active[i], activeFeet[i]);

  constexpr double kAround = 3;  // in bands
  for (const std::vector<Coord>& voxels :
       {someNear(truth, bandIn, bandOut, samples),
        someNear(truth, kAround * bandIn, kAround * bandOut, samples), someOfBox(grid, samples)}) {
    const std::vector<Surface::Foot> feet = feetOf(voxels, truth);
    for (std::size_t i = 0; i < voxels.size(); ++i) comparison.addAny(voxels[i], feet[i]);
  }
  return comparison.result();
}

}  // namespace vox::test
