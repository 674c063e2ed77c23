// Sets of the sides of faces tell how each component is wound consistently; then each component is
// turned as a whole.

#include "libvox/prepare/orient.h"

#include "libvox/core/error.h"
#include "libvox/core/forest.h"
#include "libvox/core/numbered.h"
#include "libvox/core/parallel.h"
#include "libvox/prepare/enclosure.h"
#include "libvox/prepare/face_order.h"
#include "libvox/prepare/manifold.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <utility>

namespace vox {
namespace {

using Box = Eigen::AlignedBox3d;

constexpr std::uint64_t kMostSearchSteps = 1'000'000'000;

/// Faces that are connected through edges: a range of Components::faces.
struct Component {
  std::size_t begin = 0;
  std::size_t end = 0;
  Index against = 0;  ///< number of faces that are wound against the lowest one in the input
  bool boundary = false;
  bool oneSided = false;
};

struct Components {
  std::vector<Index> faces;  ///< component after component, each in ascending order
  /// Per face: wound against the lowest of its component. Empty: none is.
  std::vector<std::uint8_t> reversed;
  std::vector<Component> list;  ///< by lowest face

  std::span<const Index> facesOf(const Component& component) const {
    return std::span(faces).subspan(component.begin, component.end - component.begin);
  }
};

std::span<Index> faceOf(PolygonMesh& mesh, Index f) {
  return {mesh.faceVertices.data() + mesh.faceOffsets[f], mesh.faceSize(f)};
}

/// Reverses a face, which still starts at its lowest vertex.
void flip(std::span<Index> face) {
  std::reverse(face.begin() + 1, face.end());
}

/// Whether the faces at the edge of corner c are wound against each other.
bool isAgainst(const PolygonMesh& mesh, const Adjacency& joints, Index c) {
  return mesh.faceVertices[c] == mesh.faceVertices[joints.twin[c]];
}

/// The two sides of each face in sets: side 2 f is face f as it is wound, side 2 f + 1 is its
/// reverse. Sides that continue each other across an edge are in one set. So the root of the sets
/// of face f is 2 g or 2 g + 1, where g is the lowest face of the component; it is odd if f is
/// wound against g. On a one-sided component both sides are in one set.
Forest sidesOf(const PolygonMesh& mesh, const Adjacency& joints) {
  Forest sides(std::size_t{2} * mesh.faceCount());
  parallelForEach(mesh.cornerCount(), kElementsPerTask, [&](Index c) {
    const Index t = joints.twin[c];
    if (t == kNone || t < c) return;
    const Index f = 2 * joints.cornerFace[c];
    const Index g = 2 * joints.cornerFace[t];
    const Index against = isAgainst(mesh, joints, c) ? 1 : 0;
    sides.unite(f, g + against);
    sides.unite(f + 1, g + (1 - against));
  });
  return sides;
}

/// The connected faces in sets.
Forest connectedFaces(const PolygonMesh& mesh, const Adjacency& joints) {
  Forest faces(mesh.faceCount());
  parallelForEach(mesh.cornerCount(), kElementsPerTask, [&](Index c) {
    const Index t = joints.twin[c];
    if (t != kNone && c < t) faces.unite(joints.cornerFace[c], joints.cornerFace[t]);
  });
  return faces;
}

bool areWoundConsistently(const PolygonMesh& mesh, const Adjacency& joints) {
  const auto isWrong = [&](Index c) {
    return joints.twin[c] != kNone && isAgainst(mesh, joints, c);
  };
  return lowestWhere(mesh.cornerCount(), kElementsPerTask, isWrong) == mesh.cornerCount();
}

/// The faces, component after component.
/// @param numbers  for each face, its component
/// @param list     gets the places of the faces of each component
std::vector<Index> sortedByComponent(std::vector<Index> numbers, std::vector<Component>& list) {
  if (list.size() == 1) {
    list[0].end = numbers.size();
    parallelForEach(static_cast<Index>(numbers.size()), kElementsPerTask,
                    [&](Index f) { numbers[f] = f; });
    return numbers;
  }
  std::vector<std::size_t> place(list.size() + 1, 0);
  for (const Index n : numbers) ++place[n + 1];
  std::partial_sum(place.begin(), place.end(), place.begin());
  for (std::size_t n = 0; n < list.size(); ++n) {
    list[n].begin = place[n];
    list[n].end = place[n + 1];
  }
  std::vector<Index> faces(numbers.size());
  for (Index f = 0; f < faces.size(); ++f) faces[place[numbers[f]]++] = f;
  return faces;
}

/// Renumbers components by their lowest faces.
/// @param number  for each face, the lowest face of its component; then the number of the component
/// @return        number of components
Index numberComponents(std::vector<Index>& number) {
  const auto faces = static_cast<Index>(number.size());
  const auto isElsewhere = [&](Index f) { return number[f] != 0; };
  if (faces > 0 && lowestWhere(faces, kElementsPerTask, isElsewhere) == faces) return 1;
  Index count = 0;
  for (Index f = 0; f < faces; ++f) number[f] = number[f] == f ? count++ : number[number[f]];
  return count;
}

/// Marks the component of each face with test(face).
template <class Test>
void markComponents(const std::vector<Index>& number, std::vector<Component>& list,
                    bool Component::*mark, Test&& test) {
  parallelForEach(static_cast<Index>(number.size()), kElementsPerTask, [&](Index f) {
    if (!test(f)) return;
    std::atomic_ref<bool> marked(list[number[f]].*mark);
    if (!marked.load(std::memory_order_relaxed)) marked.store(true, std::memory_order_relaxed);
  });
}

Components findComponents(const PolygonMesh& mesh, const Adjacency& joints) {
  const Index faces = mesh.faceCount();
  Components out;
  std::vector<Index> number;
  std::vector<std::uint8_t> isOneSided;
  if (areWoundConsistently(mesh, joints)) {
    number = connectedFaces(mesh, joints).takeRoots();
  } else {
    Forest sides = sidesOf(mesh, joints);
    number.resize(faces);
    out.reversed.resize(faces);
    isOneSided.resize(faces);
    parallelForEach(faces, kElementsPerTask, [&](Index f) {
      const Index root = sides.find(2 * f);
      out.reversed[f] = root & 1U;
      number[f] = root / 2;
      isOneSided[f] = sides.find(2 * f + 1) == root;
    });
  }
  out.list.resize(numberComponents(number));
  markComponents(number, out.list, &Component::boundary, [&](Index f) {
    const auto begin = joints.twin.begin() + mesh.faceOffsets[f];
    const auto end = joints.twin.begin() + mesh.faceOffsets[f + 1];
    return std::find(begin, end, kNone) != end;
  });
  for (Index f = 0; f < isOneSided.size(); ++f) {
    Component& component = out.list[number[f]];
    component.against += out.reversed[f];
    component.oneSided |= isOneSided[f] != 0;
  }
  out.faces = sortedByComponent(std::move(number), out.list);
  return out;
}

/// Finds out whether a component lies inside another, closed one.
class CavitySearch {
 public:
  CavitySearch(const PolygonMesh& mesh, const Components& components)
      : mesh_(mesh), components_(components) {}

