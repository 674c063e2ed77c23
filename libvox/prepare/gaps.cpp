// Distances between boundary vertices and boundary edges, by a tree of boxes. A part of the tree
// that lies on the vertex's own loop, and not far along it, is left out as a whole.

#include "libvox/prepare/gaps.h"

#include "libvox/mesh/adjacency.h"
#include "libvox/prepare/box_tree.h"
#include "libvox/prepare/sound.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

namespace vox {
namespace {

/// An edge of a boundary loop.
struct LoopEdge {
  Vec3d from, to;
  Index loop;
  double place;  ///< of `from` along the loop
};

/// A stretch of a loop; `loop` is kNone if it holds edges of several loops.
struct Stretch {
  Index loop = kNone;
  double begin = 0;
  double end = 0;
};

class GapSearch {
 public:
  explicit GapSearch(const PolygonMesh& mesh) {
    const Adjacency adjacency = buildAdjacency(mesh);
    for (const std::vector<Index>& loop : boundaryLoops(mesh, adjacency)) addLoop(mesh, loop);
    std::vector<Eigen::AlignedBox3d> boxes(edges_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e)
      boxes[e].extend(edges_[e].from).extend(edges_[e].to);
    tree_ = BoxTree(boxes);
    findStretches();
  }

  std::size_t loopCount() const { return lengths_.size(); }

  /// The width of each loop; the second is true for seams.
  std::vector<std::pair<Gap, bool>> gaps() const {
    std::vector<std::pair<Gap, bool>> result(loopCount());
    std::vector<Eigen::AlignedBox3d> boxes(loopCount());
    std::uint64_t steps = 0;
    for (const LoopEdge& edge : edges_) {
      boxes[edge.loop].extend(edge.from);
      constexpr std::uint64_t kMostSteps = 200'000'000;
      if (steps > kMostSteps) continue;
      const double width = distanceOf(edge, steps);
      auto& [gap, isSeam] = result[edge.loop];
      if (!std::isfinite(width) || width < gap.width) continue;
      gap = {width, edge.from};
      isSeam = true;
    }
    for (std::size_t l = 0; l < result.size(); ++l) {
      auto& [gap, isSeam] = result[l];
      Vec3d sides = boxes[l].sizes();
      std::sort(sides.begin(), sides.end());
      if (isSeam && gap.width < sides[1]) continue;
      isSeam = false;
      gap = {sides[1], boxes[l].center()};
    }
    return result;
  }

 private:
  void addLoop(const PolygonMesh& mesh, const std::vector<Index>& loop) {
    const auto number = static_cast<Index>(lengths_.size());
    double place = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec3d& from = mesh.points[mesh.faceVertices[loop[i]]];
      const Vec3d& to = mesh.points[mesh.faceVertices[loop[(i + 1) % loop.size()]]];
      edges_.push_back({from, to, number, place});
      place += (to - from).norm();
    }
    lengths_.push_back(place);
  }

  void findStretches() {
    const auto& nodes = tree_.nodes();
    stretches_.resize(nodes.size());
    for (std::size_t n = nodes.size(); n-- > 0;) {
      if (nodes[n].second != 0) {
        stretches_[n] = joined(stretches_[n + 1], stretches_[nodes[n].second]);
        continue;
      }
      for (std::size_t k = nodes[n].begin; k < nodes[n].end; ++k) {
        const LoopEdge& edge = edges_[tree_.items()[k]];
        const Stretch own{edge.loop, edge.place, edge.place + (edge.to - edge.from).norm()};
        stretches_[n] = k == nodes[n].begin ? own : joined(stretches_[n], own);
      }
    }
  }

  static Stretch joined(const Stretch& a, const Stretch& b) {
    if (a.loop != b.loop) return {};
    return {a.loop, std::min(a.begin, b.begin), std::max(a.end, b.end)};
  }

  /// Way along the loop between two of its places.
  double way(Index loop, double a, double b) const {
    const double forward = std::abs(a - b);
    return std::min(forward, lengths_[loop] - forward);
  }

  /// Whether a point of the own loop is only a little farther along the loop than straight.
  static bool isNearAlong(double way, double distance) {
    constexpr double kMostWay = 2;
    return way <= kMostWay * distance * (1 + 1e-9);
  }

