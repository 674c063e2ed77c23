#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vox {

struct DiffOptions {
  /// Values a and b agree if |a - b| <= absolute + relative max(|a|, |b|), per component.
  double absoluteTolerance = 0;
  double relativeTolerance = 0;
  bool metadata = true;                ///< compare metadata, too
  std::vector<std::string> onlyGrids;  ///< compare these; empty: all
  bool gridsMayLack = false;           ///< it is no error if neither file has one of them
  double voxelTolerance = 0;           ///< voxels of one may be this far from those of the other
};

using VoxelIndex = std::array<std::int32_t, 3>;

/// Which voxels are active.
struct TopologyDiff {
  std::array<std::uint64_t, 2> active{};  ///< in A, in B
  std::uint64_t onlyA = 0;
  std::uint64_t onlyB = 0;
  std::optional<VoxelIndex> first;  ///< lowest (x, then y, then z) that is active in one only
  /// Hausdorff distance of the two sets of active voxels, in voxels: how far the farthest voxel of
  /// one is from the other. Exact, except where whole tiles are in one only: within 1 %. Infinite
  /// if one set is empty and the other is not.
  double distance = 0;
  double allowed = 0;  ///< the distance that is no difference: DiffOptions::voxelTolerance

  bool same() const { return (onlyA == 0 && onlyB == 0) || distance <= allowed; }
};

/// How the values of two grids of the same type differ.
struct ValueDiff {
  std::uint64_t compared = 0;       ///< active in both
  std::uint64_t differing = 0;      ///< of these
  double largest = 0;               ///< |a - b|, for vectors of the component that differs most;
                                    ///< infinite for a number and NaN
  double rms = 0;                   ///< root of the mean square of the same
  std::optional<VoxelIndex> first;  ///< lowest that differs
  std::uint64_t inactiveDiffering = 0;  ///< inactive in both: the far side of a level set, say
  bool backgroundDiffers = false;

  bool same() const { return differing == 0 && inactiveDiffering == 0 && !backgroundDiffers; }
};

/// A key or property that differs; "" where it does not exist.
struct TextDiff {
  std::string what;
  std::string a, b;
};

struct GridDiff {
  std::string name;
  bool inA = false;
  bool inB = false;
  std::vector<TextDiff> properties;  ///< type, class, transform, background: those that differ
  std::vector<TextDiff> metadata;    ///< keys that differ
  TopologyDiff topology;
  std::optional<ValueDiff> values;  ///< empty if the types differ, or have no values

  bool same() const {
    return inA && inB && properties.empty() && metadata.empty() && topology.same() &&
           (!values || values->same());
  }
};

struct FileDiff {
  std::vector<TextDiff> metadata;  ///< of the files
  std::vector<GridDiff> grids;     ///< by name

  bool same() const;
};

/// Compares two grids of any type that OpenVDB knows by default, of any tree structure: tiles are
/// the voxels they stand for. Leaf by leaf, in parallel; the same for any number of threads. Leaves
/// that are read on demand are not kept.
/// @throws InputError  the file of a grid is damaged
GridDiff diffGrids(const openvdb::GridBase& a, const openvdb::GridBase& b,
                   const DiffOptions& options);

/// Compares two files grid by grid, by name. The UUID of the files and the statistics that OpenVDB
/// keeps as metadata (file_...) do not count. If libvox wrote both files, and their hashes are
/// right, grids whose nodes and values are the same bytes are not unpacked. All other files are
/// read as a whole, so damage is found even where both have the same.
/// @throws UsageError  a tolerance is negative or not finite
/// @throws InputError  a file cannot be read; a grid of `onlyGrids` is in neither
FileDiff diffVdb(const std::filesystem::path& a, const std::filesystem::path& b,
                 const DiffOptions& options);

/// Writes the differences as grids. For each grid that both files have: the masks NAME_only_a and
/// NAME_only_b, and NAME_difference (float, |a - b| at the voxels of both that differ).
/// @throws InputError, IoError
void writeDifference(const std::filesystem::path& a, const std::filesystem::path& b,
                     const DiffOptions& options, const std::filesystem::path& file, bool overwrite);

}  // namespace vox
