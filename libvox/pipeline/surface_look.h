#pragma once

#include "libvox/core/types.h"
#include "libvox/volume/image_texture.h"

#include <memory>
#include <optional>
#include <vector>

namespace vox {

struct PreparedSurface;

/// What a material looks like, ready to evaluate.
struct Look {
  Vec4f color;  ///< linear, and opacity
  std::optional<ImageTexture> image = {};
  bool multiplies = false;  ///< as Material::multiplies
};

/// What the faces of a prepared surface look like, besides the colours of its mesh.
struct SurfaceLook {
  std::vector<Vec2f> texcoords = {};   ///< per corner, NaN where there is none; or empty
  std::vector<Index> lookOfFace = {};  ///< per face, or kNone; empty: all have the first, if any
  std::vector<Look> looks = {};
};

/// The colours of a surface as functions of the place on it. What is given at the corners of a face
/// is blended: in the square of a corner bilinearly between the mean of the face, the middles of
/// two edges and the corner. So the value of a face never reaches into another one. Thread-safe.
class SurfaceColors {
 public:
  /// @param surface  must outlive this object
  explicit SurfaceColors(const PreparedSurface& surface);

  /// False if the surface has neither colours nor looks: then at() is plain everywhere.
  bool hasColors() const;

  /// True if the coverage may be below 1 somewhere.
  bool mayBeTransparent() const;

  /// Linear colour and coverage at a place in the square of a corner (mesh/limit_piece.h). An image
  /// counts by its mean over what a voxel covers, but within the face only.
  Vec4f at(Index corner, double u, double v) const;

  /// The same in a triangle of three corners of one face, with the weights of the second and the
  /// third.
  Vec4f at(const Index* corners, double b, double c) const;

 private:
  Vec4f colored(Index face, const Vec3f& meshColor, const std::optional<Vec4f>& image) const;
  const Look* lookOf(Index face) const;
  bool hasImage(Index face) const;

  const PreparedSurface& surface_;
  std::vector<Vec3f> cornerColors_;  // of the corners of the mesh, or empty
  std::vector<Vec3f> meanColors_;    // of each face
  std::vector<Vec2f> meanTexcoords_;
  std::vector<Vec3d> centroids_;  // if there are images
};

}  // namespace vox
