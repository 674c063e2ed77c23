// A breadth-first search over shared edges winds each component consistently; then each component
// is turned as a whole.

#include "libvox/prepare/orient.h"

#include "libvox/core/error.h"
#include "libvox/core/numbered.h"
#include "libvox/prepare/enclosure.h"
#include "libvox/prepare/face_order.h"
#include "libvox/prepare/manifold.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace vox {
namespace {

using Box = Eigen::AlignedBox3d;

constexpr std::uint64_t kMostSearchSteps = 1'000'000'000;

/// Faces that are connected through edges: a range of Components::faces.
struct Component {
  std::size_t begin;
  std::size_t end;
  Index asInput = 0;  // number of faces that are wound as in the input
  bool boundary = false;
  bool oneSided = false;
};

struct Components {
  std::vector<Index> faces;            // component after component, breadth-first from its lowest
  std::vector<std::uint8_t> reversed;  // per face: wound against canonical form
  std::vector<Component> list;         // by lowest face

  std::span<const Index> facesOf(const Component& component) const {
    return std::span(faces).subspan(component.begin, component.end - component.begin);
  }
};

std::span<Index> faceOf(PolygonMesh& mesh, Index f) {
  return {mesh.faceVertices.data() + mesh.faceOffsets[f], mesh.faceSize(f)};
}

void flip(std::span<Index> face) {
  std::reverse(face.begin() + 1, face.end());  // still starts at its lowest vertex
}

/// Finds the components of a mesh in canonical form, and for each face whether it must be reversed
/// to be wound like the first face of its component.
class ComponentSearch {
 public:
  ComponentSearch(const PolygonMesh& mesh, const Adjacency& joints)
      : mesh_(mesh), joints_(joints), reached_(mesh.faceCount(), false) {
    out_.reversed.assign(mesh.faceCount(), 0);
  }

  Components run() {
    for (Index f = 0; f < mesh_.faceCount(); ++f)
      if (!reached_[f]) out_.list.push_back(search(f));
    return std::move(out_);
  }

 private:
  Component search(Index first) {
    Component component{out_.faces.size(), out_.faces.size()};
    reach(first, 0);
    for (; component.end < out_.faces.size(); ++component.end)
      visit(out_.faces[component.end], component);
    return component;
  }

  void reach(Index f, std::uint8_t reversed) {
    reached_[f] = true;
    out_.reversed[f] = reversed;
    out_.faces.push_back(f);
  }

  void visit(Index f, Component& component) {
    for (Index c = mesh_.faceOffsets[f]; c < mesh_.faceOffsets[f + 1]; ++c) {
      const Index t = joints_.twin[c];
      if (t == kNone) {
        component.boundary = true;
        continue;
      }
      const bool sameDirection = mesh_.faceVertices[c] == mesh_.faceVertices[t];
      const auto reversed = static_cast<std::uint8_t>(out_.reversed[f] ^ sameDirection);
      const Index g = joints_.cornerFace[t];
      if (!reached_[g])
        reach(g, reversed);
      else if (out_.reversed[g] != reversed)
        component.oneSided = true;
    }
  }

