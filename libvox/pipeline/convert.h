#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/grid/transform.h"
#include "libvox/io/scene_file.h"
#include "libvox/options/convert_options.h"
#include "libvox/pipeline/conversion_report.h"
#include "libvox/pipeline/estimate.h"
#include "libvox/pipeline/request.h"

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vox {

class Progress;

struct Conversion {
  std::vector<std::shared_ptr<openvdb::GridBase>> grids;  ///< one transform, in the order asked for
  std::optional<Compression> compression;                 ///< of their file; default: as writeVdb
  ConvertReport report;
};

/// Smooths every object of a scene by Doo-Sabin subdivision and converts it into shared OpenVDB
/// grids. An object is subdivided until its faces meet the vertex-conversion criterion, or to a
/// stop rule and its polygons scanned (choose.h). Either way the active voxels 6-separate the two
/// sides of each surface, or 26-separate them if the options ask for that. Grids carry the metadata
/// of DESIGN section 14. The result does not depend on the number of threads, nor on how the
/// surface is cut into submeshes. The progress keeps a share for writing the grids.
///
/// @throws UsageError  dim, voxel size, number of threads or weld tolerance is nonsense; as resolve
/// @throws InputError  the input has no extent and no voxel size is given
/// @throws MeshError   as prepare (refine.h); an object has no inside, and the options need one
/// @throws LimitError  not enough memory, or coordinates or voxel size beyond the range of the grid
/// @throws Cancelled   options.run.progress is cancelled
Conversion convert(const Scene& scene, const ConvertOptions& options);

/// The same with options that are resolved already.
/// @param request  resolved for this scene
Conversion convert(const Scene& scene, const Request& request);

/// The same, but may use up the points and faces of the scene, which saves their memory.
Conversion convert(Scene&& scene, const Request& request);

/// Box of all objects without the components that are dropped, world units. The `dim` voxels lie
/// along its longest side.
/// @param preparations  one for each object
/// @throws MeshError  all components of an object are dropped
Box boxOf(const Scene& scene, std::span<const ObjectPreparation> preparations);

/// What convert would make, and its warnings, without making it.
/// @throws as convert, except that grids which do not fit are no error: see Estimate::refusal
Estimate estimate(const Scene& scene, const ConvertOptions& options,
                  std::vector<std::string>& warnings);

/// The same with options that are resolved already.
/// @param request  resolved for this scene
Estimate estimate(const Scene& scene, const Request& request, std::vector<std::string>& warnings);

/// Of each grid its name, and its bytes in memory.
std::vector<std::string> namesOf(const Conversion& conversion);
std::vector<std::uint64_t> memoryOf(const Conversion& conversion);

/// Writes grids to a new file, .nvdb for NanoVDB's format: complete or not at all, equal input
/// giving equal bytes.
/// @param progress  that of the conversion, of which this is the last stage; or none
/// @throws IoError  cannot be written, or exists and `overwrite` is false
/// @throws Cancelled
void writeGrids(const std::filesystem::path& file, const Conversion& conversion, bool overwrite,
                Progress* progress = nullptr);

/// The same in OpenVDB's format, to a stream that must be readable, writable, seekable and empty.
void writeGrids(std::iostream& stream, const Conversion& conversion, Progress* progress = nullptr);

}  // namespace vox
