#pragma once

#include "apps/vox/command.h"
#include "libvox/io/scene_file.h"
#include "libvox/options/convert_options.h"

#include <optional>
#include <string>
#include <vector>

namespace vox::app {

/// Options that several subcommands share.
struct CommonOptions {
  RunOptions run;
  bool force = false;
  bool quiet = false;
  bool verbose = false;
  bool progressLines = false;  ///< of commands with addProgressOption
};
void addCommonOptions(const Command& command, CommonOptions& common);

/// --progress.
void addProgressOption(const Command& command, CommonOptions& common);

/// --threads and --max-memory.
void addRunOptions(const Command& command, RunOptions& run);

/// --dim, --voxel-size, --like, --clip and --bounds, as typed.
struct ResolutionOptions {
  std::optional<int> dim;
  std::optional<double> voxelSize;
  std::string like;
  bool clip = false;
  std::string bounds;
};
void addResolutionOptions(const Command& command, ResolutionOptions& resolution);

/// --crease, --crease-edges and --corner-vertices, as typed.
struct CreaseArguments {
  std::string rule;
  std::string edgeFile;
  std::string cornerFile;
  std::optional<std::vector<PointPair>> edges = {};  ///< in place of the file; no option
  std::optional<std::vector<Index>> corners = {};    ///< the same
};
void addCreaseOptions(const Command& command, CreaseArguments& arguments);

/// Sets what they give; reads the files.
/// @throws UsageError, InputError
void parseCreases(const CreaseArguments& arguments, SmoothingOptions& smoothing);

/// --boundary, --interpolate, --faces, --crease and the files of vertices and edges, as typed.
struct SmoothingArguments {
  std::string boundary;
  std::string faces;
  std::string interpolate;
  std::string vertexFile;
  std::optional<std::vector<Index>> vertices = {};  ///< in place of the file; no option
  CreaseArguments creases;
};
void addSmoothingOptions(const Command& command, SmoothingArguments& arguments);

/// --boundary alone.
void addBoundaryOption(const Command& command, std::string& boundary);
/// @throws UsageError
std::optional<BoundaryRule> parseBoundary(const std::string& boundary);

/// --faces alone.
void addFacesOption(const Command& command, std::string& faces);
/// @throws UsageError
std::optional<FaceRule> parseFaces(const std::string& faces);

/// Their values; reads the files.
/// @throws UsageError, InputError
SmoothingOptions parseSmoothing(const SmoothingArguments& arguments);

/// --until, --voxelize and --separating, as typed.
struct VoxelizationArguments {
  std::vector<std::string> until;
  std::string voxelize;
  std::string separating;
};
void addVoxelizationOptions(const Command& command, VoxelizationArguments& arguments);

/// Their values; empty if they are not given.
/// @throws UsageError
std::optional<StopRule> parseUntil(const VoxelizationArguments& arguments);
Separation parseSeparation(const VoxelizationArguments& arguments);

/// --fill, --edge, --alpha, --gain, --open-mesh, --close, --band, --tolerance, --half,
/// --compression, --target and --up, as typed.
struct VolumeArguments {
  std::string fill;
  std::string edge;
  std::string alpha;
  std::string openMesh;
  std::string compression;
  std::string target;
  std::string up;
  std::optional<double> gain;
  std::optional<int> close;
  std::optional<BandWidths> band;
  std::optional<double> tolerance;
  std::optional<bool> half;
};
void addVolumeOptions(const Command& command, VolumeArguments& arguments);
void addFileOptions(const Command& command, VolumeArguments& arguments);

/// Their values.
/// @throws UsageError
VolumeOptions parseVolume(const VolumeArguments& arguments);

/// --weld.
void addWeldOption(const Command& command, std::optional<double>& tolerance);

/// --scale.
void addScaleOption(const Command& command, std::optional<double>& scale);

/// --drop-components.
void addDropOption(const Command& command, std::optional<ComponentLimit>& limit);

/// --strict; --strict=false overrides a scene.
void addStrictOption(const Command& command, std::optional<bool>& strict);

/// --localize and --submesh-faces, as typed.
struct SubmeshArguments {
  std::string localize;
  Index submeshFaces = kDefaultSubmeshFaces;
};
void addSubmeshOptions(const Command& command, SubmeshArguments& arguments);
/// @throws UsageError
SurfaceOptions parseSubmeshes(const SubmeshArguments& arguments);

/// Options of vox convert and vox render that tell how a mesh or scene becomes voxels, as typed.
struct ConversionArguments {
  std::optional<double> scale;
  ResolutionOptions resolution;
  SmoothingArguments smoothing;
  VoxelizationArguments voxelization;
  std::optional<double> weldTolerance;
  std::optional<ComponentLimit> dropComponents;
  std::optional<bool> strict;
  SubmeshArguments submeshes;
  std::string texture;
};
/// All but --localize, --submesh-faces and --texture.
void addConversionOptions(const Command& command, ConversionArguments& arguments);
/// Their values; reads the file of vertices.
/// @throws UsageError, InputError
ConvertOptions parseConversion(const ConversionArguments& arguments, const RunOptions& run);

/// --part-by and --split, as typed.
struct PartArguments {
  std::string partBy;
  std::string split;
};
void addPartOptions(const Command& command, PartArguments& arguments);
/// Sets what they give.
/// @throws UsageError
void parseParts(const PartArguments& arguments, ConvertOptions& options);

/// "density,mask" as grids.
/// @throws UsageError  an unknown name
std::vector<GridKind> parseGrids(const std::string& names);

/// "-": data goes to standard output.
bool isStdout(const std::string& file);

/// True if two names mean the same file, which need not exist.
bool isSameFile(const std::string& a, const std::string& b);

/// Checks, before the work starts, that the output can be written and is none of the inputs.
/// @throws IoError, UsageError
void requireOutput(const std::string& output, const CommonOptions& common, const Scene& scene);

/// Checks, before the work starts, that the file of an option can be written and is none of the
/// inputs. Nothing is checked if it is not given.
/// @param option     "--report"
/// @param extension  that its name must have, ".html"
/// @throws IoError, UsageError
void requireOutput(const std::string& output, const std::string& option,
                   const std::string& extension, const std::vector<std::string>& inputs,
                   bool overwrite);

/// The fewest digits that are this number when they are read.
std::string shortestText(double number);

/// Prints one line on stderr, unless --quiet: "vox: TEXT".
void say(const CommonOptions& common, const std::string& text);

}  // namespace vox::app
