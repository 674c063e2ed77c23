#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/level.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// Receives the vertices of a subdivided surface with their colours. Thread-safe.
class ColoredSink {
 public:
  virtual ~ColoredSink() = default;
  /// A single vertex.
  virtual void point(const Vec3d& position, const Vec3d& color) = 0;
  /// rows x columns vertices, the descendants of a regular vertex, evaluated as in patch.h.
  virtual void patch(const Patch& position, const Patch& color, std::int64_t rows,
                     std::int64_t columns) = 0;
  /// `count` vertices along a curve, evaluated as in patch.h.
  virtual void curve(const CurvePoints& position, const CurvePoints& color, std::int64_t count) = 0;
};

/// A level whose points have colours.
struct ColoredLevel {
  SubdivisionLevel level;
  std::vector<Vec3d> colors;  ///< one per point; at level 0 one per corner
};

/// The colours of the corners of a mesh: those of their points, or else of their faces; empty if
/// the mesh has neither. Corners at one point may differ in colour; from level 1 on the colours
/// blend.
std::vector<Vec3d> cornerColors(const PolygonMesh& mesh);

/// Level 1 from level 0. Colours are refined with the weights of positions.
ColoredLevel firstColoredLevel(const ColoredLevel& base);
/// The next level from a level >= 1.
ColoredLevel nextColoredLevel(ColoredLevel level);

/// Emits the vertices of a subdivided surface with their colours, submesh by submesh. A vertex is
/// emitted as it is if the faces around it are fine enough for vertex conversion (stop.h); if not,
/// but if it is regular, its descendants are emitted: rows at most half a voxel apart, with
/// vertices at most half a voxel apart. So nearly every active voxel holds a vertex.
///
/// From each level, the faces around the vertices that are left are cut out, with their neighbours,
/// and subdivided as a mesh of their own. So memory is a small multiple of the submesh. The bits of
/// vertices and colours do not depend on the partition of the mesh.
///
/// One object per thread. Simple rather than fast: five to ten times the cost of LocalSurface.
class ColoredSurface {
 public:
  /// @param base    level 0, in index space, as for LocalSurface
  /// @param colors  one per corner of the base; must stay valid
  ColoredSurface(const SubdivisionLevel& base, std::span<const Vec3d> colors);

  /// Emits all descendants of the corners of these faces.
  void emit(std::span<const Index> faces, ColoredSink& sink);

 private:
  void addOneRing(Index corner);
  ColoredLevel cutOut(std::span<const Index> faces);

  const SubdivisionLevel& base_;
  std::span<const Vec3d> colors_;
  std::vector<Index> faces_;          // the submesh and its one-ring
  std::vector<std::uint8_t> inside_;  // per face of the base: 1 if it is in faces_
  std::vector<std::uint8_t> seen_;    // per point of the base: 1 if its faces are in faces_
  std::vector<Index> slots_;          // per face of the base: its number in the piece, or kNone
  std::vector<Index> points_;         // per point of the base: its number in the piece, or kNone
};

}  // namespace vox
