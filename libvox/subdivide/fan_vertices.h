#pragma once

#include "libvox/core/types.h"
#include "libvox/mesh/patch.h"
#include "libvox/subdivide/face_images.h"
#include "libvox/subdivide/level.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace vox {

/// The vertices of a dense mesh, whose faces measure a few voxels: those that are fine enough at
/// level 1 or 2 follow from the fan of faces around one vertex of the mesh, without any submesh.
/// They are the vertices that LocalSurface makes there, bit for bit. One object per thread.
///
/// All corners of a fan together make some vertices, or none: if one of them needs more levels,
/// LocalSurface makes all. Source: DESIGN section 7.
class FanVertices {
 public:
  /// @param base  level 0, in index space: an oriented manifold with one fan of faces at each
  ///   vertex; must outlive this object
  explicit FanVertices(const SubdivisionLevel& base) : base_(base) {}

  /// Gives the sink the vertices that the corners around a vertex own, each at its own level.
  /// @param lowest   the lowest corner at an interior vertex
  /// @param valence  number of corners there
  /// @param sink     null: only the answer counts
  /// @return false: it gave nothing, since some vertex is not fine enough at level 2, or there are
  ///   too many faces or sides of a face
  bool emit(Index lowest, Index valence, SurfaceSink* sink);

  /// Gives the sink what is collected. Call it in the end.
  void flush(SurfaceSink& sink);

  /// Vertices that emit makes are nearer to their vertex of the mesh than this (L-inf, voxels).
  /// Patches have steps of at most 2^3 voxels. A corner of a quad is as far from its centroid as 2
  /// steps, and 4 times the twist of its images, which is at most half a step.
  static constexpr double kReach = 64;

 private:
  static constexpr Index kMostSides = 8;
  static constexpr Index kMostFaces = 24;

  /// A face of the fan at level 1.
  struct Face {
    Index size;
    Index place;  ///< of the vertex
    double diameter;
    std::array<Vec3d, kMostSides> images;

    const Vec3d& at() const { return images[place]; }
    const Vec3d& next() const { return images[place + 1 == size ? 0 : place + 1]; }
    const Vec3d& previous() const { return images[(place == 0 ? size : place) - 1]; }
  };
  enum class Way { kLevel1, kLevel2, kPatch };

  bool gatherFineTriangles(Index lowest, Index valence);
  bool gather(Index lowest, Index valence);
  void setFace(Index f, Face& face);
  std::optional<Way> wayOf(Index i, double vFaceDiameter) const;
  double edgeFaceDiameter(Index i) const;
  Patch around(Index i) const;
  void makeChildren(Index i);
  void setImages(std::span<const Vec3d> corners, std::span<Vec3d> images) {
    imagesOfSize_[corners.size()].of(corners, images);
  }

  Index after(Index i) const { return i + 1 == valence_ ? 0 : i + 1; }
  Index before(Index i) const { return (i == 0 ? valence_ : i) - 1; }

  const SubdivisionLevel& base_;
  std::array<FaceImages, kMostFaces + 1> imagesOfSize_;
  Index valence_ = 0;
  std::array<Face, kMostFaces> faces_;      // counter-clockwise from the lowest corner
  std::array<Vec3d, kMostFaces> ring_;      // vertices of the mesh around that of the fan
  std::array<Vec3d, kMostFaces> vFace_;     // level 1
  std::array<Vec3d, kMostFaces> inVFace_;   // level 2
  std::array<std::vector<Vec3d>, 2> fine_;  // collected vertices, by level
};

}  // namespace vox