  bool isInsideAnother(const Component& inner) {
    if (boxes_.empty()) measureBoxes();
    const Box& box = boxes_[indexOf(inner)];
    const Vec3d& point = mesh_.points[mesh_.face(components_.faces[inner.begin])[0]];
    for (const Component& outer : components_.list) {
      if (++steps_ > kMostSearchSteps) return false;
      if (&outer == &inner || outer.boundary || outer.oneSided) continue;
      if (!boxes_[indexOf(outer)].contains(box)) continue;
      const auto faces = components_.facesOf(outer);
      for (const Index f : faces) steps_ += mesh_.faceSize(f);
      if (encloses(mesh_, faces, point)) return true;
    }
    return false;
  }

 private:
  std::size_t indexOf(const Component& component) const {
    return static_cast<std::size_t>(&component - components_.list.data());
  }

  void measureBoxes() {
    for (const Component& component : components_.list) {
      Box& box = boxes_.emplace_back();
      for (const Index f : components_.facesOf(component))
        for (const Index v : mesh_.face(f)) box.extend(mesh_.points[v]);
    }
  }

  const PolygonMesh& mesh_;
  const Components& components_;
  std::vector<Box> boxes_;
  std::uint64_t steps_ = 0;
};

/// Whether a component must be turned so that most of its faces are wound as in the input. So far
/// it is wound like its lowest face, which decides a tie.
bool turnToMajority(const Component& component) {
  return std::size_t{2} * component.against > component.end - component.begin;
}

/// Whether a component must be turned, by all rules of orient.h. Counts cavities.
bool mustTurn(const PolygonMesh& mesh, const Components& components, const Component& component,
              CavitySearch& cavities, OrientReport& report) {
  const bool majority = turnToMajority(component);
  if (component.boundary || component.oneSided) return majority;
  const int sign = signedVolume(mesh, components.facesOf(component)).sign();
  if (sign == 0) return majority;
  const bool outward = sign < 0;
  const bool consistent = component.against == 0;
  if (outward == majority || !consistent || !cavities.isInsideAnother(component)) return outward;
  ++report.cavities;
  return majority;
}

void countComponents(const Components& components, OrientReport& report) {
  report.components = static_cast<Index>(components.list.size());
  for (const Component& component : components.list)
    if (component.oneSided)
      report.oneSided.push_back(components.faces[component.begin]);
    else
      ++(component.boundary ? report.openComponents : report.closedComponents);
}

/// Flips faces, and moves the joints to the new corners of their edges.
/// @param isFlipped  per face; empty: none is
void flipFaces(PolygonMesh& mesh, Adjacency& joints, const std::vector<std::uint8_t>& isFlipped) {
  if (std::find(isFlipped.begin(), isFlipped.end(), 1) == isFlipped.end()) return;
  // In reverse, the corner before an edge is the one that was behind it.
  const auto moved = [&](Index c) {
    const Index f = joints.cornerFace[c];
    if (!isFlipped[f]) return c;
    const Index first = mesh.faceOffsets[f];
    const Index last = mesh.faceOffsets[f + 1] - 1;
    return first + (last - c);
  };
  std::vector<Index> twin(joints.twin.size());
  parallelForEach(mesh.cornerCount(), kElementsPerTask, [&](Index c) {
    const Index t = joints.twin[c];
    twin[moved(c)] = t == kNone ? kNone : moved(t);
  });
  joints.twin = std::move(twin);
  parallelForEach(mesh.faceCount(), kElementsPerTask, [&](Index f) {
    if (isFlipped[f]) flip(faceOf(mesh, f));
  });
}

/// Winds all faces of each component like its lowest one, then turns components as a whole.
void turnComponents(PolygonMesh& mesh, Adjacency& joints, const Components& components,
                    OrientReport& report) {
  flipFaces(mesh, joints, components.reversed);
  std::vector<std::uint8_t> turn;  // decided before any turn: cavities depend on other components
  CavitySearch cavities(mesh, components);
  for (const Component& component : components.list)
    turn.push_back(mustTurn(mesh, components, component, cavities, report));
  const bool noneTurns = std::find(turn.begin(), turn.end(), 1) == turn.end();
  if (noneTurns && components.reversed.empty()) return;
  std::vector<std::uint8_t> flipped(mesh.faceCount(), 0);
  for (std::size_t k = 0; k < turn.size(); ++k)
    if (turn[k])
      for (const Index f : components.facesOf(components.list[k])) flipped[f] = 1;
  flipFaces(mesh, joints, flipped);
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const bool wasReversed = !components.reversed.empty() && components.reversed[f];
    if (wasReversed == (flipped[f] != 0)) continue;
    ++report.flippedFaces;
    report.firstFlipped = std::min(report.firstFlipped, f);
  }
}

/// Adds the second side of one-sided components: every face once more, reversed.
class DoubleCover {
 public:
  DoubleCover(PolygonMesh& mesh, Adjacency& joints, const Components& components,
              OrientReport& report)
      : mesh_(mesh), joints_(joints), report_(report) {
    for (const Component& component : components.list) {
      if (!component.oneSided) continue;
      for (const Index f : components.facesOf(component)) covered_.push_back(f);
    }
    std::sort(covered_.begin(), covered_.end());
  }

