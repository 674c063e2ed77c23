// Pictures of grids and of their differences.

#include "libvox/report/grid_pictures.h"

#include "libvox/core/error.h"
#include "libvox/inspect/topology.h"
#include "libvox/render/render.h"
#include "libvox/report/clusters.h"
#include "libvox/report/html.h"
#include "libvox/report/palette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::GridBase;
using openvdb::math::Transform;

constexpr int kPictureSize = 420;  // pixels
constexpr int kCloseUpSide = 40;   // voxels
constexpr int kCloseUpMargin = 4;  // the same
constexpr std::size_t kMostMarks = 5;

RenderOptions pictureOptions() {
  RenderOptions options;
  options.width = options.height = kPictureSize;
  options.background = {255, 255, 255, 0};
  return options;
}

/// A camera that shows boxes of several grids.
Camera cameraOf(const View& view, std::initializer_list<const VisibleGrids*> shown) {
  Framing framing(view, kReportUp, Projection::kOrthographic, 1);
  for (const VisibleGrids* visible : shown) addBoxes(*visible, framing);
  return framing.camera();
}

Image imageOf(const VisibleGrids& visible, const Camera& camera,
              Shading shading = Shading::kNormals) {
  RenderOptions options = pictureOptions();
  options.shading.shading = shading;
  return render(visible, std::span(&camera, 1), options);
}

std::string textOf(const View& view) {
  for (const char* name : {"front", "back", "left", "right"})
    if (viewNamed(name) == view) return std::string("from the ") + name;
  if (view == *viewNamed("top")) return "from above";
  if (view == *viewNamed("bottom")) return "from below";
  return std::string("from ") + (view.elevation > 0 ? "above" : "below") + ", " +
         shortNumber(view.azimuth) + " degrees to the right of the front";
}

std::string textOf(const Coord& voxel) {
  return "(" + std::to_string(voxel.x()) + ' ' + std::to_string(voxel.y()) + ' ' +
         std::to_string(voxel.z()) + ')';
}

/// Two colours, of `over` that part.
Pixel mixed(const Pixel& under, const Pixel& over, double part) {
  Pixel pixel = under;
  for (std::size_t i = 0; i < 3; ++i)
    pixel[i] = static_cast<std::uint8_t>(std::lround((1 - part) * under[i] + part * over[i]));
  return pixel;
}

/// A picture with another one that shines through where it is hidden.
Image shiningThrough(Image image, const Image& hidden) {
  constexpr double kShine = 0.6;
  constexpr double kOpaque = 255;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    Pixel& pixel = image.pixels[i];
    const Pixel& over = hidden.pixels[i];
    if (pixel[3] == 0)
      pixel = over;
    else
      pixel = mixed(pixel, over, kShine * over[3] / kOpaque);
  }
  return image;
}

/// All voxels of a look from a camera; what differs shines through.
Image differenceImage(const VisibleGrids& all, const VisibleGrids& differing, const Camera& camera,
                      Shading shading = Shading::kNormals) {
  return shiningThrough(imageOf(all, camera, shading), imageOf(differing, camera, shading));
}

std::array<double, 2> placeOf(const Coord& voxel, const Transform& toWorld, const Camera& camera) {
  const openvdb::Vec3d world = toWorld.indexToWorld(voxel);
  return camera.place(Vec3d(world[0], world[1], world[2]));
}

/// Middles of the clusters that are so small in the picture that a mark helps to find them.
std::vector<std::array<double, 2>> placesOf(const std::vector<Cluster>& clusters,
                                            const DifferenceLook& look, const Transform& toWorld,
                                            const Camera& camera) {
  constexpr double kSmall = 0.03;  // of the width of the picture
  const double voxel = std::cbrt(std::abs(toWorld.baseMap()->determinant()));
  std::vector<std::array<double, 2>> places;
  for (const Cluster& cluster : clusters) {
    const double side = std::sqrt(static_cast<double>(cluster.voxels)) * voxel;
    if (side > kSmall * 2 * camera.halfWidth) continue;
    const CoordBBox box = closeUpBox(look.differing(), cluster.first, kCloseUpSide);
    const openvdb::Vec3d world = toWorld.indexToWorld(box.getCenter());
    places.push_back(camera.place(Vec3d(world[0], world[1], world[2])));
  }
  return places;
}

