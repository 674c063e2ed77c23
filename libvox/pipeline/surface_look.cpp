// Colours of places on a surface: images, materials, colours of the mesh.

#include "libvox/pipeline/surface_look.h"

#include "libvox/core/color.h"
#include "libvox/pipeline/corner_blend.h"
#include "libvox/pipeline/prepared_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vox {
namespace {

/// The share of a side that a voxel covers; at most all of it.
double covered(const Vec3d& side) {
  return 1 / std::max(1.0, side.norm());
}

}  // namespace

std::vector<Vec3f> colorsOfCorners(const PolygonMesh& mesh) {
  std::vector<Vec3f> colors;
  if (!mesh.pointColors.empty()) {
    for (const Index v : mesh.faceVertices) colors.push_back(mesh.pointColors[v]);
  } else if (!mesh.faceColors.empty()) {
    for (Index f = 0; f < mesh.faceCount(); ++f)
      colors.insert(colors.end(), mesh.faceSize(f), mesh.faceColors[f]);
  }
  return colors;
}

SurfaceColors::SurfaceColors(const PreparedSurface& surface) : surface_(surface) {
  if (surface.texture) return;  // it is evaluated in space
  const PolygonMesh& mesh = surface.base.mesh;
  cornerColors_ = colorsOfCorners(mesh);
  if (!cornerColors_.empty())
    meanColors_ = meansOfFaces<Vec3f>(mesh, [&](Index c) { return cornerColors_[c]; });
  const SurfaceLook& look = surface.look;
  const bool hasImages = std::any_of(look.looks.begin(), look.looks.end(),
                                     [](const Look& one) { return one.image.has_value(); });
  if (!hasImages || look.texcoords.empty()) return;
  meanTexcoords_ = meansOfFaces<Vec2f>(mesh, [&](Index c) { return look.texcoords[c]; });
  centroids_ =
      meansOfFaces<Vec3d>(mesh, [&](Index c) { return mesh.points[mesh.faceVertices[c]]; });
}

bool SurfaceColors::hasColors() const {
  return !cornerColors_.empty() || !surface_.look.looks.empty();
}

bool SurfaceColors::mayBeTransparent() const {
  const std::vector<Look>& looks = surface_.look.looks;
  return std::any_of(looks.begin(), looks.end(),
                     [](const Look& look) { return look.color[3] < 1 || look.image.has_value(); });
}

const Look* SurfaceColors::lookOf(Index face) const {
  const SurfaceLook& look = surface_.look;
  if (look.looks.empty()) return nullptr;
  const Index number = look.lookOfFace.empty() ? 0 : look.lookOfFace[face];
  return number == kNone ? nullptr : &look.looks[number];
}

bool SurfaceColors::hasImage(Index face) const {
  const Look* const look = lookOf(face);
  return look != nullptr && look->image && !meanTexcoords_.empty() &&
         meanTexcoords_[face].allFinite();
}

Vec4f SurfaceColors::colored(Index face, const Vec3f& meshColor,
                             const std::optional<Vec4f>& image) const {
  const Look* const look = lookOf(face);
  Vec4f color;
  color << meshColor, 1;
  if (look == nullptr) return color;
  if (image && !look->multiplies) {
    color = *image;
  } else if (look->multiplies) {
    if (cornerColors_.empty()) color.setOnes();
    color = color.cwiseProduct(look->color);
    if (image) color = color.cwiseProduct(*image);
    return color;
  } else if (cornerColors_.empty()) {
    color.head<3>() = look->color.head<3>();
  }
  color[3] *= look->color[3];
  return color;
}

Vec4f SurfaceColors::at(Index corner, double u, double v) const {
  const SubdivisionLevel& base = surface_.base;
  const Index f = base.adjacency.cornerFace[corner];
  Vec3f color = Vec3f::Constant(kPlainColor);
  if (!cornerColors_.empty())
    color =
        blendOf(base, corner, meanColors_[f], [&](Index c) { return cornerColors_[c]; }).at(u, v);
  if (!hasImage(f)) return colored(f, color, {});
  const auto texcoords =
      blendOf(base, corner, meanTexcoords_[f], [&](Index c) { return surface_.look.texcoords[c]; });
  const auto places = blendOf(base, corner, centroids_[f],
                              [&](Index c) { return base.mesh.points[base.mesh.faceVertices[c]]; });
  const double width = covered(places.alongU(v));
  const double height = covered(places.alongV(u));
  const ImageTexture& image = *lookOf(f)->image;
  const int n = ImageTexture::samplesAcross(image.texelsAcross(
      width * texcoords.alongU(v).cast<double>(), height * texcoords.alongV(u).cast<double>()));
  if (n == 1) return colored(f, color, image.at(texcoords.at(u, v).cast<double>()));
  // Beyond u = 0 and v = 0 are other faces; beyond the other sides the face goes on.
  return colored(f, color, image.mean(n, [&](double a, double b) -> Vec2d {
    const double right = std::max(0.0, u + (a - 0.5) * width);
    const double up = std::max(0.0, v + (b - 0.5) * height);
    return texcoords.at(right, up).cast<double>();
  }));
}

Vec4f SurfaceColors::at(const Index* corners, double b, double c) const {
  const PolygonMesh& mesh = surface_.base.mesh;
  const Index f = surface_.base.adjacency.cornerFace[corners[0]];
  const auto blended = [&](const auto& values, double second, double third) {
    using T = std::decay_t<decltype(values[0])>;
    using Scalar = typename T::Scalar;
    return T(static_cast<Scalar>(1 - second - third) * values[corners[0]] +
             static_cast<Scalar>(second) * values[corners[1]] +
             static_cast<Scalar>(third) * values[corners[2]]);
  };
  const Vec3f color =
      cornerColors_.empty() ? Vec3f(Vec3f::Constant(kPlainColor)) : blended(cornerColors_, b, c);
  if (!hasImage(f)) return colored(f, color, {});
  const std::vector<Vec2f>& texcoords = surface_.look.texcoords;
  const auto pointAt = [&](int i) { return mesh.points[mesh.faceVertices[corners[i]]]; };
  const double width = covered(pointAt(1) - pointAt(0));
  const double height = covered(pointAt(2) - pointAt(0));
  const auto side = [&](int i) -> Vec2d {
    return (texcoords[corners[i]] - texcoords[corners[0]]).cast<double>();
  };
  const ImageTexture& image = *lookOf(f)->image;
  const int n = ImageTexture::samplesAcross(image.texelsAcross(width * side(1), height * side(2)));
  return colored(f, color, image.mean(n, [&](double right, double up) -> Vec2d {
    double second = std::clamp(b + (right - 0.5) * width, 0.0, 1.0);
    double third = std::clamp(c + (up - 0.5) * height, 0.0, 1.0);
    const double both = std::max(1.0, second + third);
    return blended(texcoords, second / both, third / both).template cast<double>();
  }));
}

}  // namespace vox
