#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/grid/transform.h"
#include "libvox/io/scene_file.h"
#include "libvox/options/grid_kind.h"
#include "libvox/options/preparation_options.h"
#include "libvox/options/run_options.h"
#include "libvox/options/stop_rule.h"
#include "libvox/options/texture_spec.h"
#include "libvox/options/volume_options.h"
#include "libvox/pipeline/estimate.h"
#include "libvox/pipeline/polygons.h"
#include "libvox/pipeline/surface.h"
#include "libvox/prepare/interpolate.h"
#include "libvox/voxelize/vertex_sink.h"

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vox {

/// How to convert. What is not set here is taken from the scene, then from the default.
struct ConvertOptions : PreparationOptions {
  std::optional<int> dim;           ///< voxels along the longest side of the input; default 256
  std::optional<double> voxelSize;  ///< world units; overrides dim
  std::optional<std::vector<GridKind>> grids;  ///< default: density
  std::optional<StopRule> until;               ///< default: voxel
  std::optional<Voxelize> voxelize;            ///< default: auto
  Separation separation = Separation::k6;
  VolumeOptions volume;
  /// Of all objects, instead of their own textures and colours; adds the color grid to those of the
  /// scene.
  std::optional<TextureSpec> texture;
  SurfaceOptions surface;
  RunOptions run;
};

inline constexpr int kDefaultDim = 256;

/// What happened to one object.
struct ObjectReport {
  std::string name;
  std::uint64_t inputFaces = 0;
  Index submeshes = 0;
  int levels = 0;                  ///< Doo-Sabin steps down to the deepest vertex
  std::uint64_t vertices = 0;      ///< vertices rounded to voxels, each at its own level
  LevelCounts verticesOfLevel{};   ///< how many of them at each level
  std::uint64_t activeVoxels = 0;  ///< that no object before it has
  bool byPolygons = false;         ///< rather than by vertices
  StopRule until;                  ///< what its polygons were refined to
  PolygonReport polygons;
  InterpolationReport interpolation;  ///< its residual in world units
};

struct ConvertReport {
  double voxelSize = 0;  ///< world units
  std::vector<ObjectReport> objects;
  std::uint64_t activeVoxels = 0;     ///< black voxels, or those of the grid if none were made
  std::vector<std::string> warnings;  ///< one line each: what the user may not expect
  int threads = 0;                    ///< that there were to use
  double prepareSeconds = 0;
  double surfaceSeconds = 0;  ///< subdivision and voxelization
  double gridsSeconds = 0;    ///< from voxels to the grids asked for
};

struct Conversion {
  std::vector<std::shared_ptr<openvdb::GridBase>> grids;  ///< one transform, in the order asked for
  std::optional<Compression> compression;                 ///< of their file; default: as writeVdb
  ConvertReport report;
};

/// Smooths every object of a scene by Doo-Sabin subdivision and converts it into shared OpenVDB
/// grids. An object is subdivided until its faces meet the vertex-conversion criterion, or to a
/// stop rule and its polygons scanned (choose.h); either way the active voxels 6-separate the two
/// sides of each surface, or 26-separate them if that is asked for. Grids carry the metadata of
/// DESIGN section 9. The result does not depend on the number of threads, nor on how the surface is
/// cut into submeshes. The progress keeps a share for writing the grids.
///
/// @throws UsageError  dim, voxel size, gain, number of threads, stop rule, smoothing or weld
///   tolerance is nonsense; vertex conversion is asked for where it cannot be; a texture is asked
///   for without the color grid
/// @throws InputError  the input has no extent and no voxel size is given
/// @throws MeshError   as prepare (refine.h); an object has no inside, and one is asked for
/// @throws LimitError  not enough memory, or coordinates or voxel size beyond the range of the grid
/// @throws Cancelled   options.run.progress says so
Conversion convert(const Scene& scene, const ConvertOptions& options);

/// Box of all objects, world units: of its longest side are the voxels of `dim`.
Box boxOf(const Scene& scene);

/// What convert would make, without making it; besides, its warnings.
/// @throws as convert, except that grids which do not fit are no error: see Estimate::refusal
Estimate estimate(const Scene& scene, const ConvertOptions& options,
                  std::vector<std::string>& warnings);

/// Writes grids to a new file: complete or not at all, equal input giving equal bytes.
/// @param progress  that of the conversion, of which this is the last stage; or none
/// @throws IoError  cannot be written, or exists and `overwrite` is false
/// @throws Cancelled
void writeGrids(const std::filesystem::path& file, const Conversion& conversion, bool overwrite,
                Progress* progress = nullptr);

/// The same to a stream that must be readable, writable, seekable and empty.
void writeGrids(std::iostream& stream, const Conversion& conversion, Progress* progress = nullptr);

}  // namespace vox
