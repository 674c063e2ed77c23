#pragma once

#include "libvox/core/names.h"
#include "libvox/options/grid_kind.h"

#include <optional>
#include <string>
#include <string_view>

namespace vox {

/// Which voxels of an object the grid `density` holds.
enum class Fill {
  kSurface,  ///< the active voxels of the surface
  kSolid,    ///< these and the voxels that they enclose
};
inline constexpr NameTable<Fill, 2> kFillNames = {
    {{Fill::kSurface, "surface"}, {Fill::kSolid, "solid"}}};

/// How the grid `density` ends at the surface.
enum class Edge {
  kHard,  ///< one value at all its voxels
  kSoft,  ///< the part of each voxel's cube that is inside, or within half a voxel of the surface
};
inline constexpr NameTable<Edge, 2> kEdgeNames = {{{Edge::kHard, "hard"}, {Edge::kSoft, "soft"}}};

/// How volumes treat a component of the mesh that has no inside: one with boundary, or one-sided.
enum class OpenMesh {
  kError,     ///< the object is refused
  kSurface,   ///< `density` holds its voxels, `surface` a sheet one voxel thick
  kUnsigned,  ///< as kSurface, but all distances of the grid `surface` are without sign
};
inline constexpr NameTable<OpenMesh, 3> kOpenMeshNames = {{{OpenMesh::kError, "error"},
                                                           {OpenMesh::kSurface, "surface"},
                                                           {OpenMesh::kUnsigned, "unsigned"}}};

/// Whether the surface is there where its images and materials are transparent.
enum class Alpha {
  kKeep,  ///< transparency is not used
  kCut,   ///< a coverage below 1/2 is a hole
};
inline constexpr NameTable<Alpha, 2> kAlphaNames = {{{Alpha::kKeep, "keep"}, {Alpha::kCut, "cut"}}};

/// Lossless compression of the values of a file.
enum class Compression { kBlosc, kZip, kPlain };
inline constexpr NameTable<Compression, 3> kCompressionNames = {
    {{Compression::kBlosc, "blosc"}, {Compression::kZip, "zip"}, {Compression::kPlain, "none"}}};

/// The program that is to read the file.
enum class Target {
  kBlender,    ///< z is up
  kBlender34,  ///< z is up; moved by half a voxel, because Blender 3.4 draws voxel i from i to i+1
  kHoudini,    ///< y is up; grids have the names that are usual there
};
inline constexpr NameTable<Target, 3> kTargetNames = {{{Target::kBlender, "blender"},
                                                       {Target::kBlender34, "blender-3.4"},
                                                       {Target::kHoudini, "houdini"}}};

/// The axis that points up in the input.
enum class UpAxis { kY, kZ };
inline constexpr NameTable<UpAxis, 2> kUpAxisNames = {{{UpAxis::kY, "y"}, {UpAxis::kZ, "z"}}};

/// How far the grid `surface` holds distances on each side of the surface, in voxels.
struct BandWidths {
  double in = 0, out = 0;

  constexpr BandWidths(double both) : in(both), out(both) {}
  constexpr BandWidths(double inside, double outside) : in(inside), out(outside) {}
  friend bool operator==(const BandWidths&, const BandWidths&) = default;
  bool isSymmetric() const { return in == out; }
};

/// Reads one width for both sides, "3", or "IN,OUT". Nothing if the text is neither.
std::optional<BandWidths> bandWidthsIn(std::string_view text);

inline constexpr double kDefaultBand = 3;  ///< voxels

inline constexpr int kWidestClosing = 1000;  ///< voxels

/// Blender's shading shows the stairs of hard densities. Without a target they stay hard: the
/// values of a grid that programs compare.
constexpr Edge defaultEdge(const std::optional<Target>& target) {
  return target && *target != Target::kHoudini ? Edge::kSoft : Edge::kHard;
}

/// How to make volumes. A value that is not set comes from the scene, else from the default.
struct VolumeOptions {
  std::optional<Fill> fill;                ///< default: kSurface
  std::optional<Edge> edge;                ///< default: defaultEdge(target)
  std::optional<double> gain;              ///< value of `density` at its voxels; see densityValue()
  std::optional<Alpha> alpha;              ///< default: kKeep
  std::optional<OpenMesh> openMesh;        ///< default: kSurface
  std::optional<int> close;                ///< voxels; default: 0, nothing is closed
  std::optional<BandWidths> band;          ///< default: kDefaultBand on both sides
  std::optional<double> tolerance;         ///< voxels; has no effect: distances are exact
  std::optional<bool> half;                ///< true: values of 16 bits; default: false, 32 bits
  std::optional<Compression> compression;  ///< default: kBlosc, if OpenVDB has it
  std::optional<Target> target;            ///< default: kBlender
  std::optional<UpAxis> up;                ///< default: as in the target, so that nothing turns
};

/// The same with defaults applied.
struct VolumeSettings {
  Fill fill = Fill::kSurface;
  Edge edge = Edge::kHard;
  Alpha alpha = Alpha::kKeep;
  OpenMesh openMesh = OpenMesh::kSurface;
  int close = 0;  ///< openings of the voxels that are narrower are closed (volume/close.h)
  BandWidths band = kDefaultBand;
  std::optional<double> tolerance = {};  ///< voxels; has no effect
  bool half = false;
  Target target = Target::kBlender;
  std::optional<double> gain = {};  ///< empty: what suits target and voxel size, densityValue()
  std::optional<Compression> compression = {};  ///< empty: as writeVdb() chooses
};

/// Name of a grid in a file.
std::string gridNameFor(GridKind kind, Target target);

/// Checks the numbers among the settings.
/// @throws UsageError  one is out of range
void requireValid(const VolumeSettings& settings);

}  // namespace vox
