#pragma once

#include "apps/vox/command.h"
#include "apps/vox/options.h"
#include "libvox/core/image.h"
#include "libvox/grid/openvdb_fwd.h"
#include "libvox/render/render.h"

#include <memory>
#include <string>
#include <vector>

namespace vox {
class Progress;
}

namespace vox::app {

/// Arguments of vox render, as typed.
struct RenderArguments {
  std::string input;
  std::string output;
  std::string views = "iso";
  std::string up = "z";
  std::string projection = nameIn(kProjectionNames, Projection::kOrthographic);
  std::string size = "512x512";
  std::string background = "white";
  std::string shading = nameIn(kShadingNames, Shading::kNormals);
  int samples = 2;
  int occlusionRays = 4;
  VisibleOptions visible;
  // Of meshes and scenes:
  ConversionArguments conversion;
  std::vector<Option> meshOptions;  ///< all of these
  std::vector<Option> gridOptions;  ///< those of .vdb files
  CommonOptions common;
};
void declareRender(CLI::App& app, RenderArguments& options);

/// How to draw a picture.
struct PictureOptions {
  RenderOptions rendering;
  VisibleOptions visible;
  ConvertOptions conversion;  ///< of scenes
};

/// @param showsGrids  grids are drawn; false: a scene
/// @throws UsageError, InputError
PictureOptions parseRender(const RenderArguments& options, bool showsGrids);

struct Picture {
  Image image;
  std::vector<std::string> warnings;  ///< one line each
};

using Grids = std::vector<std::shared_ptr<openvdb::GridBase>>;

/// @throws as render
Picture drawGrids(const Grids& grids, PictureOptions options, Progress& progress);

/// Draws the voxels of a scene.
/// @throws as convert and render
Picture drawScene(const Scene& scene, PictureOptions options, Progress& progress);

}  // namespace vox::app