  /// Distance from the first vertex of an edge to the nearest edge that is not its own part of the
  /// loop.
  double distanceOf(const LoopEdge& vertex, std::uint64_t& steps) const {
    const Vec3d& p = vertex.from;
    double nearest = std::numeric_limits<double>::infinity();
    const auto mayBeNear = [&](const BoxTree::Node& node) {
      ++steps;
      const double distance = std::sqrt(node.box.squaredExteriorDistance(p));
      if (distance >= nearest) return false;
      const Stretch& stretch = stretches_[static_cast<std::size_t>(&node - &tree_.nodes()[0])];
      if (stretch.loop != vertex.loop) return true;
      const double length = lengths_[stretch.loop];
      // The farthest place of the stretch: one of its ends, unless it goes past the opposite place.
      double farthest = std::max(way(stretch.loop, vertex.place, stretch.begin),
                                 way(stretch.loop, vertex.place, stretch.end));
      for (const double opposite : {vertex.place - length / 2, vertex.place + length / 2})
        if (stretch.begin <= opposite && opposite <= stretch.end) farthest = length / 2;
      return !isNearAlong(farthest, distance);
    };
    tree_.find(mayBeNear, [&](Index e) {
      ++steps;
      const LoopEdge& edge = edges_[e];
      const Vec3d along = edge.to - edge.from;
      const double t = std::clamp((p - edge.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      if (!(t >= 0)) return;
      const double distance = (p - edge.from - t * along).norm();
      if (distance >= nearest) return;
      if (edge.loop == vertex.loop &&
          isNearAlong(way(edge.loop, vertex.place, edge.place + t * along.norm()), distance))
        return;
      nearest = distance;
    });
    return nearest;
  }

  std::vector<LoopEdge> edges_;
  std::vector<double> lengths_;  // of the loops
  BoxTree tree_{std::vector<Eigen::AlignedBox3d>()};
  std::vector<Stretch> stretches_;  // of the nodes
};

/// The number with two digits that is larger by 1 % to 11 %.
double roundedUp(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 1);
  return std::ceil(1.01 * x / unit) * unit;
}

struct Attempt {
  std::size_t loops;
  Index faces;
};

Attempt attempt(const PolygonMesh& mesh, RepairOptions options, double tolerance) {
  options.weldTolerance = tolerance;
  SoundReport report;
  const PolygonMesh sound = soundMesh(mesh, options, report);
  return {boundaryLoops(sound, report.orient.adjacency).size(), sound.faceCount()};
}

/// Tries the widths of some seams, widest first.
void findWeld(const PolygonMesh& mesh, const RepairOptions& options, std::vector<double> widths,
              Index faces, GapReport& report) {
  std::sort(widths.begin(), widths.end(), std::greater<>());
  constexpr std::size_t kMostAttempts = 4;
  for (std::size_t i = 0; i < kMostAttempts && !widths.empty(); ++i) {
    // A width is zero where vertices at one place were cut apart: no tolerance joins them.
    const double width = widths[i * (widths.size() - 1) / (kMostAttempts - 1)];
    if (!(width > 0)) return;
    char text[32];
    const auto end =
        std::to_chars(text, text + sizeof text, roundedUp(width), std::chars_format::general, 3);
    double tolerance = 0;
    std::from_chars(text, end.ptr, tolerance);
    if (tolerance <= options.weldTolerance) return;
    const Attempt result = attempt(mesh, options, tolerance);
    if (result.loops >= report.count || result.faces < faces - faces / 10) continue;
    report.weld = tolerance;
    report.closes = report.count - result.loops;
    return;
  }
}

}  // namespace

GapReport measureGaps(const PolygonMesh& mesh, const RepairOptions& options) {
  SoundReport unused;
  const PolygonMesh sound = soundMesh(mesh, options, unused);
  const GapSearch search(sound);
  GapReport report;
  report.count = search.loopCount();
  if (report.count == 0) return report;
  report.narrowest.width = std::numeric_limits<double>::infinity();
  std::vector<double> seams;
  for (const auto& [gap, isSeam] : search.gaps()) {
    if (isSeam) seams.push_back(gap.width);
    if (gap.width >= report.widest.width) report.widest = gap;
    if (gap.width < report.narrowest.width) report.narrowest = gap;
  }
  findWeld(mesh, options, std::move(seams), sound.faceCount(), report);
  return report;
}

std::string summary(const GapReport& report) {
  if (report.count == 0) return {};
  std::string text =
      report.count == 1 ? "1 gap, " : std::to_string(report.count) + " gaps, the widest ";
  text += exactNumber(report.widest.width) + " wide at " + exactPoint(report.widest.at);
  if (report.count > 1)
    text += ", the narrowest " + exactNumber(report.narrowest.width) + " at " +
            exactPoint(report.narrowest.at);
  if (!report.weld) return text;
  text += "; --weld " + exactNumber(*report.weld) + " closes ";
  if (report.closes < report.count) return text + std::to_string(report.closes) + " of them";
  return text + (report.count == 1 ? "it" : "them");
}

std::string exactNumber(double x) {
  const double rounded = static_cast<double>(static_cast<float>(x));
  constexpr int kDigits = 6;
  char text[32];
  const auto end =
      std::to_chars(text, text + sizeof text, x, std::chars_format::general, kDigits).ptr;
  double read = 0;
  std::from_chars(text, end, read);
  if (static_cast<double>(static_cast<float>(read)) == rounded || !std::isfinite(rounded))
    return {text, end};
  return {text, std::to_chars(text, text + sizeof text, static_cast<float>(x)).ptr};
}

std::string exactPoint(const Vec3d& p) {
  return "(" + exactNumber(p.x()) + ", " + exactNumber(p.y()) + ", " + exactNumber(p.z()) + ")";
}

}  // namespace vox