  void add() {
    if (covered_.empty()) return;
    requireRoom();
    addMirrorFaces();
    for (const Index f : covered_)
      for (Index c = mesh_.faceOffsets[f]; c < mesh_.faceOffsets[f + 1]; ++c) joinCopies(c);
    for (const Index v : splitFans(mesh_, joints_)) report_.pointOrigin.add(v);
    startFacesAtLowest(mesh_);
    joints_ = buildAdjacency(mesh_);
  }

 private:
  void requireRoom() const {
    std::uint64_t corners = mesh_.faceVertices.size();
    for (const Index f : covered_) corners += mesh_.faceSize(f);
    if (corners >= kNone)
      throw LimitError(
          "the double cover of a one-sided surface would have 2^32 - 1 corners or more");
  }

  void addMirrorFaces() {
    mirrorFace_.assign(mesh_.faceCount(), kNone);
    for (const Index f : covered_) {
      mirrorFace_[f] = mesh_.faceCount();
      const auto face = mesh_.face(f);
      std::vector<Index> mirrored(face.begin(), face.end());
      flip(mirrored);
      joints_.twin.resize(joints_.twin.size() + mirrored.size(), kNone);
      mesh_.addFace(mirrored);
      report_.faceOrigin.add(f);
    }
    joints_.cornerFace = CornerFaces(mesh_);
  }

