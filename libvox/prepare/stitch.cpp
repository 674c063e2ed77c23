// Edges look for vertices in a tree of boxes. What each edge finds is sorted along the edge; then
// the parts of all edges are sorted, which shows those that join.

#include "libvox/prepare/stitch.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/prepare/box_tree.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <tuple>
#include <utility>

namespace vox {
namespace {

using Edge = std::pair<Index, Index>;  // the lower vertex first

Edge edgeBetween(Index v, Index w) {
  return {std::min(v, w), std::max(v, w)};
}

/// The corners whose edge has one face.
std::vector<Index> boundaryCorners(const PolygonMesh& mesh, const Joints& joints) {
  const Adjacency& adjacency = joints.adjacency;
  const auto edgeOf = [&](Index c) {
    return edgeBetween(mesh.faceVertices[c], mesh.faceVertices[nextCorner(mesh, adjacency, c)]);
  };
  std::vector<Edge> crowded;
  for (const Index c : joints.crowdedEdges) crowded.push_back(edgeOf(c));
  std::sort(crowded.begin(), crowded.end());
  std::vector<Index> corners;
  for (Index c = 0; c < mesh.cornerCount(); ++c)
    if (adjacency.twin[c] == kNone &&
        !std::binary_search(crowded.begin(), crowded.end(), edgeOf(c)))
      corners.push_back(c);
  return corners;
}

bool isFloat(double x) {
  return static_cast<double>(static_cast<float>(x)) == x;
}

bool allFloats(const std::vector<Vec3d>& points) {
  return std::all_of(points.begin(), points.end(), [](const Vec3d& p) {
    return isFloat(p.x()) && isFloat(p.y()) && isFloat(p.z());
  });
}

/// Unit in the last place of a float. `x` is not negative.
double unitOfFloat(double x) {
  constexpr int kDigits = std::numeric_limits<float>::digits;
  return x > 0 ? std::ldexp(1.0, std::ilogb(x) - (kDigits - 1)) : 0;
}

/// Whether points lie on an edge.
class EdgeRange {
 public:
  EdgeRange(const Vec3d& from, const Vec3d& to, double tolerance, bool floats)
      : from_(from), along_(to - from), tolerance_(tolerance), floats_(floats) {
    constexpr double kUnits = 4;
    largest_ = from.cwiseAbs().cwiseMax(to.cwiseAbs());
    rounding_ = kUnits * std::numeric_limits<double>::epsilon() * largest_.maxCoeff();
    for (int axis = 0; axis < 3 && floats; ++axis)
      rounding_ = std::max(rounding_, unitOfFloat(largest_[axis]));
    squaredLength_ = along_.squaredNorm();
  }

  /// Farther points are not on the edge, along any axis.
  double reach() const { return std::max(tolerance_, rounding_); }

  /// Where a point lies along the edge, between 0 and 1; negative if it does not lie on it.
  double placeOf(const Vec3d& p) const {
    const Vec3d off = p - from_;
    const double t = off.dot(along_) / squaredLength_;
    if (!(t > 0 && t < 1)) return -1;
    const Vec3d miss = off - t * along_;
    if (miss.norm() > tolerance_ && !isRounding(miss) && !(floats_ && isRoundingOfFloats(off)))
      return -1;
    const double nearEnd = reach();
    if (off.norm() <= nearEnd || (off - along_).norm() <= nearEnd) return -1;
    return t;
  }

  /// Whether the edge may come as near as its reach to a point of the box.
  bool meets(const Eigen::AlignedBox3d& box) const {
    const double reach = this->reach();
    double begin = 0;
    double end = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = box.min()[axis] - reach - from_[axis];
      const double high = box.max()[axis] + reach - from_[axis];
      if (along_[axis] == 0) {
        if (low > 0 || high < 0) return false;
        continue;
      }
      const auto [first, last] = std::minmax({low / along_[axis], high / along_[axis]});
      begin = std::max(begin, first);
      end = std::min(end, last);
    }
    constexpr double kRounding = 1e-12;
    return begin <= end + kRounding;
  }

