// The commands of vox as functions.

#include "apps/python/commands.h"

#include "apps/python/mesh_arrays.h"
#include "apps/python/run.h"
#include "apps/vox/check.h"
#include "apps/vox/convert.h"
#include "apps/vox/convert_report.h"
#include "apps/vox/diff.h"
#include "apps/vox/info.h"
#include "apps/vox/keywords.h"
#include "apps/vox/render.h"
#include "apps/vox/subdivide.h"
#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/core/stopwatch.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/grid_file.h"
#include "libvox/io/watched_stream.h"
#include "libvox/io/write_mesh.h"
#include "libvox/io/write_png.h"
#include "libvox/io/write_vdb.h"
#include "libvox/options/run_part.h"
#include "libvox/pipeline/refine.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <variant>

namespace vox::python {
namespace {

namespace py = pybind11;
using app::KeywordCommand;
using Keywords = std::vector<std::pair<std::string, decltype(app::Keyword::value)>>;

/// Numbers of vertices given as arrays in place of files.
struct Lists {
  std::optional<py::array> interpolateVertices, creaseEdges, cornerVertices;
};

// What is converted: the path of a file, or a scene or mesh in memory.
using Input = std::variant<SceneHandle, MeshHandle, std::string>;

/// Stands for an input in memory on the command line.
constexpr const char* kInMemory = "mesh";

/// As a word of the command line that is no option.
std::string wordOf(const std::string& path) {
  return path.starts_with("-") ? "./" + path : path;
}

std::string wordOf(const Input& input) {
  const auto* const path = std::get_if<std::string>(&input);
  return path != nullptr ? wordOf(*path) : kInMemory;
}

/// The scene of a mesh alone, without the options of its scene.
std::shared_ptr<const Scene> sceneOf(const MeshHandle& mesh) {
  if (mesh.scene->objects.size() == 1) return mesh.scene;
  auto alone = std::make_shared<Scene>();
  alone->objects.push_back(mesh.object());
  return alone;
}

/// Null if it is a path.
std::shared_ptr<const Scene> inMemory(const Input& input) {
  if (const auto* scene = std::get_if<SceneHandle>(&input)) return scene->scene;
  if (const auto* mesh = std::get_if<MeshHandle>(&input)) return sceneOf(*mesh);
  return nullptr;
}

void refuseScale(const std::shared_ptr<const Scene>& scene, const std::optional<double>& scale) {
  if (scene && scale) throw UsageError("--scale is for files; multiply the points instead");
}

void refuseGrids(const Input& input) {
  const auto* const path = std::get_if<std::string>(&input);
  if (path != nullptr && isGridFile(*path))
    throw UsageError(*path + ": is a file of grids; read and write write it in another format");
}

void parse(KeywordCommand& command, const std::vector<std::string>& arguments,
           const Keywords& keywords) {
  std::vector<app::Keyword> all;
  for (const auto& [name, value] : keywords) all.push_back({name, value});
  command.parse(arguments, all);
}

void setLists(const Lists& lists, app::CreaseArguments& creases) {
  if (lists.creaseEdges) {
    const std::vector<Index> flat = indicesOf("crease_edges", *lists.creaseEdges);
    if (flat.size() % 2 != 0) throw InputError("crease_edges: must have shape (n, 2)");
    auto& edges = creases.edges.emplace();
    for (std::size_t i = 0; i < flat.size(); i += 2) edges.push_back({flat[i], flat[i + 1]});
  }
  if (lists.cornerVertices) creases.corners = indicesOf("corner_vertices", *lists.cornerVertices);
}

void setLists(const Lists& lists, app::SmoothingArguments& smoothing) {
  setLists(lists, smoothing.creases);
  if (lists.interpolateVertices)
    smoothing.vertices = indicesOf("interpolate_vertices", *lists.interpolateVertices);
}

py::list textsOf(const std::vector<std::string>& lines) {
  py::list all;
  for (const std::string& line : lines) all.append(text(line));
  return all;
}

// Reading and writing

SceneHandle readSceneFile(const std::string& path) {
  return {runUnwatched([&] { return std::make_shared<const Scene>(readScene(path)); })};
}

GridsHandle readGridFile(const std::string& path) {
  VdbFile file = runUnwatched([&] {
    VdbFile read = readVdb(path);
    // Now, while the file is as it is.
    for (const NamedGrid& grid : read.grids) grid.grid->baseTree().readNonresidentBuffers();
    return read;
  });
  return GridsHandle(std::move(file));
}

void writeMeshFile(const MeshHandle& mesh, const std::string& path, bool overwrite) {
  const MeshFormat format = meshFormatFor(path);
  runWatched(py::none(), [&](Progress&) {
    AtomicFile file(path, overwrite);
    writeMesh(file.stream(), mesh.mesh(), format);
    file.commit();
  });
}

void writeGridsFile(const GridsHandle& grids, const std::string& path, bool overwrite,
                    const std::optional<std::string>& compression, const py::object& progress) {
  std::optional<Compression> chosen;
  if (compression) {
    chosen = namedIn(kCompressionNames, *compression);
    if (!chosen)
      throw UsageError("compression must be one of " + allNamesIn(kCompressionNames) + ", not '" +
                       *compression + "'");
  }
  runWatched(progress, [&](Progress& watched) { grids.write(path, overwrite, chosen, watched); });
}

// Commands

GridsHandle convertInput(const Input& input, const Keywords& keywords, const Lists& lists,
                         const py::object& callback) {
  app::ConvertArguments arguments;
  KeywordCommand command([&](CLI::App& app) { app::declareConvert(app, arguments); });
  parse(command, {wordOf(input)}, keywords);
  setLists(lists, arguments.conversion.smoothing);
  refuseGrids(input);
  const auto scene = inMemory(input);
  refuseScale(scene, arguments.conversion.scale);
  Conversion conversion;
  std::string report;
  runWatched(callback, [&](Progress& progress) {
    ConvertOptions options = app::parseConvert(arguments);
    options.run.progress = &progress;
    const Stopwatch reading;
    Scene read;
    if (!scene)
      read = onThreads(options.run.threads,
                       [&] { return readScene(std::get<std::string>(input), options.scale); });
    const double readSeconds = reading.seconds();
    const Request request = resolve(scene ? *scene : read, options);
    conversion = scene ? app::convertScene(*scene, request, arguments.verify)
                       : app::convertScene(std::move(read), request, arguments.verify);
    progress.finish();
    report = app::reportJson({scene ? *scene : read, options, conversion, "", readSeconds, 0});
  });
  return GridsHandle(std::move(conversion), std::move(report));
}

py::tuple subdivideInput(const Input& input, const Keywords& keywords, const Lists& lists,
                         const py::object& callback) {
  app::SubdivideArguments arguments;
  KeywordCommand command([&](CLI::App& app) { app::declareSubdivide(app, arguments); });
  parse(command, {wordOf(input), "--output=-"}, keywords);
  setLists(lists, arguments.smoothing);
  refuseGrids(input);
  const auto scene = inMemory(input);
  refuseScale(scene, arguments.scale);
  const auto made = std::make_shared<Scene>();
  std::vector<std::string> warnings;
  runWatched(callback, [&](Progress& progress) {
    const PreparationOptions preparation = app::parsePreparation(arguments);
    RunOptions run = arguments.common.run;
    Scene read;
    if (!scene)
      read = onThreads(run.threads,
                       [&] { return readScene(std::get<std::string>(input), arguments.scale); });
    const Scene& used = scene ? *scene : read;
    run.progress = &progress;
    Refinement refined = refine(used, arguments.levels, preparation, run);
    progress.finish();
    SceneObject& object = made->objects.emplace_back();
    object.name = used.objects[0].name;
    object.mesh = std::move(refined.mesh);
    warnings = std::move(refined.warnings);
  });
  return py::make_tuple(MeshHandle{made, 0}, textsOf(warnings));
}

py::array arrayOf(const Image& image) {
  py::array_t<std::uint8_t> array(
      std::vector<py::ssize_t>{image.height, image.width, std::tuple_size_v<Pixel>});
  std::memcpy(array.mutable_data(), image.pixels.data(), image.pixels.size() * sizeof(Pixel));
  return array;
}

app::Grids gridsOf(const VdbFile& file) {
  app::Grids grids;
  for (const NamedGrid& grid : file.grids) grids.push_back(grid.grid);
  return grids;
}

using Shown = std::variant<GridsHandle*, SceneHandle, MeshHandle, std::string>;

py::tuple renderInput(const Shown& shown, const std::optional<std::string>& path, bool overwrite,
                      const Keywords& keywords, const Lists& lists, const py::object& callback) {
  GridsHandle* const* const given = std::get_if<GridsHandle*>(&shown);
  const GridsHandle* const handle = given != nullptr ? *given : nullptr;
  Input input = std::string(kInMemory);
  if (const auto* scene = std::get_if<SceneHandle>(&shown)) input = *scene;
  if (const auto* mesh = std::get_if<MeshHandle>(&shown)) input = *mesh;
  if (const auto* file = std::get_if<std::string>(&shown)) input = *file;
  app::RenderArguments arguments;
  KeywordCommand command([&](CLI::App& app) { app::declareRender(app, arguments); });
  parse(command, {wordOf(input), "--output=-"}, keywords);
  setLists(lists, arguments.conversion.smoothing);
  if (given != nullptr && handle == nullptr) throw py::type_error("there are no grids to show");
  const auto scene = inMemory(input);
  refuseScale(scene, arguments.conversion.scale);
  if (path) requireWritable(*path, overwrite);
  app::Picture picture;
  runWatched(callback, [&](Progress& progress) {
    const bool isFile = handle == nullptr && !scene;
    const std::string file = isFile ? std::get<std::string>(input) : "";
    const bool showsGrids = handle != nullptr || (isFile && isGridFile(file));
    const app::PictureOptions options = app::parseRender(arguments, showsGrids);
    if (handle != nullptr) {
      picture = app::drawGrids(gridsOf(handle->file()), options, progress);
    } else if (showsGrids) {
      picture = app::drawGrids(gridsOf(readVdb(file)), options, progress);
    } else if (scene) {
      picture = app::drawScene(*scene, options, progress);
    } else {
      const Scene read = onThreads(arguments.common.run.threads,
                                   [&] { return readScene(file, arguments.conversion.scale); });
      picture = app::drawScene(read, options, progress);
    }
    if (!path) return;
    AtomicFile output(*path, overwrite);
    writePng(output.stream(), picture.image);
    output.commit();
  });
  return py::make_tuple(arrayOf(picture.image), textsOf(picture.warnings));
}

py::str infoOf(const Input& input, const Keywords& keywords, const Lists& lists) {
  app::InfoArguments arguments;
  KeywordCommand command([&](CLI::App& app) { app::declareInfo(app, arguments); });
  parse(command, {wordOf(input)}, keywords);
  setLists(lists, arguments.creases);
  const auto scene = inMemory(input);
  refuseScale(scene, arguments.scale);
  return text(runUnwatched([&] { return app::infoJson(arguments, scene.get()); }));
}

py::str diffOf(const std::string& a, const std::string& b, bool overwrite,
               const Keywords& keywords) {
  app::DiffArguments arguments;
  KeywordCommand command([&](CLI::App& app) { app::declareDiff(app, arguments); });
  std::vector<std::string> words = {wordOf(a), wordOf(b)};
  if (overwrite) words.emplace_back("--force");
  parse(command, words, keywords);
  return text(runUnwatched([&] { return app::diffJson(arguments); }));
}

py::str checkOf(const std::string& file, const std::optional<Input>& mesh, bool overwrite,
                const Keywords& keywords, const Lists& lists) {
  app::CheckArguments arguments;
  KeywordCommand command([&](CLI::App& app) { app::declareCheck(app, arguments); });
  std::vector<std::string> words = {wordOf(file)};
  if (mesh) words.push_back("--mesh=" + wordOf(*mesh));
  if (overwrite) words.emplace_back("--force");
  parse(command, words, keywords);
  setLists(lists, arguments.smoothing);
  const auto scene = mesh ? inMemory(*mesh) : nullptr;
  return text(runUnwatched([&] { return app::checkJson(arguments, scene.get()); }));
}

/// Names, types and meanings of the keyword arguments of a command.
std::vector<std::array<std::string, 3>> optionsOf(const std::string& name) {
  app::ConvertArguments convert;
  app::SubdivideArguments subdivide;
  app::InfoArguments info;
  app::DiffArguments diff;
  app::CheckArguments check;
  app::RenderArguments render;
  const KeywordCommand command([&](CLI::App& app) {
    if (name == "convert") return app::declareConvert(app, convert);
    if (name == "subdivide") return app::declareSubdivide(app, subdivide);
    if (name == "info") return app::declareInfo(app, info);
    if (name == "diff") return app::declareDiff(app, diff);
    if (name == "check") return app::declareCheck(app, check);
    if (name == "render") return app::declareRender(app, render);
    throw UsageError("there is no command " + name);
  });
  std::vector<std::array<std::string, 3>> all;
  for (const app::KeywordHelp& keyword : command.help())
    all.push_back({keyword.name, keyword.type, keyword.help});
  return all;
}

}  // namespace

GridsHandle::GridsHandle(Conversion conversion, std::string report)
    : conversion_(std::move(conversion)), report_(std::move(report)) {
  for (const auto& grid : conversion_->grids) file_.grids.push_back({grid->getName(), grid});
}

py::list GridsHandle::warnings() const {
  return conversion_ ? textsOf(conversion_->report.warnings) : py::list();
}

void GridsHandle::write(const std::string& path, bool overwrite,
                        std::optional<Compression> compression, Progress& progress) const {
  if (!isGridFile(path)) throw UsageError(path + ": the name must end in .vdb or .nvdb");
  if (compression) requireCompression(*compression);
  if (conversion_) {
    for (const auto& grid : conversion_->grids)
      app::requireHeld(path, (*grid)[kRunPartMetadata] != nullptr, grid->saveFloatAsHalf());
    Conversion written = *conversion_;  // shares the grids
    if (compression) written.compression = compression;
    writeGrids(path, written, overwrite, &progress);
  } else {
    AtomicFile output(path, overwrite);
    progress.beginLast("write");
    constexpr std::uint64_t kPerVoxel = 4;
    std::uint64_t bytes = 0;
    for (const NamedGrid& grid : file_.grids) bytes += kPerVoxel * grid.grid->activeVoxelCount();
    WatchedStream stream(*output.stream().rdbuf(), progress, bytes);
    writeGridFile(stream, path, gridsOf(file_), *file_.metadata, compression);
    progress.check();
    output.commit();
  }
  progress.finish();
}

void addCommands(py::module_& module) {
  py::class_<Lists>(module, "Lists")
      .def(py::init([](std::optional<py::array> vertices, std::optional<py::array> edges,
                       std::optional<py::array> corners) {
        return Lists{std::move(vertices), std::move(edges), std::move(corners)};
      }));
  module.def("is_grid_file", [](const std::string& path) { return isGridFile(path); });
  module.def("read_scene", &readSceneFile);
  module.def("read_grids", &readGridFile);
  module.def("write_mesh", &writeMeshFile);
  module.def("write_grids", &writeGridsFile);
  module.def("convert", &convertInput);
  module.def("subdivide", &subdivideInput);
  module.def("render", &renderInput);
  module.def("info", &infoOf);
  module.def("diff", &diffOf);
  module.def("check", &checkOf);
  module.def("options", &optionsOf);
}

}  // namespace vox::python
