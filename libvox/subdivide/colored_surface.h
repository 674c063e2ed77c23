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
  virtual void point(const Vec3d& position, const Vec3d& color) = 0;
  /// The rows x columns vertices that a regular vertex has become (patch.h).
  virtual void patch(const Patch& position, const Patch& color, std::int64_t rows,
                     std::int64_t columns) = 0;
  /// `count` vertices along a curve (patch.h).
  virtual void curve(const CurvePoints& position, const CurvePoints& color, std::int64_t count) = 0;
};

/// A level whose points have colours.
struct ColoredLevel {
  SubdivisionLevel level;
  std::vector<Vec3d> colors;  ///< of points; of corners at level 0
};

/// The colours of the corners of a mesh: those of their points, or else of their faces; empty if it
/// has neither. Faces that meet at a point may differ in colour there: from level 1 on they blend.
std::vector<Vec3d> cornerColors(const PolygonMesh& mesh);

/// Level 1 of level 0 with colours of corners, which are refined exactly as positions are.
ColoredLevel firstColoredLevel(const ColoredLevel& base);
/// The level after one >= 1.
ColoredLevel nextColoredLevel(ColoredLevel level);

/// The vertices of a subdivided surface with their colours, each at the level where the faces
/// around it are fine enough for vertex conversion (stop.h), or in regular patches half a voxel
/// apart at most, on rows so far apart. So nearly every active voxel holds some. Submesh by
/// submesh: the faces around its pending vertices are cut out of each level, with those around
/// them, and subdivided as a mesh of their own; regular vertices leave as patches. So what is held
/// is a small multiple of the submesh. The bits of what is emitted do not depend on how the mesh is
/// cut.
///
/// One object per thread. Plain rather than fast: five to ten times the cost of LocalSurface.
class ColoredSurface {
 public:
  /// @param base    level 0, in index space, as for LocalSurface
  /// @param colors  of its corners
  ColoredSurface(const SubdivisionLevel& base, std::span<const Vec3d> colors);

  /// All that the corners of these faces have become.
  void emit(std::span<const Index> faces, ColoredSink& sink);

 private:
  void addOneRing(Index corner);
  ColoredLevel cutOut(std::span<const Index> faces);

  const SubdivisionLevel& base_;
  std::span<const Vec3d> colors_;
  std::vector<Index> faces_;          // of the submesh and around it
  std::vector<std::uint8_t> inside_;  // per face of the base: 1 if it is one of them
  std::vector<std::uint8_t> seen_;    // per point of the base: 1 if its faces are among them
  std::vector<Index> slots_;          // per face: where it went
  std::vector<Index> points_;         // per point
};

}  // namespace vox
