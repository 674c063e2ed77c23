// vox render: a picture of a .vdb file, or of the voxels of a mesh or scene.

#include "apps/vox/render.h"

#include "apps/vox/interrupt.h"
#include "apps/vox/progress_bar.h"
#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/grid_file.h"
#include "libvox/io/input_file.h"
#include "libvox/io/read_vdb.h"
#include "libvox/io/write_png.h"
#include "libvox/pipeline/convert.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iostream>
#include <memory>
#include <tuple>
#include <utility>

namespace vox::app {
namespace {

/// Reads the whole text as an integer.
template <class Number>
bool readNumber(std::string_view text, Number& number, int base = 10) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  return error == std::errc() && end == text.data() + text.size();
}

std::pair<int, int> parseSize(const std::string& text) {
  const std::size_t times = text.find('x');
  int width = 0;
  int height = 0;
  const bool read = times != std::string::npos &&
                    readNumber(std::string_view(text).substr(0, times), width) &&
                    readNumber(std::string_view(text).substr(times + 1), height);
  if (!read || width < 1 || height < 1)
    throw UsageError("--size must be width and height in pixels, such as 640x480, not '" + text +
                     "'");
  return {width, height};
}

Pixel parseBackground(const std::string& text) {
  constexpr std::array<std::pair<std::string_view, Pixel>, 4> kNamed = {
      {{"white", {255, 255, 255, 255}},
       {"black", {0, 0, 0, 255}},
       {"grey", {128, 128, 128, 255}},
       {"transparent", {0, 0, 0, 0}}}};
  for (const auto& [name, pixel] : kNamed)
    if (name == text) return pixel;
  constexpr std::size_t kDigits = 6;
  std::uint32_t rgb = 0;
  const bool read = text.size() == kDigits + 1 && text[0] == '#' &&
                    readNumber(std::string_view(text).substr(1), rgb, 16);
  if (!read)
    throw UsageError("--background must be white, black, grey, transparent or #rrggbb, not '" +
                     text + "'");
  const auto byte = [&](unsigned shift) { return static_cast<std::uint8_t>(rgb >> shift & 0xffU); };
  return {byte(16), byte(8), byte(0), 255};
}

/// The value of a name, or the error that lists all of them.
template <class Enum, std::size_t N>
Enum chosen(const char* option, const NameTable<Enum, N>& names, const std::string& text) {
  const auto value = namedIn(names, text);
  if (!value)
    throw UsageError(std::string(option) + " must be one of " + allNamesIn(names) + ", not '" +
                     text + "'");
  return *value;
}

RenderOptions parse(const RenderArguments& options) {
  RenderOptions parsed;
  parsed.views = parseViews(options.views);
  parsed.up = chosen("--up", kUpAxisNames, options.up);
  parsed.projection = chosen("--projection", kProjectionNames, options.projection);
  parsed.shading.shading = chosen("--shading", kShadingNames, options.shading);
  std::tie(parsed.width, parsed.height) = parseSize(options.size);
  parsed.background = parseBackground(options.background);
  parsed.samples = options.samples;
  parsed.shading.occlusionRays = options.occlusionRays;
  parsed.maxMemory = options.common.run.maxMemory;
  parsed.threads = options.common.run.threads;
  requireRenderable(parsed);
  return parsed;
}

/// Refuses options that have no meaning for this kind of input.
void refuse(const std::vector<Option>& given, const std::string& input, const char* why) {
  for (const Option& option : given)
    if (option.isGiven()) throw UsageError(input + ": " + option.name() + why);
}

bool hasColors(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [](const SceneObject& object) {
    return object.texture || !object.mesh.pointColors.empty() || !object.mesh.faceColors.empty() ||
           !object.mesh.attributes.looks.empty();
  });
}

/// The grids that a picture needs.
std::vector<GridKind> gridsFor(const RenderOptions& options, bool colored) {
  std::vector grids = {GridKind::kMask};
  if (options.shading.shading == Shading::kNormals) grids.push_back(GridKind::kNormal);
  if (colored) grids.push_back(GridKind::kColor);
  return grids;
}

Grids readGrids(const RenderArguments& options) {
  Grids grids;
  for (NamedGrid& named : readVdb(options.input).grids) grids.push_back(std::move(named.grid));
  return grids;
}

/// Expected nanoseconds, as the other stages count their work.
double workOfRendering(const RenderOptions& options) {
  constexpr double kPerRay = 400;
  return kPerRay * options.width * options.height * static_cast<double>(options.views.size()) *
         options.samples * options.samples * (1 + options.shading.occlusionRays);
}

void write(const RenderArguments& options, const Image& image) {
  if (isStdout(options.output)) return writePng(std::cout, image);
  AtomicFile output(options.output, options.common.force);
  writePng(output.stream(), image);
  output.commit();
}

