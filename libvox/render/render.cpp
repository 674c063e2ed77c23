// One ray or more for every pixel, in tiles.

#include "libvox/render/render.h"

#include "libvox/core/color.h"
#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/render/shading.h"
#include "libvox/render/visible.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace vox {
namespace {

constexpr int kTile = 32;

int tilesAcross(int pixels) {
  return (pixels + kTile - 1) / kTile;
}

/// How the views of a contact sheet are laid out.
struct Sheet {
  int columns;
  int rows;

  explicit Sheet(std::size_t views) {
    columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(views))));
    rows = (static_cast<int>(views) + columns - 1) / columns;
  }
};

std::vector<Camera> camerasOf(const VisibleGrids& visible, const RenderOptions& options) {
  const double aspect = static_cast<double>(options.width) / options.height;
  std::vector<Framing> framings;
  for (const View& view : options.views)
    framings.emplace_back(view, options.up, options.projection, aspect);
  parallelForEach(framings.size(), 1, [&](std::size_t i) { addBoxes(visible, framings[i]); });
  double halfHeight = 0;
  for (const Framing& framing : framings) halfHeight = std::max(halfHeight, framing.halfHeight());
  std::vector<Camera> cameras;
  for (const Framing& framing : framings) cameras.push_back(framing.camera(halfHeight));
  return cameras;
}

/// @param light    sum of the light of all samples that hit
/// @param covered  share of the samples that hit
Pixel pixelOf(const Light& light, double covered, const Pixel& background) {
  if (covered <= 0) return background;
  Pixel pixel;
  const bool transparent = background[3] == 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double shown =
        255 * screenFromLinear(std::clamp(light[static_cast<Eigen::Index>(i)], 0.0, 1.0));
    const double mixed = transparent ? shown : covered * shown + (1 - covered) * background[i];
    pixel[i] = static_cast<std::uint8_t>(std::lround(mixed));
  }
  pixel[3] = transparent ? static_cast<std::uint8_t>(std::lround(255 * covered)) : 255;
  return pixel;
}

/// The pixel in column x and row y of a view.
Pixel look(Shader& shader, const Camera& camera, int x, int y, const RenderOptions& options) {
  const int samples = options.samples * options.samples;
  Light light = Light::Zero();
  int hits = 0;
  for (int sample = 0; sample < samples; ++sample) {
    const double dx = (sample % options.samples + 0.5) / options.samples;
    const double dy = (sample / options.samples + 0.5) / options.samples;
    const Sight sight = camera.through((x + dx) / options.width, (y + dy) / options.height);
    const auto seen = shader.look(sight, sample, samples);
    if (!seen) continue;
    light += *seen;
    ++hits;
  }
  return pixelOf(light / std::max(hits, 1), static_cast<double>(hits) / samples,
                 options.background);
}

/// One view, at its place in the image.
class ViewPainter {
 public:
  ViewPainter(const VisibleGrids& visible, const RayCaster& surface, const RenderOptions& options,
              Image& image)
      : visible_(visible), surface_(surface), options_(options), image_(image) {}

  void paintTile(const Camera& camera, int left, int top, int tile) const {
    Shader shader(visible_, surface_, camera.axes, options_.shading);
    const int x0 = tile % tilesAcross(options_.width) * kTile;
    const int y0 = tile / tilesAcross(options_.width) * kTile;
    for (int y = y0; y < std::min(y0 + kTile, options_.height); ++y)
      for (int x = x0; x < std::min(x0 + kTile, options_.width); ++x)
        image_.at(left + x, top + y) = look(shader, camera, x, y, options_);
  }

 private:
  const VisibleGrids& visible_;
  const RayCaster& surface_;
  const RenderOptions& options_;
  Image& image_;
};

Image paintViews(const VisibleGrids& visible, std::span<const Camera> cameras,
                 const RenderOptions& options, Progress& progress) {
  const Sheet sheet(cameras.size());
  const int width = sheet.columns * options.width;
  const int height = sheet.rows * options.height;
  const MemoryBudget budget(options.maxMemory);
  constexpr std::uint64_t kBytesPerPixel = 16;  // the image, its channels packed, the file
  budget.require(
      kBytesPerPixel * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height),
      "the image", "use a smaller --size");
  progress.beginLast("render");
  Image image(width, height);
  std::fill(image.pixels.begin(), image.pixels.end(), options.background);
  const auto surface =
      visible.voxels ? voxelCaster(*visible.voxels) : levelSetCaster(*visible.levelSet);
  const ViewPainter painter(visible, *surface, options, image);
  const auto tiles =
      static_cast<std::size_t>(tilesAcross(options.width) * tilesAcross(options.height));
  const std::size_t count = tiles * cameras.size();
  parallelForEach(count, 1, [&](std::size_t i) {
    progress.check();
    const int view = static_cast<int>(i / tiles);
    painter.paintTile(cameras[i / tiles], view % sheet.columns * options.width,
                      view / sheet.columns * options.height, static_cast<int>(i % tiles));
    progress.done(1.0 / static_cast<double>(count));
  });
  return image;
}

}  // namespace

void addBoxes(const VisibleGrids& visible, Framing& framing) {
  for (const auto& box : visible.boxes) {
    const openvdb::Vec3d low = box.min().asVec3d() - openvdb::Vec3d(0.5);
    const openvdb::Vec3d high = box.max().asVec3d() + openvdb::Vec3d(0.5);
    for (unsigned corner = 0; corner < 8; ++corner) {
      const openvdb::Vec3d at((corner & 1U) != 0 ? high[0] : low[0],
                              (corner & 2U) != 0 ? high[1] : low[1],
                              (corner & 4U) != 0 ? high[2] : low[2]);
      const openvdb::Vec3d world = visible.toWorld->indexToWorld(at);
      framing.add(Vec3d(world[0], world[1], world[2]));
    }
  }
}

void requireRenderable(const RenderOptions& options) {
  const auto require = [](const char* what, std::int64_t value, std::int64_t least,
                          std::int64_t most) {
    if (value < least || value > most)
      throw UsageError(std::string(what) + " must lie between " + std::to_string(least) + " and " +
                       std::to_string(most) + ", not " + std::to_string(value));
  };
  require("the number of views", static_cast<std::int64_t>(options.views.size()), 1,
          kMostPixelsAcross);
  const Sheet sheet(options.views.size());
  require("the width of the image in pixels", std::int64_t{options.width} * sheet.columns, 1,
          kMostPixelsAcross);
  require("the height of the image in pixels", std::int64_t{options.height} * sheet.rows, 1,
          kMostPixelsAcross);
  require("the number of samples", options.samples, 1, kMostSamples);
  require("the number of occlusion rays", options.shading.occlusionRays, 0, kMostOcclusionRays);
}

Image render(const VisibleGrids& visible, std::span<const Camera> cameras,
             const RenderOptions& options) {
  RenderOptions checked = options;
  checked.views.resize(cameras.size());
  requireRenderable(checked);
  Progress unwatched;
  Progress& progress = options.progress != nullptr ? *options.progress : unwatched;
  return onThreads(options.threads,
                   [&] { return paintViews(visible, cameras, options, progress); });
}

Image render(const VisibleGrids& visible, const RenderOptions& options) {
  requireRenderable(options);
  const std::vector<Camera> cameras =
      onThreads(options.threads, [&] { return camerasOf(visible, options); });
  return render(visible, cameras, options);
}

Image render(std::span<const std::shared_ptr<openvdb::GridBase>> grids, const VisibleOptions& what,
             const RenderOptions& options) {
  return render(visibleGrids(grids, what), options);
}

}  // namespace vox