Picture closeUp(const DifferenceLook& look, const Cluster& cluster, const View& view) {
  const CoordBBox shown = closeUpBox(look.differing(), cluster.first, kCloseUpSide);
  CoordBBox around = shown;
  around.expand(kCloseUpMargin);
  const VisibleGrids all = look.visibleAll(around);
  const VisibleGrids differing = look.visibleDiffering(around);
  const openvdb::Vec3d world = all.toWorld->indexToWorld(shown.getCenter());
  return {differenceImage(all, differing, cameraOf(view, {&all}), Shading::kFlat),
          "Close-up",
          "The largest cluster of differences: " + grouped(cluster.voxels) +
              (cluster.voxels == 1 ? " voxel. " : " voxels. ") + "Shown are voxels " +
              textOf(around.min()) + " to " + textOf(around.max()) + ", at " +
              shortNumber(world[0]) + ' ' + shortNumber(world[1]) + ' ' + shortNumber(world[2]) +
              " in world units, " + textOf(view) + '.',
          {}};
}

/// Colours of two pictures over each other: A alone, B alone, both.
Image overlaid(const Image& a, const Image& b) {
  Image image(a.width, a.height);
  constexpr double kTint = 0.7;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Pixel& inA = a.pixels[i];
    const Pixel& inB = b.pixels[i];
    const bool both = inA[3] > 0 && inB[3] > 0;
    const Pixel& lit = inA[3] > 0 ? inA : inB;
    image.pixels[i] = both ? lit : mixed(lit, inA[3] > 0 ? kOnlyAColor : kOnlyBColor, kTint);
    image.pixels[i][3] = std::max(inA[3], inB[3]);
  }
  return image;
}

VisibleGrids plain(const openvdb::MaskTree::ConstPtr& voxels, const Transform::ConstPtr& toWorld) {
  VisibleGrids visible;
  visible.voxels = voxels;
  visible.toWorld = toWorld;
  visible.boxes = boxesOf(*voxels);
  return visible;
}

VisibleGrids voxelsNear(const openvdb::MaskTree& voxels, const Coord& middle,
                        const Transform::ConstPtr& toWorld) {
  constexpr int kReach = 6;
  const auto part = std::make_shared<openvdb::MaskTree>();
  const CoordBBox box(middle.offsetBy(-kReach), middle.offsetBy(kReach));
  for (auto voxel = box.begin(); voxel; ++voxel)
    if (voxels.isValueOn(*voxel)) part->setValueOn(*voxel);
  return plain(part, toWorld);
}

double apart(const Coord& voxel, const Transform& a, const Transform& b) {
  return (a.indexToWorld(voxel) - b.indexToWorld(voxel)).length();
}

/// The active voxel that two linear transforms put farthest apart.
Coord farthestMoved(const openvdb::MaskTree& voxels, const Transform& a, const Transform& b) {
  Coord farthest;
  double most = -1;
  for (auto value = voxels.cbeginValueOn(); value; ++value) {
    const CoordBBox box = value.getBoundingBox();
    for (unsigned corner = 0; corner < 8; ++corner) {  // of a tile; of a voxel all are the same
      const Coord voxel((corner & 1U) != 0 ? box.max().x() : box.min().x(),
                        (corner & 2U) != 0 ? box.max().y() : box.min().y(),
                        (corner & 4U) != 0 ? box.max().z() : box.min().z());
      const double moved = apart(voxel, a, b);
      if (moved > most) {
        most = moved;
        farthest = voxel;
      }
    }
  }
  return farthest;
}

}  // namespace

std::optional<VisibleGrids> lookOf(const GridBase::Ptr& grid) {
  if (grid->activeVoxelCount() == 0 || !grid->transform().isLinear()) return std::nullopt;
  try {
    return visibleGrids(std::span(&grid, 1), {});
  } catch (const InputError&) {  // it has no surface
  }
  VisibleGrids visible = plain(topologyOf(*grid), grid->transformPtr());
  const auto vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grid);
  const std::string& name = grid->getName();
  if (vectors && (name == "color" || name == "Cd")) visible.colors = vectors;
  if (vectors && (name == "normal" || name == "N")) visible.normals = vectors;
  return visible;
}