int runRender(const RenderArguments& options) {
  if (!isStdout(options.output) && lowerExtension(options.output) != ".png")
    throw UsageError(options.output + ": the output of vox render must end in .png");
  const bool isVdb = isGridFile(options.input);
  PictureOptions picture = parseRender(options, isVdb);
  ProgressBar bar(options.common);
  Progress progress(bar.callback());
  Scene scene;
  if (isVdb)
    scene.files = {options.input};
  else
    scene = onThreads(options.common.run.threads,
                      [&] { return readScene(options.input, picture.conversion.scale); });
  requireOutput(options.output, options.common, scene);
  Picture drawn;
  {
    const CancelOnSignal cancelOnSignal(progress);
    drawn = isVdb ? drawGrids(readGrids(options), picture, progress)
                  : drawScene(scene, picture, progress);
    write(options, drawn.image);
  }
  bar.erase();
  for (const std::string& warning : drawn.warnings) say(options.common, "warning: " + warning);
  say(options.common, options.output + ": " + std::to_string(drawn.image.width) + " x " +
                          std::to_string(drawn.image.height) + " pixels");
  return 0;
}

void addPictureOptions(const Command& command, RenderArguments& options) {
  const auto add = [&](const char* name, auto& value, const std::string& help, const char* type) {
    return command.add(name, value, help).type(type).group("Picture").showDefault();
  };
  add("--view,--views", options.views,
      "Direction to look from: " + allViewNames() +
          ", or azimuth and elevation in degrees (0,0 front, 90,0 right). Several views, with "
          "commas, make a contact sheet, row by row",
      "VIEW");
  add("--up", options.up, "Axis of the world that is up: front is seen along +y (z) or -z (y)",
      "y|z");
  add("--projection", options.projection, "Rays that are parallel, or that start from one point",
      "orthographic|perspective");
  add("--size", options.size, "Width and height of each view, in pixels", "WxH");
  add("--background", options.background, "white, black, grey, transparent or #rrggbb", "COLOR");
  add("--shading", options.shading,
      "Normals to shade with: those of the grid normal, or congradient if there is none (normals); "
      "estimated from the voxels around (congradient); or those of the sides of voxels (flat). A "
      "level set always has its own",
      "WHICH");
  add("--samples", options.samples, "N x N rays per pixel", "N").range(1, kMostSamples);
  add("--occlusion", options.occlusionRays,
      "Rays per sample that test how much of the sky is hidden; 0: no ambient occlusion", "N")
      .range(0, kMostOcclusionRays);
}

void addGridOptions(const Command& command, RenderArguments& options) {
  options.gridOptions = {
      command
          .add("--grid", options.visible.grid,
               "Grid to show (default: mask, density, surface or any other grid of numbers)")
          .type("NAME")
          .group("OpenVDB files"),
      command
          .add("--threshold", options.visible.threshold,
               "Fog above this density is solid (default: a tenth of the largest)")
          .type("T")
          .group("OpenVDB files")};
}

void addMeshOptions(const Command& command, RenderArguments& options) {
  const std::size_t before = command.options().size();
  addConversionOptions(command, options.conversion);
  addSubmeshOptions(command, options.conversion.submeshes);
  command
      .add("--texture", options.conversion.texture,
           "Texture of all objects, as for vox convert (default: the scene's, or the "
           "colours of the mesh)")
      .type("SPEC")
      .group("Texture");
  const auto all = command.options();
  options.meshOptions.assign(all.begin() + static_cast<std::ptrdiff_t>(before), all.end());
}

}  // namespace

PictureOptions parseRender(const RenderArguments& options, bool showsGrids) {
  PictureOptions parsed;
  parsed.rendering = parse(options);
  parsed.visible = options.visible;
  refuse(showsGrids ? options.meshOptions : options.gridOptions, options.input,
         showsGrids ? " is for meshes and scenes only" : " is for .vdb and .nvdb files only");
  parsed.conversion = parseConversion(options.conversion, options.common.run);
  return parsed;
}

Picture drawGrids(const Grids& grids, PictureOptions options, Progress& progress) {
  progress.plan(workOfRendering(options.rendering));
  options.rendering.progress = &progress;
  Picture picture = {render(grids, options.visible, options.rendering), {}};
  progress.finish();
  return picture;
}

Picture drawScene(const Scene& scene, PictureOptions options, Progress& progress) {
  ConvertOptions& conversion = options.conversion;
  conversion.run.progress = &progress;
  conversion.grids = gridsFor(options.rendering, conversion.texture || hasColors(scene));
  progress.plan(workOfRendering(options.rendering));
  const Conversion converted = convert(scene, conversion);
  options.rendering.progress = &progress;
  Picture picture = {render(converted.grids, options.visible, options.rendering),
                     converted.report.warnings};
  progress.finish();
  return picture;
}

void declareRender(CLI::App& app, RenderArguments& options) {
  const Command command(app, "render", "Draw a .vdb file, or the voxels of a mesh or scene (.png)");
  command
      .add("INPUT", options.input,
           "OpenVDB file (.vdb) or NanoVDB file (.nvdb), scene (.toml) or mesh (.obj .ply .off "
           ".stl .om "
           ".gltf .glb)")
      .required();
  command.add("-o,--output", options.output, "PNG file to write; - for stdout")
      .required()
      .type("OUT.png")
      .group("Output");
  addPictureOptions(command, options);
  addGridOptions(command, options);
  addMeshOptions(command, options);
  addProgressOption(command, options.common);
  addCommonOptions(command, options.common);
}

Action addRender(CLI::App& app) {
  const auto options = std::make_shared<RenderArguments>();
  declareRender(app, *options);
  return [options] { return runRender(*options); };
}

}  // namespace vox::app