 private:
  bool isRounding(const Vec3d& miss) const {
    constexpr double kUnits = 4;
    return miss.cwiseAbs().maxCoeff() <=
           kUnits * std::numeric_limits<double>::epsilon() * largest_.maxCoeff();
  }

  /// Whether some point of the line is less than a unit of floats off along each axis.
  bool isRoundingOfFloats(const Vec3d& off) const {
    constexpr double kPartOfUnit = 0.99;
    double begin = 0;
    double end = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double unit = kPartOfUnit * unitOfFloat(largest_[axis]);
      if (along_[axis] == 0) {
        if (std::abs(off[axis]) > unit) return false;
        continue;
      }
      const auto [first, last] =
          std::minmax({(off[axis] - unit) / along_[axis], (off[axis] + unit) / along_[axis]});
      begin = std::max(begin, first);
      end = std::min(end, last);
    }
    return begin <= end;
  }

  Vec3d from_;
  Vec3d along_;
  double tolerance_;
  bool floats_;
  Vec3d largest_;
  double rounding_ = 0;
  double squaredLength_ = 0;
};

/// A vertex on an edge.
struct Found {
  std::size_t edge;  // index among the boundary corners
  double place;
  Index vertex;
  bool operator<(const Found& other) const {
    return std::tie(edge, place, vertex) < std::tie(other.edge, other.place, other.vertex);
  }
};

class TJunctions {
 public:
  TJunctions(const PolygonMesh& mesh, const Joints& joints, double tolerance)
      : mesh_(mesh),
        adjacency_(joints.adjacency),
        tolerance_(tolerance),
        corners_(boundaryCorners(mesh, joints)) {}

  std::vector<EdgeVertex> find() {
    if (corners_.empty() || !search()) return {};
    keepJoining();
    std::vector<EdgeVertex> result;
    for (const Found& found : found_) result.push_back({corners_[found.edge], found.vertex});
    return result;
  }

 private:
  Index startOf(std::size_t edge) const { return mesh_.faceVertices[corners_[edge]]; }
  Index endOf(std::size_t edge) const {
    return mesh_.faceVertices[nextCorner(mesh_, adjacency_, corners_[edge])];
  }

  /// Finds the vertices on all edges. False if that would take too long.
  bool search() {
    const bool floats = allFloats(mesh_.points);
    findVertices();
    std::vector<Eigen::AlignedBox3d> boxes(vertices_.size());
    for (std::size_t k = 0; k < boxes.size(); ++k) boxes[k].extend(mesh_.points[vertices_[k]]);
    const BoxTree tree(boxes);

    constexpr std::uint64_t kMostSteps = 2'000'000'000;
    const std::uint64_t mostFound = 1000 + 16 * std::uint64_t{corners_.size()};
    std::atomic<std::uint64_t> steps = 0;
    std::atomic<std::uint64_t> count = 0;
    std::mutex lock;
    constexpr std::size_t kEdgesPerTask = 256;
    const auto isTooMuch = [&] { return steps > kMostSteps || count > mostFound; };
    parallelForRanges(corners_.size(), kEdgesPerTask, [&](std::size_t begin, std::size_t end) {
      std::vector<Found> here;
      for (std::size_t e = begin; e < end && !isTooMuch(); ++e) {
        const std::size_t before = here.size();
        steps += searchEdge(e, tree, floats, here);
        count += here.size() - before;
      }
      const std::lock_guard guard(lock);
      found_.insert(found_.end(), here.begin(), here.end());
    });
    if (isTooMuch()) return false;
    parallelSort(found_);
    return true;
  }

  /// The boundary vertices, and the faces around them.
  void findVertices() {
    std::vector<bool> isBoundary(mesh_.pointCount(), false);
    for (std::size_t e = 0; e < corners_.size(); ++e)
      isBoundary[startOf(e)] = isBoundary[endOf(e)] = true;
    for (Index v = 0; v < mesh_.pointCount(); ++v)
      if (isBoundary[v]) vertices_.push_back(v);
    for (Index c = 0; c < mesh_.cornerCount(); ++c)
      if (isBoundary[mesh_.faceVertices[c]])
        facesAt_.emplace_back(mesh_.faceVertices[c], adjacency_.cornerFace[c]);
    parallelSort(facesAt_);
  }

