// The points of the next level, face by face.
// D. Doo, M. Sabin, Behaviour of recursive division surfaces near extraordinary points, 1978;
// Cohen, Kaufman & Wang 1994, section 2.1.

#include "libvox/subdivide/image_vertices.h"

#include "libvox/core/parallel.h"
#include "libvox/core/unit_root.h"
#include "libvox/subdivide/strip.h"

#include <algorithm>
#include <array>
#include <span>

namespace vox {
namespace {

constexpr Index kFacesPerTask = 1024;

/// Weights 9/16, 3/16, 1/16, 3/16: exact in binary, and the same bits for either winding.
void imageOfQuad(const PolygonMesh& mesh, Index begin, std::vector<Vec3d>& image) {
  std::array<const Vec3d*, 4> p;
  for (Index i = 0; i < 4; ++i) p[i] = &mesh.points[mesh.faceVertices[begin + i]];
  for (Index i = 0; i < 4; ++i)
    image[begin + i] =
        (9.0 * *p[i] + 3.0 * (*p[(i + 1) % 4] + *p[(i + 3) % 4]) + *p[(i + 2) % 4]) / 16.0;
}

/// With centroid m and first harmonic (A, B) of the face, in O(n):
/// U_i = V_i / 4 + 3/4 m + 1/(2n) (A cos t_i + B sin t_i),  t_i = 2 pi i / n.
void imageOfPolygon(const PolygonMesh& mesh, Index begin, std::span<const UnitRoot> roots,
                    std::vector<Vec3d>& image) {
  const auto n = static_cast<Index>(roots.size());
  const auto point = [&](Index i) -> const Vec3d& {
    return mesh.points[mesh.faceVertices[begin + i]];
  };
  Vec3d sum = Vec3d::Zero();
  Vec3d sumCosine = Vec3d::Zero();
  Vec3d sumSine = Vec3d::Zero();
  for (Index i = 0; i < n; ++i) {
    sum += point(i);
    sumCosine += roots[i].cosine * point(i);
    sumSine += roots[i].sine * point(i);
  }
  for (Index i = 0; i < n; ++i)
    image[begin + i] = 0.25 * point(i) + (0.75 / n) * sum +
                       (0.5 / n) * (roots[i].cosine * sumCosine + roots[i].sine * sumSine);
}

/// Images of faces one after the other; keeps the tables of the last size it met.
class FaceImages {
 public:
  FaceImages(const SubdivisionLevel& level, std::vector<Vec3d>& image)
      : level_(level), image_(image) {}

  void write(Index f) {
    const Index n = level_.mesh.faceSize(f);
    const Index edge =
        level_.boundary == BoundaryStage::kStrips ? boundaryCornerOf(level_, f) : kNone;
    if (edge != kNone)
      writeStrip(f, n - 2, edge);
    else if (n == 4)
      imageOfQuad(level_.mesh, level_.mesh.faceOffsets[f], image_);
    else
      writePolygon(f, n);
  }

 private:
  void writeStrip(Index f, Index m, Index edge) {
    constexpr Index kRegular = 2;  // needs no table
    if (m > kRegular && weights_.size() != m) weights_ = stripWeights(m);
    imageOfStrip(level_.mesh, f, edge, weights_, image_);
  }

  void writePolygon(Index f, Index n) {
    if (roots_.size() != n) roots_ = unitRoots(n);
    imageOfPolygon(level_.mesh, level_.mesh.faceOffsets[f], roots_, image_);
  }

  const SubdivisionLevel& level_;
  std::vector<Vec3d>& image_;
  std::vector<UnitRoot> roots_;
  std::vector<StripWeight> weights_;
};

}  // namespace

std::vector<Vec3d> imageVertices(const SubdivisionLevel& level) {
  const PolygonMesh& mesh = level.mesh;
  std::vector<Vec3d> image(nextPointCount(level));
  forParts(mesh.faceCount(), kFacesPerTask, [&](std::size_t begin, std::size_t end) {
    FaceImages faces(level, image);
    for (Index f = static_cast<Index>(begin); f != end; ++f) faces.write(f);
  });
  if (level.boundary == BoundaryStage::kExtend)
    chaikinPoints(mesh, level.adjacency, boundaryCorners(level.adjacency),
                  std::span(image).subspan(mesh.cornerCount()));
  return image;
}

std::uint64_t nextPointCount(const SubdivisionLevel& level) {
  const std::uint64_t corners = level.mesh.cornerCount();
  if (level.boundary != BoundaryStage::kExtend) return corners;
  const auto& twin = level.adjacency.twin;
  return corners + 2 * static_cast<std::uint64_t>(std::count(twin.begin(), twin.end(), kNone));
}

}  // namespace vox
