#pragma once

#include "libvox/core/types.h"
#include "libvox/options/stop_rule.h"
#include "libvox/prepare/crease.h"
#include "libvox/prepare/interpolate.h"
#include "libvox/voxelize/level_counts.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vox {

/// What vertex conversion of a surface did (surface.h).
struct SurfaceReport {
  Index submeshes = 0;
  LevelCounts vertices{};
};

/// What polygon conversion of a surface did (polygons.h).
struct PolygonReport {
  std::uint64_t triangles = 0;
  std::uint64_t fanned = 0;  ///< polygons without a proper triangulation (triangulate.h)
  int levels = 0;            ///< Doo-Sabin steps down to the deepest vertex
  Index submeshes = 0;
};

/// What happened to one object.
struct ObjectReport {
  std::string name;
  std::uint64_t inputFaces = 0;
  Index submeshes = 0;             ///< 0 if fans of faces gave all vertices
  int levels = 0;                  ///< Doo-Sabin steps down to the deepest vertex
  std::uint64_t vertices = 0;      ///< vertices rounded to voxels, each at its own level
  LevelCounts verticesOfLevel{};   ///< the same, level by level
  std::uint64_t activeVoxels = 0;  ///< without the voxels that earlier objects switched on
  bool byPolygons = false;         ///< true: polygons were scanned; false: vertices were rounded
  StopRule until;                  ///< where the refinement of its polygons stopped
  PolygonReport polygons;
  CreaseCounts creases;
  InterpolationReport interpolation;  ///< its residual is in world units
};

struct ConvertReport {
  double voxelSize = 0;  ///< world units
  std::vector<ObjectReport> objects;
  std::uint64_t activeVoxels = 0;     ///< of the surfaces; if no grid needed them, of the level set
  std::vector<std::string> warnings;  ///< one line each
  std::string inputHash;              ///< of the scene, and of the images that were read
  int threads = 0;                    ///< number of threads that the run could use
  double prepareSeconds = 0;
  double surfaceSeconds = 0;  ///< subdivision and voxelization
  double gridsSeconds = 0;    ///< from voxels to grids
};

}  // namespace vox