  /// @return  the number of steps
  std::uint64_t searchEdge(std::size_t e, const BoxTree& tree, bool floats,
                           std::vector<Found>& found) const {
    const EdgeRange edge(mesh_.points[startOf(e)], mesh_.points[endOf(e)], tolerance_, floats);
    const Index face = adjacency_.cornerFace[corners_[e]];
    std::uint64_t steps = 0;
    tree.find(
        [&](const BoxTree::Node& node) {
          ++steps;
          return edge.meets(node.box);
        },
        [&](Index item) {
          ++steps;
          const Index v = vertices_[item];
          const double place = edge.placeOf(mesh_.points[v]);
          if (place < 0) return;
          if (!std::binary_search(facesAt_.begin(), facesAt_.end(), std::pair(v, face)))
            found.push_back({e, place, v});
        });
    return steps;
  }

  /// Calls visit(edge, vertices along it) for all boundary edges. The vertices at the ends come
  /// first and last; `first` is the index in found_ of the second one.
  template <class Visit>
  void forEachEdge(Visit&& visit) const {
    std::vector<Index> chain;
    std::size_t k = 0;
    for (std::size_t e = 0; e < corners_.size(); ++e) {
      const std::size_t first = k;
      chain.assign(1, startOf(e));
      for (; k < found_.size() && found_[k].edge == e; ++k) chain.push_back(found_[k].vertex);
      chain.push_back(endOf(e));
      visit(first, chain);
    }
  }

  /// Drops the vertices between two parts of an edge that join no other edge.
  void keepJoining() {
    if (found_.empty()) return;
    std::vector<Edge> parts;
    forEachEdge([&](std::size_t, const std::vector<Index>& chain) {
      for (std::size_t i = 1; i < chain.size(); ++i)
        parts.push_back(edgeBetween(chain[i - 1], chain[i]));
    });
    parallelSort(parts);
    const auto joins = [&](Index v, Index w) {
      const auto [begin, end] = std::equal_range(parts.begin(), parts.end(), edgeBetween(v, w));
      return end - begin > 1;
    };
    std::vector<Found> kept;
    forEachEdge([&](std::size_t first, const std::vector<Index>& chain) {
      for (std::size_t i = 1; i + 1 < chain.size(); ++i)
        if (joins(chain[i - 1], chain[i]) || joins(chain[i], chain[i + 1]))
          kept.push_back(found_[first + i - 1]);
    });
    found_ = std::move(kept);
  }

  const PolygonMesh& mesh_;
  const Adjacency& adjacency_;
  double tolerance_;
  std::vector<Index> corners_;                    // boundary edges
  std::vector<Index> vertices_;                   // boundary vertices
  std::vector<std::pair<Index, Index>> facesAt_;  // (boundary vertex, face), sorted
  std::vector<Found> found_;
};

}  // namespace

std::vector<EdgeVertex> verticesOnEdges(const PolygonMesh& mesh, const Joints& joints,
                                        double tolerance) {
  return TJunctions(mesh, joints, tolerance).find();
}

PolygonMesh withEdgeVertices(const PolygonMesh& mesh, const std::vector<EdgeVertex>& added) {
  if (added.size() >= kNone - mesh.faceVertices.size())
    throw LimitError("stitching would need 2^32 - 1 corners or more");
  PolygonMesh result;
  result.points = mesh.points;
  std::vector<Index> face;
  auto next = added.begin();
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    face.clear();
    for (Index c = mesh.faceOffsets[f]; c < mesh.faceOffsets[f + 1]; ++c) {
      face.push_back(mesh.faceVertices[c]);
      for (; next != added.end() && next->corner == c; ++next) face.push_back(next->vertex);
    }
    result.addFace(face);
  }
  return result;
}

}  // namespace vox