Picture pictureOf(const VisibleGrids& visible, const std::string& name) {
  const View view = *viewNamed("iso");
  return {
      imageOf(visible, cameraOf(view, {&visible})), name, "The grid, " + textOf(view) + '.', {}};
}

std::vector<Picture> differencePictures(const GridBase::Ptr& a, const GridBase::Ptr& b,
                                        const DifferenceLook& look, std::span<const View> views) {
  std::vector<Picture> pictures;
  const VisibleGrids all = look.visibleAll({});
  const VisibleGrids differing = look.visibleDiffering({});
  const Camera first = cameraOf(views[0], {&all});
  for (const auto& [grid, name] : {std::pair(a, "A"), std::pair(b, "B")}) {
    const auto visible = lookOf(grid);
    if (visible)
      pictures.push_back({imageOf(*visible, first),
                          name,
                          std::string("The grid of ") + name + ", " + textOf(views[0]) + '.',
                          {}});
  }
  const std::vector<Cluster> clusters = largestClusters(look.differing(), kMostMarks);
  const char* const title = "Difference";
  for (const View& view : views) {
    const Camera camera = cameraOf(view, {&all});
    Picture picture{differenceImage(all, differing, camera), title,
                    "What differs, " + textOf(view) + '.',
                    placesOf(clusters, look, *all.toWorld, camera)};
    if (!picture.marks.empty())
      picture.description += " Circles mark small clusters, up to the five largest.";
    pictures.push_back(std::move(picture));
  }
  if (!clusters.empty()) pictures.push_back(closeUp(look, clusters.front(), views[0]));
  return pictures;
}

std::vector<Picture> overlayPictures(const GridBase& a, const GridBase& b,
                                     const VisibleGrids& visibleA, const VisibleGrids& visibleB) {
  const View view = *viewNamed("iso");
  const auto overlay = [&](const VisibleGrids& inA, const VisibleGrids& inB, Shading shading) {
    const Camera camera = cameraOf(view, {&inA, &inB});
    return overlaid(imageOf(inA, camera, shading), imageOf(inB, camera, shading));
  };
  const openvdb::MaskTree::Ptr voxels = topologyOf(a);
  const Coord far = farthestMoved(*voxels, a.transform(), b.transform());
  std::vector<Picture> pictures;
  pictures.push_back(
      {overlay(visibleA, visibleB, Shading::kNormals),
       "In world space",
       "Both grids where their transforms put them, " + textOf(view) +
           ". Red: only A covers this place of the picture; blue: only B; grey: both. "
           "Voxels of one index lie up to " +
           shortNumber(apart(far, a.transform(), b.transform())) + " world units apart.",
       {}});
  const openvdb::MaskTree::Ptr voxelsB = topologyOf(b);
  if (!voxelsB->isValueOn(far)) return pictures;
  pictures.push_back(
      {overlay(voxelsNear(*voxels, far, a.transformPtr()),
               voxelsNear(*voxelsB, far, b.transformPtr()), Shading::kFlat),
       "Close-up",
       "The voxels around " + textOf(far) + ", which lie farther apart than any others.",
       {}});
  return pictures;
}

std::vector<Picture> markedPictures(const VisibleGrids& visible, std::span<const Coord> marked) {
  std::vector<Picture> pictures;
  const View above = *viewNamed("iso");
  for (const View& view : {above, View{above.azimuth + 180, -above.elevation}}) {
    VisibleGrids places = visible;  // may lie outside of the voxels
    for (const Coord& voxel : marked) places.boxes.emplace_back(voxel, voxel);
    const Camera camera = cameraOf(view, {&places});
    Picture picture{imageOf(visible, camera), "Voxels", "The grid, " + textOf(view) + '.', {}};
    if (!marked.empty()) picture.description += " Circles mark where something was found first.";
    for (const Coord& voxel : marked)
      picture.marks.push_back(placeOf(voxel, *visible.toWorld, camera));
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

}  // namespace vox
