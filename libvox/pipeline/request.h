#pragma once

#include "libvox/grid/transform.h"
#include "libvox/io/scene_file.h"
#include "libvox/options/convert_options.h"
#include "libvox/pipeline/choose.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace vox {

// Where several places set a value, the command line (the options) wins over the object, the object
// over the scene, the scene over the default. This is the only file that decides it.

struct Request;

/// How fine the grid is: voxels of a size in world units, or `dim` of them along the longest side.
struct Resolution {
  std::optional<double> voxelSize = {};  ///< wins over dim
  std::optional<int> dim = {};           ///< default: kDefaultDim
  std::optional<Vec3d> origin = {};      ///< as in ConvertOptions; only with voxelSize

  bool isSet() const { return voxelSize || dim; }
};
Resolution resolutionOf(const Scene& scene, const ConvertOptions& options);

/// Transform of that resolution for an input within a box, without a turn.
/// @throws UsageError, InputError, LimitError  as transformForDim and transformForVoxelSize
GridTransform transformFor(const Resolution& resolution, const Box& box);

/// A transform of that size for the surfaces of a request: with its turn, and with the lattice that
/// it asks for.
GridTransform placedFor(const Request& request, GridTransform transform);

/// How an object is made ready to subdivide.
struct ObjectPreparation {
  BoundaryRule boundary = BoundaryRule::kExtend;
  Interpolate interpolate = Interpolate::kNothing;
  std::vector<Index> interpolatedVertices = {};  ///< interior ones, besides `interpolate`
  CreaseRule crease = {};
  std::vector<PointPair> creaseEdges = {};  ///< sharp besides
  std::vector<Index> cornerVertices = {};   ///< where the surface has a corner
  FaceRule faces = FaceRule::kSplit;
  double weldTolerance = 0;            ///< world units
  ComponentLimit dropComponents = {};  ///< components below it are left out
  bool strict = false;                 ///< a mesh that needs repair is refused
  bool followsTexcoords = false;       ///< texture coordinates of corners are found again

  /// True if some edge or vertex may be sharp.
  bool mayCrease() const {
    return crease.degrees || crease.groups || !creaseEdges.empty() || !cornerVertices.empty() ||
           boundary == BoundaryRule::kCorners;
  }
  /// True if the surface is to pass through some vertex.
  bool interpolates() const {
    return interpolate != Interpolate::kNothing || !interpolatedVertices.empty();
  }
};

/// One for each object of the scene.
std::vector<ObjectPreparation> preparationsOf(const Scene& scene,
                                              const PreparationOptions& options);

/// @throws UsageError  the boundary of an object is free, but is to be interpolated or has creases;
///   the options list vertices or edges, but the scene has several objects
void requirePreparable(const Scene& scene, const PreparationOptions& options);

/// What to do with an object.
struct ObjectRequest {
  ObjectPreparation preparation;
  ConversionWay way;
  std::optional<TextureSpec> texture;
};

/// What to do with a scene: every option resolved, and checked. Made by resolve().
struct Request {
  Resolution resolution;
  Turn turn = Turn::kNoTurn;
  std::optional<Box> bounds;               ///< as in ConvertOptions
  std::optional<std::array<int, 6>> clip;  ///< as in ConvertOptions
  std::optional<RunPart> part;             ///< only its pages
  std::vector<GridKind> grids;             ///< in the order asked for
  std::optional<PartBy> partBy;            ///< what parts are; nothing: defaultPartBy()
  bool splits = false;                     ///< the grid density becomes a grid for each part
  VolumeSettings volume;
  Separation separation;
  SurfaceOptions surface;
  RunOptions run;
  /// True if not all voxels are wanted.
  bool crops() const { return bounds || clip || part; }

  /// True if it matters what materials and images look like.
  bool hasLooks() const;
  /// True if voxels are told by their parts.
  bool hasParts() const;
  /// True if parts go from the surface to the inside: then they need all of it.
  bool spreadsParts() const { return hasParts() && volume.fill == Fill::kSolid; }

  std::string optionText;              ///< the options that were set, as metadata `vox_options`
  std::vector<ObjectRequest> objects;  ///< one for each object of the scene

 private:
  /// Takes the options that neither scene nor object can set.
  explicit Request(const ConvertOptions& options)
      : separation(options.separation), surface(options.surface), run(options.run) {}
  friend Request resolve(const Scene& scene, const ConvertOptions& options);
};

/// @throws UsageError  a stop rule, or its combination with the way to voxelize and the separation,
///   is impossible (choose.h); a number of the volume options is out of range, or OpenVDB lacks the
///   compression; the bounds are no box, or there is an origin without a voxel size; a texture is
///   asked for without the color grid, or a split without the density grid, or by other parts; as
///   requirePreparable
Request resolve(const Scene& scene, const ConvertOptions& options);

}  // namespace vox
