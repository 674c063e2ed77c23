// The points of the next level, face by face.
// D. Doo, M. Sabin, Behaviour of recursive division surfaces near extraordinary points, 1978;
// Cohen, Kaufman & Wang 1994, section 2.1.

#include "libvox/subdivide/image_vertices.h"

#include "libvox/core/parallel.h"
#include "libvox/subdivide/face_images.h"
#include "libvox/subdivide/strip.h"

#include <algorithm>
#include <span>

namespace vox {
namespace {

constexpr Index kFacesPerTask = 1024;

/// Computes the images of the faces of a level, one face after another.
class LevelImages {
 public:
  LevelImages(const SubdivisionLevel& level, std::vector<Vec3d>& image)
      : level_(level), image_(image) {}

  void write(Index f) {
    const Index n = level_.mesh.faceSize(f);
    const Index edge =
        level_.boundary == BoundaryStage::kStrips ? boundaryCornerOf(level_, f) : kNone;
    if (edge != kNone)
      writeStrip(f, n - 2, edge);
    else
      writeFace(f, n);
  }

 private:
  void writeStrip(Index f, Index m, Index edge) {
    constexpr Index kRegular = 2;  // needs no table
    if (m > kRegular && weights_.size() != m) weights_ = stripWeights(m);
    imageOfStrip(level_.mesh, f, edge, weights_, image_);
  }

  void writeFace(Index f, Index n) {
    corners_.clear();
    for (const Index v : level_.mesh.face(f)) corners_.push_back(level_.mesh.points[v]);
    images_.of(corners_, std::span(image_).subspan(level_.mesh.faceOffsets[f], n));
  }

  const SubdivisionLevel& level_;
  std::vector<Vec3d>& image_;
  std::vector<Vec3d> corners_;
  FaceImages images_;
  std::vector<StripWeight> weights_;
};

}  // namespace

std::vector<Vec3d> imageVertices(const SubdivisionLevel& level) {
  const PolygonMesh& mesh = level.mesh;
  std::vector<Vec3d> image(nextPointCount(level));
  parallelForRanges(mesh.faceCount(), kFacesPerTask, [&](std::size_t begin, std::size_t end) {
    LevelImages faces(level, image);
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
