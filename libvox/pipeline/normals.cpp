// Normals to voxels: paper section 8.

#include "libvox/pipeline/normals.h"

#include "libvox/core/parallel.h"
#include "libvox/localize/partition.h"
#include "libvox/mesh/area_vector.h"
#include "libvox/pipeline/refined_polygons.h"
#include "libvox/pipeline/surface.h"
#include "libvox/subdivide/local_vertices.h"
#include "libvox/subdivide/stop.h"
#include "libvox/voxelize/normal_sampler.h"
#include "libvox/voxelize/scan.h"
#include "libvox/voxelize/triangulate.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <vector>

namespace vox {
namespace {

/// One thread's way from polygons to means.
class NormalSink : public PolygonSink {
 public:
  explicit NormalSink(VoxelMeans& means) : writer_(means) {}

  void polygons(const PolygonMesh& piece) override { faces(piece, 0, piece.faceCount()); }

  void faces(const PolygonMesh& mesh, Index begin, Index end) {
    triangles_.clear();
    normals_.clear();
    for (Index f = begin; f != end; ++f) addTriangles(mesh, f);
    scanTriangles(mesh.points, triangles_, Separation::k26, [this](const VoxelBlock& block) {
      forEachVoxel(block, [&](std::int32_t x, std::int32_t y, std::int32_t z) {
        writer_.add({x, y, z}, normals_[block.triangle]);
      });
    });
  }

 private:
  void addTriangles(const PolygonMesh& mesh, Index f) {
    const auto face = mesh.face(f);
    const Vec3d normal =
        twiceAreaVector(face.size(), [&](std::size_t i) { return mesh.points[face[i]]; });
    if (normal.isZero(0)) return;
    faces_.add(mesh, f, triangles_);
    normals_.resize(triangles_.size(), normal.normalized());
  }

  VoxelMeans::Writer writer_;
  FaceTriangulator faces_;
  std::vector<std::array<Index, 3>> triangles_;  // of a piece
  std::vector<Vec3d> normals_;                   // of these
};

/// One thread's part of normals at vertices.
struct VertexNormals {
  LocalVertices vertices;
  VertexArray array;
  explicit VertexNormals(const SubdivisionLevel& base) : vertices(base) {}
};
using Samplers = tbb::enumerable_thread_specific<NormalSampler>;

/// Patches of more levels are shared among threads.
constexpr int kMostLevelsOfTask = 8;

void samplePatch(const Patch& patch, int rows, int columns, Samplers& samplers) {
  if (std::max(rows, columns) <= kMostLevelsOfTask)
    return samplers.local().patch(patch, rows, columns);
  const bool turn = rows < columns;
  const auto halves = halvesAlongU(turn ? quarterTurn(patch) : patch);
  forEach(halves.size(), 1, [&](std::size_t half) {
    samplePatch(halves[half], std::max(rows, columns) - 1, std::min(rows, columns), samplers);
  });
}

void sampleVertex(const LocalVertices::Corner& corner, const DepthRule& rule,
                  VertexNormals& normals, Samplers& samplers) {
  const LevelOneVertex vertex = normals.vertices.at(corner);
  // As many vertices of a patch as blacken voxels: with fewer, voxels would be left out.
  const auto sample = [&](const Patch& partial) {
    const Patch patch = continued(partial);
    const PatchDepth depth = patchDepth(patch);
    samplePatch(patch, depth.alongU, depth.alongV, samplers);
  };
  if (vertex.regular) return sample(vertex.patch);
  const VertexFaces faces = normals.vertices.facesAt(corner);
  if (!vertex.whole()) return samplers.local().point(vertex.at, faces.f.normal);
  normals.array.set(vertex, rule.of(vertex, &faces, {}), true);
  for (const VertexArray::Block& block : normals.array.blocks()) sample(block.patch);
}

void addAtVertices(const SubdivisionLevel& base, Progress& progress, VoxelMeans& means) {
  const DepthRule rule(StopRule{.diameter = 1});
  const Partition partition = coverGreedily(base.mesh, base.adjacency, kDefaultSubmeshFaces);
  Samplers samplers([&] { return NormalSampler(means); });
  tbb::enumerable_thread_specific<VertexNormals> threads([&] { return VertexNormals(base); });
  forEach(partition.size(), 1, [&](Index s) {
    progress.check();
    // Isolated: a thread that waits for parts of a patch must not begin another submesh.
    tbb::this_task_arena::isolate([&] {
      VertexNormals& normals = threads.local();
      const auto faces = partition.submesh(s);
      normals.vertices.set(faces);
      Index slot = 0;
      for (const Index f : faces) {
        const Index size = base.mesh.faceSize(f);
        LocalVertices::Corner c{slot, 0, size, base.mesh.faceOffsets[f]};
        for (Index i = 0; i < size; ++i, c = c.next()) sampleVertex(c, rule, normals, samplers);
        slot += size;
      }
    });
    progress.done(1.0 / static_cast<double>(partition.size()));
  });
}

}  // namespace

void addNormals(const SubdivisionLevel& base, const ConversionWay& way, Progress& progress,
                VoxelMeans& means) {
  if (!way.polygons) return addAtVertices(base, progress, means);
  tbb::enumerable_thread_specific<NormalSink> sinks([&] { return NormalSink(means); });
  if (way.until.levels == 0) {
    constexpr std::size_t kFacesPerPart = 64;
    forParts(base.mesh.faceCount(), kFacesPerPart, [&](std::size_t begin, std::size_t end) {
      progress.check();
      sinks.local().faces(base.mesh, static_cast<Index>(begin), static_cast<Index>(end));
    });
    return;
  }
  const PolygonPlan plan = planPolygons(base, way.until, kDefaultSubmeshFaces, progress);
  makePolygons(base, plan, progress, [&]() -> PolygonSink& { return sinks.local(); });
}

}  // namespace vox
