// Normals at the vertices of vertex conversion.

#include "libvox/pipeline/vertex_normals.h"

#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/voxel_means.h"
#include "libvox/localize/partition.h"
#include "libvox/mesh/patch_parts.h"
#include "libvox/pipeline/surface.h"
#include "libvox/subdivide/depth_rule.h"
#include "libvox/subdivide/local_vertices.h"
#include "libvox/subdivide/stop.h"
#include "libvox/subdivide/thin_patch.h"
#include "libvox/voxelize/normal_sampler.h"
#include "libvox/voxelize/row.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace vox {
namespace {

/// Buffers of one thread.
struct VertexNormals {
  LocalVertices vertices;
  VertexArray array;
  explicit VertexNormals(const SubdivisionLevel& base) : vertices(base) {}
};
using Samplers = tbb::enumerable_thread_specific<NormalSampler>;

/// Patches of more levels are shared among threads.
constexpr int kMostLevelsOfSampling = 8;

void samplePatch(const Patch& patch, int levels, const Progress& progress, Samplers& samplers) {
  progress.check();
  if (levels <= kMostLevelsOfSampling) return samplers.local().patch(patch, levels, levels);
  const auto children = childrenOf(patch);
  parallelForEach(4, 1, [&](std::size_t child) {
    samplePatch(children[child / 2][child % 2], levels - 1, progress, samplers);
  });
}

/// Samples the vertices that vertex conversion makes of a thin patch.
void sampleThin(const ThinPatch& thin, const Progress& progress, NormalSampler& sampler) {
  const std::int64_t n = std::int64_t{1} << thin.levels;
  constexpr auto kMostOfRow = static_cast<std::int64_t>(LeafCache::kPositionsAtOnce);
  LeafCache::Positions positions;
  const auto sampleRow = [&](const Patch& patch, std::int64_t i) {
    progress.check();
    const CurvePoints row = rowOf(patch, {i, n});
    const LimitNormals normals(patch, SplinePlace::ofVertex(i, n));
    for (std::int64_t first = 0; first < n; first += kMostOfRow) {
      const std::int64_t count = std::min(kMostOfRow, n - first);
      setRow(row, n, first, static_cast<std::size_t>(count), positions);
      for (std::int64_t j = 0; j < count; ++j)
        sampler.point(positions[static_cast<std::size_t>(j)],
                      normals.at(SplinePlace::ofVertex(first + j, n)));
    }
  };
  for (const std::int64_t i : thin.rows) sampleRow(thin.patch, i);
  const Patch across = quarterTurn(thin.patch);
  for (const std::int64_t j : {std::int64_t{0}, n - 1}) sampleRow(across, j);
}

void sampleVertex(const LocalVertices::Corner& corner, const DepthRule& rule,
                  const Progress& progress, VertexNormals& normals, Samplers& samplers) {
  const LevelOneVertex vertex = normals.vertices.at(corner);
  // All vertices that switched on voxels: with fewer, voxels would be left without a normal.
  const auto sample = [&](const Patch& patch) {
    forEachPatchPart(
        PatchPart(patch), 0,
        [&](const ThinPatch& thin, int) { sampleThin(thin, progress, samplers.local()); },
        [&](const Patch& part, int levels, int) {
          samplePatch(continued(part), levels, progress, samplers);
        });
  };
  if (vertex.regular) return sample(vertex.patch);
  const VertexFaces faces = normals.vertices.facesAt(corner);
  if (!vertex.whole()) return samplers.local().point(vertex.at, faces.f.normal);
  normals.array.set(vertex, rule.of(vertex, &faces, {}), true);
  for (const VertexArray::Block& block : normals.array.blocks())
    if (block.depth == VertexDepth{})  // the patch may hold only the tangents
      samplers.local().patch(continued(block.patch), 0, 0);
    else
      sample(block.patch);
}

}  // namespace

void addNormalsOfVertices(const SubdivisionLevel& base, Progress& progress, VoxelMeans& means) {
  const DepthRule rule(StopRule{.diameter = 1});
  const Partition partition = coverGreedily(base.mesh, base.adjacency, kDefaultSubmeshFaces);
  Samplers samplers([&] { return NormalSampler(means); });
  tbb::enumerable_thread_specific<VertexNormals> threads([&] { return VertexNormals(base); });
  parallelForEach(partition.size(), 1, [&](Index s) {
    // Isolated: while a thread waits for parts of a patch, it must not start another submesh.
    tbb::this_task_arena::isolate([&] {
      VertexNormals& normals = threads.local();
      const auto faces = partition.submesh(s);
      normals.vertices.set(faces);
      Index slot = 0;
      for (const Index f : faces) {
        const Index size = base.mesh.faceSize(f);
        LocalVertices::Corner c{slot, 0, size, base.mesh.faceOffsets[f]};
        for (Index i = 0; i < size; ++i, c = c.next())
          sampleVertex(c, rule, progress, normals, samplers);
        slot += size;
      }
    });
    progress.done(1.0 / static_cast<double>(partition.size()));
  });
}

}  // namespace vox