  const PolygonMesh& mesh_;
  const Adjacency& joints_;
  std::vector<bool> reached_;
  Components out_;
};

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
/// it is wound like its first face in canonical form.
bool turnToMajority(const Component& component, bool firstAsInput) {
  const std::size_t size = component.end - component.begin;
  const std::size_t asInput = component.asInput;
  return 2 * asInput == size ? !firstAsInput : 2 * asInput < size;
}

/// Whether a component must be turned, by all rules of orient.h. Counts cavities.
bool mustTurn(const PolygonMesh& mesh, const Components& components, const Component& component,
              bool firstAsInput, CavitySearch& cavities, OrientReport& report) {
  const bool majority = turnToMajority(component, firstAsInput);
  if (component.boundary || component.oneSided) return majority;
  const int sign = signedVolume(mesh, components.facesOf(component)).sign();
  if (sign == 0) return majority;
  const bool outward = sign < 0;
  const std::size_t size = component.end - component.begin;
  const bool consistent = component.asInput == 0 || component.asInput == size;
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

/// Decides for each component whether it is turned, and winds all faces accordingly.
void turnComponents(PolygonMesh& mesh, Components& components,
                    const std::vector<std::uint8_t>& inputReversed, OrientReport& report) {
  for (Index f = 0; f < mesh.faceCount(); ++f)
    if (components.reversed[f]) flip(faceOf(mesh, f));
  for (Component& component : components.list)
    for (const Index f : components.facesOf(component))
      component.asInput += components.reversed[f] == inputReversed[f];

  std::vector<std::uint8_t> turn;  // decided before any turn: cavities depend on other components
  CavitySearch cavities(mesh, components);
  for (const Component& component : components.list) {
    const Index first = components.faces[component.begin];
    turn.push_back(mustTurn(mesh, components, component, !inputReversed[first], cavities, report));
  }
  for (std::size_t k = 0; k < turn.size(); ++k)
    for (const Index f : components.facesOf(components.list[k])) {
      if (turn[k]) flip(faceOf(mesh, f));
      if ((components.reversed[f] ^ turn[k]) == inputReversed[f]) continue;
      ++report.flippedFaces;
      report.firstFlipped = std::min(report.firstFlipped, f);
    }
}

/// Adds the second side of one-sided components: every face once more, reversed.
class DoubleCover {
 public:
  DoubleCover(PolygonMesh& mesh, const Components& components, OrientReport& report)
      : mesh_(mesh), report_(report), mirrorFace_(mesh.faceCount(), kNone) {
    for (const Component& component : components.list) {
      if (!component.oneSided) continue;
      for (const Index f : components.facesOf(component)) covered_.push_back(f);
    }
    std::sort(covered_.begin(), covered_.end());
  }

  void add() {
    if (covered_.empty()) return;
    requireRoom();
    Adjacency joints = joinFaces(mesh_, CrowdedEdge::kSeparate).adjacency;
    addMirrorFaces(joints);
    for (const Index f : covered_)
      for (Index c = mesh_.faceOffsets[f]; c < mesh_.faceOffsets[f + 1]; ++c) joinCopies(c, joints);
    for (const Index v : splitFans(mesh_, joints)) report_.pointOrigin.push_back(v);
  }

 private:
  void requireRoom() const {
    std::uint64_t corners = mesh_.faceVertices.size();
    for (const Index f : covered_) corners += mesh_.faceSize(f);
    if (corners >= kNone)
      throw LimitError(
          "the double cover of a one-sided surface would have 2^32 - 1 corners or more");
  }

  void addMirrorFaces(Adjacency& joints) {
    for (const Index f : covered_) {
      mirrorFace_[f] = mesh_.faceCount();
      const auto face = mesh_.face(f);
      std::vector<Index> mirrored(face.begin(), face.end());
      flip(mirrored);
      joints.twin.resize(joints.twin.size() + mirrored.size(), kNone);
      joints.cornerFace.resize(joints.twin.size(), mirrorFace_[f]);
      mesh_.addFace(mirrored);
      report_.faceOrigin.push_back(f);
    }
  }

  /// The corner of the mirrored face on the edge of corner c.
  Index mirrorOf(Index c, const Adjacency& joints) const {
    const Index f = joints.cornerFace[c];
    return mesh_.faceOffsets[mirrorFace_[f] + 1] - 1 - (c - mesh_.faceOffsets[f]);
  }

  /// Joins edge c and its mirror image to the neighbour's edge and its mirror image; crosswise if
  /// the neighbour is wound against the face of c. Writes the twins of c and its image only.
  void joinCopies(Index c, Adjacency& joints) const {
    const Index t = joints.twin[c];
    if (t == kNone) return;
    const bool crosswise = mesh_.faceVertices[c] == mesh_.faceVertices[t];
    const Index tMirror = mirrorOf(t, joints);
    const Index cMirror = mirrorOf(c, joints);
    joints.twin[c] = crosswise ? tMirror : t;
    joints.twin[cMirror] = crosswise ? t : tMirror;
  }

  PolygonMesh& mesh_;
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

PolygonMesh orient(PolygonMesh mesh, OrientReport& report) {
  report = OrientReport{};
  report.secondSide = mesh.faceCount();
  report.pointOrigin = numbered(mesh.pointCount());
  report.faceOrigin = numbered(mesh.faceCount());

  const auto inputReversed = canonicalizeFaces(mesh);
  const Adjacency joints = joinFaces(mesh, CrowdedEdge::kSeparate).adjacency;
  Components components = ComponentSearch(mesh, joints).run();
  countComponents(components, report);
  turnComponents(mesh, components, inputReversed, report);
  DoubleCover(mesh, components, report).add();
  for (Index f = 0; f < mesh.faceCount(); ++f) startAtLowest(faceOf(mesh, f));
  return mesh;
}

}  // namespace vox