  /// The corner of the mirrored face on the edge of corner c.
  Index mirrorOf(Index c) const {
    const Index f = joints_.cornerFace[c];
    return mesh_.faceOffsets[mirrorFace_[f] + 1] - 1 - (c - mesh_.faceOffsets[f]);
  }

  /// Joins edge c and its mirror image to the neighbour's edge and its mirror image; crosswise if
  /// the neighbour is wound against the face of c. Writes the twins of c and its image only.
  void joinCopies(Index c) {
    const Index t = joints_.twin[c];
    if (t == kNone) return;
    const bool crosswise = isAgainst(mesh_, joints_, c);
    const Index tMirror = mirrorOf(t);
    const Index cMirror = mirrorOf(c);
    joints_.twin[c] = crosswise ? tMirror : t;
    joints_.twin[cMirror] = crosswise ? t : tMirror;
  }

  PolygonMesh& mesh_;
  Adjacency& joints_;
  OrientReport& report_;
  std::vector<Index> covered_;
  std::vector<Index> mirrorFace_;
};

std::string counted(Index count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace

std::string summary(const OrientReport& report) {
  std::string line;
  if (report.flippedFaces > 0) line = "flipped " + counted(report.flippedFaces, "face");
  if (report.oneSided.empty()) return line;
  if (!line.empty()) line += ", ";
  return line + "doubled " +
         counted(static_cast<Index>(report.oneSided.size()), "one-sided component") + " (face " +
         std::to_string(report.oneSided[0]) + ")";
}

PolygonMesh orient(PolygonMesh mesh, Adjacency joints, OrientReport& report) {
  report = OrientReport{};
  report.secondSide = mesh.faceCount();
  report.pointOrigin = Origins(mesh.pointCount());
  report.faceOrigin = Origins(mesh.faceCount());
  const Components components = findComponents(mesh, joints);
  countComponents(components, report);
  turnComponents(mesh, joints, components, report);
  DoubleCover(mesh, joints, components, report).add();
  report.adjacency = std::move(joints);
  return mesh;
}

PolygonMesh orient(PolygonMesh mesh, OrientReport& report) {
  startFacesAtLowest(mesh);
  Adjacency joints = joinFaces(mesh, CrowdedEdge::kSeparate).adjacency;
  return orient(std::move(mesh), std::move(joints), report);
}

}  // namespace vox
