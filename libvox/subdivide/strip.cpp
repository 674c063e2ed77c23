// The boundary of an extended mesh: its points, and the image vertices of strip faces.

#include "libvox/subdivide/strip.h"

#include "libvox/core/parallel.h"
#include "libvox/core/unit_root.h"
#include "libvox/mesh/chaikin.h"

namespace vox {
namespace {

constexpr std::size_t kEdgesPerTask = 4096;

/// The corners of a strip face, from the start Mm of its boundary edge on.
class Strip {
 public:
  Strip(const PolygonMesh& mesh, Index f, Index boundaryCorner)
      : mesh_(mesh),
        begin_(mesh.faceOffsets[f]),
        size_(mesh.faceSize(f)),
        first_(boundaryCorner - begin_) {}

  Index inner() const { return size_ - 2; }             ///< the number m
  Index last() const { return corner(0); }              ///< the corner of Mm
  Index first() const { return corner(1); }             ///< the corner of M1
  Index inner(Index i) const { return corner(i + 2); }  ///< the corner of u_(i+1)
  const Vec3d& at(Index c) const { return mesh_.points[mesh_.faceVertices[c]]; }

 private:
  Index corner(Index i) const {
    const Index k = first_ + i;
    return begin_ + (k < size_ ? k : k - size_);
  }

  const PolygonMesh& mesh_;
  Index begin_;
  Index size_;
  Index first_;
};

void imageOfInnerOne(const Strip& strip, std::vector<Vec3d>& image) {
  const Index u = strip.inner(0);
  image[u] = (2.0 * strip.at(u) + strip.at(strip.first()) + strip.at(strip.last())) / 4.0;
}

void imageOfInnerTwo(const Strip& strip, std::vector<Vec3d>& image) {
  const Index u1 = strip.inner(0);
  const Index u2 = strip.inner(1);
  const Vec3d one = strip.at(u1) + strip.at(strip.first());
  const Vec3d two = strip.at(u2) + strip.at(strip.last());
  image[u1] = (3.0 * one + two) / 8.0;
  image[u2] = (one + 3.0 * two) / 8.0;
}

void imageOfInner(const Strip& strip, std::span<const StripWeight> weights,
                  std::vector<Vec3d>& image) {
  const Vec3d c = middle(strip.at(strip.first()), strip.at(strip.last()));
  const Vec3d d = (strip.at(strip.first()) - strip.at(strip.last())) / 2.0;
  const auto m = static_cast<Index>(weights.size());
  const auto offset = [&](Index i) -> Vec3d {
    return strip.at(strip.inner(i)) - c - weights[i].ratio * d;
  };
  Vec3d sum = Vec3d::Zero();
  for (Index i = 0; i < m; ++i) sum += weights[i].sine * offset(i);
  sum *= 0.5 / m;
  for (Index i = 0; i < m; ++i)
    image[strip.inner(i)] =
        c + (0.5 * weights[i].ratio) * d + 0.25 * offset(i) + weights[i].sine * sum;
}

}  // namespace

std::vector<Index> boundaryCorners(const Adjacency& adjacency) {
  std::vector<Index> corners;
  for (Index c = 0; c < static_cast<Index>(adjacency.twin.size()); ++c)
    if (adjacency.twin[c] == kNone) corners.push_back(c);
  return corners;
}

void chaikinPoints(const PolygonMesh& mesh, const Adjacency& adjacency,
                   std::span<const Index> boundary, std::span<Vec3d> points) {
  parallelForEach(boundary.size(), kEdgesPerTask, [&](std::size_t k) {
    const Index c = boundary[k];
    const Vec3d& v = mesh.points[mesh.faceVertices[c]];
    const Vec3d& w = mesh.points[mesh.faceVertices[nextCorner(mesh, adjacency, c)]];
    points[2 * k] = chaikin(v, w);
    points[2 * k + 1] = chaikin(w, v);
  });
}

Index boundaryCornerOf(const SubdivisionLevel& level, Index f) {
  for (Index c = level.mesh.faceOffsets[f]; c < level.mesh.faceOffsets[f + 1]; ++c)
    if (level.adjacency.twin[c] == kNone) return c;
  return kNone;
}

std::vector<StripWeight> stripWeights(Index m) {
  std::vector<StripWeight> weights(m);
  const double first = unitRoot(1, 4 * m).cosine;
  for (Index i = 0; i < m; ++i) {
    const UnitRoot root = unitRoot(2 * i + 1, 4 * m);
    weights[i] = {root.sine, root.cosine / first};
  }
  return weights;
}

void imageOfStrip(const PolygonMesh& mesh, Index f, Index boundaryCorner,
                  std::span<const StripWeight> weights, std::vector<Vec3d>& image) {
  const Strip strip(mesh, f, boundaryCorner);
  const Vec3d& first = strip.at(strip.first());
  const Vec3d& last = strip.at(strip.last());
  image[strip.first()] = chaikin(first, last);
  image[strip.last()] = chaikin(last, first);
  if (strip.inner() == 1)
    imageOfInnerOne(strip, image);
  else if (strip.inner() == 2)
    imageOfInnerTwo(strip, image);
  else
    imageOfInner(strip, weights, image);
}

}  // namespace vox
