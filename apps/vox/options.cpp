// Options that several subcommands share.

#include "apps/vox/options.h"

#include "libvox/core/error.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/input_file.h"
#include "libvox/io/read_indices.h"
#include "libvox/io/read_lattice.h"
#include "libvox/options/voxelize.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <sstream>
#include <string_view>
#include <system_error>

namespace vox::app {
namespace {

/// "2GiB", "512M" or a number of bytes.
std::uint64_t parseBytes(const std::string& text) {
  std::size_t used = 0;
  double value = -1;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  std::string unit = text.substr(used);
  std::transform(unit.begin(), unit.end(), unit.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (unit.size() > 1 && unit.back() == 'b') unit.pop_back();
  if (unit.size() > 1 && unit.back() == 'i') unit.pop_back();
  constexpr std::string_view kUnits = "bkmgt";
  const std::size_t power = unit.empty() ? 0 : kUnits.find(unit);
  const bool known = unit.size() <= 1 && power != std::string_view::npos;
  const double bytes = known ? value * std::pow(1024.0, static_cast<double>(power)) : -1;
  if (used == 0 || !(bytes >= 1) || bytes > 1e18)
    throw UsageError("--max-memory: must be a size such as 512M or 8G, not " + text);
  return static_cast<std::uint64_t>(bytes);
}

BandWidths parseBand(const std::string& text) {
  const auto band = bandWidthsIn(text);
  if (!band)
    throw UsageError(
        "--band must be a number of voxels, or two with a comma (inside, outside), not '" + text +
        "'");
  return *band;
}

/// Value of an option by its name; nothing if it was not given.
template <class Enum, std::size_t N>
std::optional<Enum> parseNamed(const char* option, const NameTable<Enum, N>& names,
                               const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto value = namedIn(names, text);
  if (!value)
    throw UsageError(std::string(option) + " must be one of " + allNamesIn(names) + ", not '" +
                     text + "'");
  return value;
}

}  // namespace

void addRunOptions(const Command& command, RunOptions& run) {
  constexpr int kMostThreads = 1024;
  command.add("--threads", run.threads, "Threads to use (default: all processors)")
      .range(1, kMostThreads)
      .type("N")
      .group("Run");
  command
      .add(
          "--max-memory", [&run](const std::string& text) { run.maxMemory = parseBytes(text); },
          "Memory for meshes, images and grids, such as 512M or 8G (default: three quarters of "
          "what is "
          "available)")
      .type("SIZE")
      .group("Run");
}

void addCommonOptions(const Command& command, CommonOptions& common) {
  addRunOptions(command, common.run);
  command.addFlag("-f,--force", common.force, "Overwrite an existing output file").group("Run");
  command.addFlag("-q,--quiet", common.quiet, "Print errors only").group("Run");
  command.addFlag("-v,--verbose", common.verbose, "Print what was done to each object, and times")
      .group("Run");
}

void addProgressOption(const Command& command, CommonOptions& common) {
  command
      .addFlag("--progress", common.progressLines,
               "Print the progress on stderr as lines such as 'vox: 37% write', for programs that "
               "start vox. A sequence starts at 0% with each file")
      .group("Run");
}

void addResolutionOptions(const Command& command, ResolutionOptions& resolution) {
  const Option dim =
      command
          .add("--dim", resolution.dim,
               "Voxels along the longest side of the input (default: the scene's, or 256)")
          .range(1, std::numeric_limits<int>::max())
          .type("N")
          .group("Resolution");
  const Option size = command
                          .add("--voxel-size", resolution.voxelSize,
                               "Edge length of a voxel in world units, instead of --dim")
                          .excludes(dim)
                          .type("S")
                          .group("Resolution");
  command
      .add(
          "--like", resolution.like,
          "Take voxel size and place of the voxels from the first grid of a file, or from the grid "
          "NAME, instead of --dim or --voxel-size, also those of a scene: then the voxels of both "
          "outputs coincide")
      .excludes(dim)
      .excludes(size)
      .type("REF.vdb[:NAME]")
      .group("Resolution");
  command
      .addFlag("--clip", resolution.clip,
               "Make only voxels in the box of the active voxels of the grid of --like")
      .group("Resolution");
  command
      .add("--bounds", resolution.bounds,
           "Make only voxels whose centres lie in a box. Its corners are in world units of the "
           "input "
           "(after --scale, before --up turns it). --dim still counts along the whole input "
           "(default: the scene's, or no box)")
      .type("X0,Y0,Z0,X1,Y1,Z1")
      .group("Resolution");
}

void addCreaseOptions(const Command& command, CreaseArguments& arguments) {
  command
      .add("--crease", arguments.rule,
           "Edges that stay sharp: those whose faces turn by more than DEG degrees, those between "
           "the smoothing groups of an OBJ file (groups), or both (40,groups) (default: the "
           "scene's, or none)")
      .type("DEG|groups")
      .group("Smoothing");
  command
      .add("--crease-edges", arguments.edgeFile,
           "Text file of further sharp edges, each as two numbers of vertices, counted from 0, "
           "separated by blanks; # starts a comment")
      .type("FILE")
      .group("Smoothing");
  command
      .add("--corner-vertices", arguments.cornerFile,
           "Text file with the numbers of vertices that the surface passes through in a sharp "
           "corner, counted from 0, separated by blanks; # starts a comment")
      .type("FILE")
      .group("Smoothing");
}

void addBoundaryOption(const Command& command, std::string& boundary) {
  command
      .add("--boundary", boundary,
           "Where an open surface ends: at a smooth curve along the boundary of the mesh "
           "(extend), the same but with corners at vertices that only one face has (corners), or "
           "short of it, because smoothing shrinks the surface (free) (default: the scene's, or "
           "extend)")
      .type("extend|corners|free")
      .group("Smoothing");
}

std::optional<BoundaryRule> parseBoundary(const std::string& boundary) {
  return parseNamed("--boundary", kBoundaryRuleNames, boundary);
}

void addSmoothingOptions(const Command& command, SmoothingArguments& arguments) {
  addBoundaryOption(command, arguments.boundary);
  command
      .add("--interpolate", arguments.interpolate,
           "Vertices that the surface passes through: none, interior, boundary or both "
           "(default: the scene's, or none)")
      .type("WHICH")
      .group("Smoothing");
  command
      .add("--interpolate-vertices", arguments.vertexFile,
           "Text file with the numbers of interior vertices that the surface passes through, in "
           "addition to those of --interpolate, counted from 0, separated by blanks; # starts a "
           "comment")
      .type("FILE")
      .group("Smoothing");
  addCreaseOptions(command, arguments.creases);
  addFacesOption(command, arguments.faces);
}

void addFacesOption(const Command& command, std::string& faces) {
  command
      .add("--faces", faces,
           "Concave faces: those that smoothing would fold over, because they are not star-shaped "
           "about the mean of their corners, are split into convex faces (split) or stay as they "
           "are (keep). With --until levels=0 they stay (default: the scene's, or split)")
      .type("split|keep")
      .group("Smoothing");
}

std::optional<FaceRule> parseFaces(const std::string& faces) {
  return parseNamed("--faces", kFaceRuleNames, faces);
}

void parseCreases(const CreaseArguments& arguments, SmoothingOptions& smoothing) {
  if (!arguments.rule.empty()) {
    smoothing.crease = creaseRuleNamed(arguments.rule);
    if (!smoothing.crease)
      throw UsageError("--crease must be " + std::string(kAllCreaseRuleNames) + ", not '" +
                       arguments.rule + "'");
  }
  smoothing.creaseEdges = arguments.edges;
  smoothing.cornerVertices = arguments.corners;
  if (!arguments.edgeFile.empty()) smoothing.creaseEdges = readIndexPairs(arguments.edgeFile);
  if (!arguments.cornerFile.empty()) smoothing.cornerVertices = readIndices(arguments.cornerFile);
}

SmoothingOptions parseSmoothing(const SmoothingArguments& arguments) {
  SmoothingOptions smoothing;
  smoothing.boundary = parseBoundary(arguments.boundary);
  smoothing.interpolate = parseNamed("--interpolate", kInterpolateNames, arguments.interpolate);
  smoothing.faces = parseFaces(arguments.faces);
  smoothing.interpolatedVertices = arguments.vertices;
  if (!arguments.vertexFile.empty())
    smoothing.interpolatedVertices = readIndices(arguments.vertexFile);
  parseCreases(arguments.creases, smoothing);
  return smoothing;
}

void addVoxelizationOptions(const Command& command, VoxelizationArguments& arguments) {
  command
      .addRepeatable(
          "--until", arguments.until,
          "How far to subdivide: down to the size of a voxel (voxel), or until the polygons keep a "
          "limit; then all voxels that the polygons meet are marked. Limits: levels=K steps (0: "
          "the polygons of the input), faces of at most diameter=D voxels, at most angle=DEG "
          "degrees between adjacent faces, at most flatness=D voxels from the smooth surface. Of "
          "several limits, with commas (angle=5,diameter=8), the first to be met counts (default: "
          "the "
          "scene's, or voxel)")
      .type("voxel|levels=K|diameter=D|angle=DEG|flatness=D")
      .group("Voxels");
  command
      .add("--voxelize", arguments.voxelize,
           "How the surface becomes voxels: by its vertices (vertex; needs --until voxel), by scan "
           "conversion of its polygons (polygon), or by vertices where --until and --separating "
           "allow it (auto) (default: the scene's, or auto)")
      .type("auto|vertex|polygon")
      .group("Voxels");
  command
      .add("--separating", arguments.separating,
           "Paths of inactive voxels that the surface stops: those through faces (6), or "
           "also those through edges and corners (26) (default: 6)")
      .type("6|26")
      .group("Voxels");
}

std::optional<StopRule> parseUntil(const VoxelizationArguments& arguments) {
  if (arguments.until.empty()) return std::nullopt;
  std::string all;
  for (const std::string& name : arguments.until) all += (all.empty() ? "" : ",") + name;
  const auto rule = stopRuleNamed(all);
  if (!rule)
    throw UsageError("--until must be one of " + allStopRuleNames() + ", not '" + all + "'");
  return rule;
}

Separation parseSeparation(const VoxelizationArguments& arguments) {
  if (arguments.separating.empty() || arguments.separating == "6") return Separation::k6;
  if (arguments.separating == "26") return Separation::k26;
  throw UsageError("--separating must be 6 or 26, not '" + arguments.separating + "'");
}

void addVolumeOptions(const Command& command, VolumeArguments& arguments) {
  command
      .add("--fill", arguments.fill,
           "What the grid density holds: the voxels of the surface (surface), or these and "
           "all voxels that they enclose (solid) (default: the scene's, or surface)")
      .type("surface|solid")
      .group("Output");
  command
      .add("--edge", arguments.edge,
           "How the grid density ends at the surface: all its voxels have one value (hard), or the "
           "value is multiplied by the part of the voxel that is inside, without --fill solid by "
           "the part within half a voxel of the surface (soft) (default: the scene's, or soft if "
           "Blender is named as the target, else hard)")
      .type("hard|soft")
      .group("Output");
  command
      .add("--alpha", arguments.alpha,
           "Where images and materials are transparent: the surface is there all the same (keep), "
           "or it has a hole where they cover less than half (cut) (default: the scene's, or keep)")
      .type("keep|cut")
      .group("Output");
  command
      .add("--gain", arguments.gain,
           "Value of the grid density at its voxels (default: the scene's, or 6 / voxel size, at "
           "least 1, which makes a surface opaque in Blender; 1 for --target houdini)")
      .type("G")
      .group("Output");
  command
      .add("--open-mesh", arguments.openMesh,
           "What happens to a component without an inside, if --fill solid or the grid surface "
           "needs one: an error (error); it stays a surface, one voxel thick in the grid surface "
           "(surface); or its distances there have no sign (unsigned) (default: the scene's, or "
           "surface)")
      .type("error|surface|unsigned")
      .group("Output");
  command
      .add("--close", arguments.close,
           "For --fill solid and the grid surface: close openings of the voxel surface that are "
           "narrower than N voxels and lead to a space at least N voxels wide. Closed meshes and "
           "the grid mask do not change (default: the scene's, or 0: none)")
      .range(0, kWidestClosing)
      .type("N")
      .group("Output");
  command
      .add(
          "--band", [&arguments](const std::string& text) { arguments.band = parseBand(text); },
          "How far from the surface the grid surface holds distances, in voxels: on both sides, or "
          "inside and outside, each from 1 to 1000 (default: the scene's, or 3)")
      .type("[IN,]OUT")
      .group("Output");
  command
      .add("--tolerance", arguments.tolerance,
           "Has no effect any more, and gives a warning: the grid surface is computed from the "
           "smooth surface itself, not from polygons near it")
      .type("T")
      .group("Output");
}

void addFileOptions(const Command& command, VolumeArguments& arguments) {
  command
      .addFlag(
          "--half", arguments.half,
          "Write values as floats of 16 bits; a grid with values that these cannot hold keeps 32, "
          "with a warning (default: the scene's, or 32 bits)")
      .group("Output");
  command
      .add("--compression", arguments.compression,
           "Compression of the file: blosc is fast, zip is slow, both are without loss "
           "(default: the scene's, or blosc)")
      .type("blosc|zip|none")
      .group("Output");
  command
      .add("--target", arguments.target,
           "Program that will read the file. It decides the names of grids, which way is up, and "
           "the default of --edge; blender-3.4 also moves all grids by half a voxel, because that "
           "version draws them so far off (default: the scene's, or none: names of grids as for "
           "Blender)")
      .type("blender|blender-3.4|houdini")
      .group("Output");
  command
      .add("--up", arguments.up,
           "Axis of the input that points up. The model is turned if another axis points up "
           "in the target: z in Blender, y in Houdini (default: the scene's, or nothing is "
           "turned)")
      .type("y|z")
      .group("Output");
}

VolumeOptions parseVolume(const VolumeArguments& arguments) {
  VolumeOptions volume;
  volume.fill = parseNamed("--fill", kFillNames, arguments.fill);
  volume.edge = parseNamed("--edge", kEdgeNames, arguments.edge);
  volume.alpha = parseNamed("--alpha", kAlphaNames, arguments.alpha);
  volume.openMesh = parseNamed("--open-mesh", kOpenMeshNames, arguments.openMesh);
  volume.compression = parseNamed("--compression", kCompressionNames, arguments.compression);
  volume.target = parseNamed("--target", kTargetNames, arguments.target);
  volume.up = parseNamed("--up", kUpAxisNames, arguments.up);
  volume.half = arguments.half;
  volume.gain = arguments.gain;
  volume.close = arguments.close;
  volume.band = arguments.band;
  volume.tolerance = arguments.tolerance;
  return volume;
}

void addPartOptions(const Command& command, PartArguments& arguments) {
  command
      .add("--part-by", arguments.partBy,
           "What the grid part numbers: objects of the scene and of mesh files (object), groups of "
           "faces (group), or materials (material) (default: the scene's, or the first of these of "
           "which the input has several)")
      .type("object|group|material")
      .group("Output");
  command
      .add("--split", arguments.split,
           "Write one density grid for each part in place of the grid density: by --part-by "
           "(part), or by objects (object). Grids have the names of the parts, with _ in place of "
           "all but letters and digits (default: the scene's, or one grid)")
      .type("part|object")
      .group("Output");
}

void parseParts(const PartArguments& arguments, ConvertOptions& options) {
  options.partBy = parseNamed("--part-by", kPartByNames, arguments.partBy);
  options.split = parseNamed("--split", kSplitNames, arguments.split);
}

void addWeldOption(const Command& command, std::optional<double>& tolerance) {
  command
      .add(
          "--weld", tolerance,
          "Join vertices up to this far apart, in world units, and join vertices to edges of other "
          "faces that are as near (default: the scene's, or 0: only what coincides)")
      .type("TOL")
      .group("Repair");
}

void addScaleOption(const Command& command, std::optional<double>& scale) {
  command
      .add(
          "--scale", scale,
          "Factor for all coordinates of the input, if its unit is wrong; lengths of other options "
          "are those after it (default: the scene's, or 1)")
      .type("S")
      .group("Resolution");
}

void addDropOption(const Command& command, std::optional<ComponentLimit>& limit) {
  command
      .add(
          "--drop-components",
          [&limit](const std::string& text) {
            limit = componentLimitIn(text);
            if (!limit)
              throw UsageError(
                  "--drop-components must be below=N (faces), size=X (world units) "
                  "or both with a comma, not '" +
                  text + "'");
          },
          "Leave out debris: components of fewer than N faces, or with a box whose diagonal is "
          "shorter than X world units (below=9,size=0.1: both kinds); --dim counts along what "
          "remains (default: the scene's, or none)")
      .type("below=N|size=X")
      .group("Repair");
}

void addStrictOption(const Command& command, std::optional<bool>& strict) {
  command
      .addFlag(
          "--strict", strict,
          "Refuse a mesh that needs any repair or turning of faces, whose file is not quite of its "
          "format, or that lacks edges or groups that should be sharp (default: the scene's, or "
          "repair it and say what was done)")
      .group("Repair");
}

void addSubmeshOptions(const Command& command, SubmeshArguments& arguments) {
  command
      .add("--localize", arguments.localize,
           "How the work is divided into tasks: one for each submesh (before); large patches of a "
           "submesh become further tasks (during, the default); or not at all: the whole mesh is "
           "subdivided level by level, slowly and in much memory, for comparison (off)")
      .type("before|during|off")
      .group("Submeshes");
  constexpr Index kMostFaces = Index{1} << 31U;
  command
      .add("--submesh-faces", arguments.submeshFaces,
           "Faces of a submesh (default: " + std::to_string(kDefaultSubmeshFaces) + ")")
      .range(Index{1}, kMostFaces)
      .type("N")
      .group("Submeshes");
}

SurfaceOptions parseSubmeshes(const SubmeshArguments& arguments) {
  SurfaceOptions surface;
  surface.submeshFaces = arguments.submeshFaces;
  surface.localize = parseNamed("--localize", kLocalizeNames, arguments.localize)
                         .value_or(SurfaceOptions().localize);
  return surface;
}

namespace {

/// "x0,y0,z0,x1,y1,z1".
std::array<double, 6> parseBounds(const std::string& text) {
  std::array<double, 6> bounds{};
  std::size_t count = 0;
  bool isRead = true;
  std::istringstream list(text + ",");
  for (std::string word; isRead && std::getline(list, word, ',');) {
    const char* const end = word.data() + word.size();
    double number = 0;
    const auto [rest, error] = std::from_chars(word.data(), end, number);
    isRead = error == std::errc() && rest == end && std::isfinite(number) && count < bounds.size();
    if (isRead) bounds[count++] = number;
  }
  if (!isRead || count != bounds.size())
    throw UsageError("--bounds must be six numbers, x0,y0,z0,x1,y1,z1, not '" + text + "'");
  return bounds;
}

void applyResolution(const ResolutionOptions& resolution, ConvertOptions& parsed) {
  parsed.dim = resolution.dim;
  parsed.voxelSize = resolution.voxelSize;
  if (!resolution.bounds.empty()) parsed.bounds = parseBounds(resolution.bounds);
  if (resolution.clip && resolution.like.empty())
    throw UsageError("--clip needs --like: the file whose extent it takes");
  if (resolution.like.empty()) return;
  const FileLattice lattice = readLattice(resolution.like, resolution.clip);
  parsed.voxelSize = lattice.voxelSize;
  parsed.origin = lattice.origin;
  parsed.clip = lattice.activeBox;
}

}  // namespace

void addConversionOptions(const Command& command, ConversionArguments& arguments) {
  addResolutionOptions(command, arguments.resolution);
  addScaleOption(command, arguments.scale);
  addSmoothingOptions(command, arguments.smoothing);
  addVoxelizationOptions(command, arguments.voxelization);
  addWeldOption(command, arguments.weldTolerance);
  addDropOption(command, arguments.dropComponents);
  addStrictOption(command, arguments.strict);
}

ConvertOptions parseConversion(const ConversionArguments& arguments, const RunOptions& run) {
  ConvertOptions parsed;
  parsed.scale = arguments.scale;
  applyResolution(arguments.resolution, parsed);
  parsed.smoothing = parseSmoothing(arguments.smoothing);
  parsed.until = parseUntil(arguments.voxelization);
  parsed.voxelize = parseNamed("--voxelize", kVoxelizeNames, arguments.voxelization.voxelize);
  parsed.separation = parseSeparation(arguments.voxelization);
  parsed.weldTolerance = arguments.weldTolerance;
  parsed.dropComponents = arguments.dropComponents;
  parsed.strict = arguments.strict;
  parsed.surface = parseSubmeshes(arguments.submeshes);
  if (!arguments.texture.empty()) parsed.texture = parseTexture(arguments.texture);
  parsed.run = run;
  return parsed;
}

std::vector<GridKind> parseGrids(const std::string& names) {
  std::vector<GridKind> grids;
  std::istringstream list(names);
  for (std::string name; std::getline(list, name, ',');) {
    const auto kind = namedIn(kGridNames, name);
    if (!kind)
      throw UsageError("--grids: unknown grid '" + name + "'; known are " + allNamesIn(kGridNames));
    if (std::find(grids.begin(), grids.end(), *kind) == grids.end()) grids.push_back(*kind);
  }
  if (grids.empty()) throw UsageError("--grids names no grid; known are " + allNamesIn(kGridNames));
  return grids;
}

bool isStdout(const std::string& file) {
  return file == "-";
}

bool isSameFile(const std::string& a, const std::string& b) {
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  const auto name = [&](const std::string& file) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(targetOfLinks(file), error),
                                             error);
  };
  return name(a) == name(b);
}

void requireOutput(const std::string& output, const CommonOptions& common, const Scene& scene) {
  if (isStdout(output)) return;
  std::error_code error;
  for (const auto& input : scene.files)
    if (std::filesystem::equivalent(output, input, error))
      throw UsageError(output + ": is the input " + input.string() + "; choose another name");
  requireWritable(output, common.force);
}

void requireOutput(const std::string& output, const std::string& option,
                   const std::string& extension, const std::vector<std::string>& inputs,
                   bool overwrite) {
  if (output.empty()) return;
  if (lowerExtension(output) != extension)
    throw UsageError(output + ": the file of " + option + " must end in " + extension);
  for (const std::string& input : inputs)
    if (!input.empty() && isSameFile(output, input))
      throw UsageError(output + ": is the input " + input + "; choose another name");
  requireWritable(output, overwrite);
}

std::string shortestText(double number) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

void say(const CommonOptions& common, const std::string& text) {
  if (!common.quiet) std::cerr << "vox: " << onOneLine(text) << '\n';
}

}  // namespace vox::app
