// Checks of meshes; messages name the elements that are at fault.

#include "libvox/mesh/validate.h"

#include "libvox/core/error.h"
#include "libvox/core/forest.h"
#include "libvox/core/parallel.h"

#include <algorithm>
#include <array>
#include <span>

namespace vox {
namespace {

std::string str(std::size_t n) {
  return std::to_string(n);
}

/// Collects defects. Only the first few of each kind get a message.
class DefectList {
 public:
  explicit DefectList(std::size_t mostPerKind) : mostPerKind_(mostPerKind) {}

  template <class Message>
  void add(DefectKind kind, Index element, Message&& message) {
    const bool spellOut = counts_[static_cast<std::size_t>(kind)]++ < mostPerKind_;
    defects_.push_back({kind, element, spellOut ? message() : std::string()});
  }
  std::vector<Defect> take() { return std::move(defects_); }

 private:
  std::size_t mostPerKind_;
  std::array<std::size_t, 5> counts_{};
  std::vector<Defect> defects_;
};

void findRepeatedCorners(const PolygonMesh& mesh, DefectList& defects) {
  std::vector<Index> sorted;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    sorted.assign(face.begin(), face.end());
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice == sorted.end()) continue;
    defects.add(DefectKind::kRepeatedCorner, f, [&] {
      return "face " + str(f) + " has vertex " + str(*twice) + " at more than one corner";
    });
  }
}

void addEdgeDefect(const Adjacency& adjacency, std::span<const EdgeCorner> edge,
                   DefectList& defects) {
  const auto name = [&] { return "edge (" + str(edge[0].low) + ", " + str(edge[0].high) + ")"; };
  const std::string f = str(adjacency.cornerFace[edge[0].corner]);
  const std::string g = str(adjacency.cornerFace[edge[1].corner]);
  if (edge.size() > 2)
    defects.add(DefectKind::kNonManifoldEdge, edge[0].corner, [&] {
      return name() + " has " + str(edge.size()) + " faces: " + f + ", " + g + ", ...";
    });
  else
    defects.add(DefectKind::kInconsistentWinding, edge[0].corner, [&] {
      return "faces " + f + " and " + g + " run through " + name() + " in the same direction";
    });
}

void findEdgeDefects(std::span<const EdgeCorner> edges, const Adjacency& adjacency,
                     DefectList& defects) {
  forEachEdge(edges, [&](std::span<const EdgeCorner> edge) {
    const bool repeatedCorner = edge[0].low == edge[0].high;  // reported with its face
    const bool separated = adjacency.twin[edge[0].corner] == kNone;
    if (edge.size() > 1 && separated && !repeatedCorner) addEdgeDefect(adjacency, edge, defects);
  });
}

/// Number of fans at each vertex. A fan is a set of corners whose faces are connected through edges
/// of two faces, wound consistently or not.
std::vector<Index> countFans(const PolygonMesh& mesh, std::span<const EdgeCorner> edges,
                             const Adjacency& adjacency) {
  Forest fanOf(mesh.cornerCount());
  const auto cornerAt = [&](Index v, Index edge) {
    return mesh.faceVertices[edge] == v ? edge : nextCorner(mesh, adjacency, edge);
  };
  forEachEdge(edges, [&](std::span<const EdgeCorner> edge) {
    if (edge.size() != 2 || edge[0].low == edge[0].high) return;
    for (const Index v : {edge[0].low, edge[0].high})
      fanOf.unite(cornerAt(v, edge[0].corner), cornerAt(v, edge[1].corner));
  });
  std::vector<Index> fans(mesh.pointCount(), 0);
  for (Index c = 0; c < mesh.cornerCount(); ++c) fans[mesh.faceVertices[c]] += fanOf.find(c) == c;
  return fans;
}

/// Bow ties and unused vertices, from the number of fans at each vertex.
void findVertexDefects(const std::vector<Index>& fans, DefectList& defects) {
  for (Index v = 0; v < fans.size(); ++v)
    if (fans[v] > 1)
      defects.add(DefectKind::kBowTieVertex, v,
                  [&] { return "vertex " + str(v) + " joins " + str(fans[v]) + " fans of faces"; });
  for (Index v = 0; v < fans.size(); ++v)
    if (fans[v] == 0)
      defects.add(DefectKind::kUnusedVertex, v,
                  [&] { return "vertex " + str(v) + " belongs to no face"; });
}

void requireValidOffsets(const PolygonMesh& mesh) {
  if (mesh.faceOffsets.empty() || mesh.faceOffsets.front() != 0 ||
      mesh.faceOffsets.back() != mesh.faceVertices.size())
    throw MeshError("faceOffsets must start at 0 and end at the number of corners");
  const Index bad = lowestWhere(mesh.faceCount(), kElementsPerTask, [&](Index f) {
    const auto begin = mesh.faceOffsets[f];
    const auto end = mesh.faceOffsets[f + 1];
    return end < begin || end - begin < 3;
  });
  if (bad < mesh.faceCount()) throw MeshError("face " + str(bad) + " has fewer than 3 corners");
}

void requireValidSets(const PolygonMesh& mesh, const FaceSets& sets, const char* name) {
  if (!sets.empty() && sets.ofFaces.size() != mesh.faceCount())
    throw MeshError(std::string(name) + " must have one number per face, or none");
  for (Index f = 0; f < sets.ofFaces.size(); ++f)
    if (sets.ofFaces[f] != kNone && sets.ofFaces[f] >= sets.names.size())
      throw MeshError("face " + str(f) + " is in number " + str(sets.ofFaces[f]) + " of " +
                      str(sets.names.size()) + " " + name);
}

void requireValidAttributes(const PolygonMesh& mesh) {
  const MeshAttributes& attributes = mesh.attributes;
  if (!attributes.texcoords.empty() && attributes.texcoords.size() != mesh.cornerCount())
    throw MeshError("texcoords must have one pair per corner, or none");
  requireValidSets(mesh, attributes.objects, "objects");
  requireValidSets(mesh, attributes.groups, "groups");
  requireValidSets(mesh, attributes.materials, "materials");
  if (!attributes.looks.empty() && attributes.looks.size() != attributes.materials.names.size())
    throw MeshError("looks must have one material per name, or none");
}

}  // namespace

std::string defectName(DefectKind kind) {
  switch (kind) {
    case DefectKind::kRepeatedCorner:
      return "face with a repeated corner";
    case DefectKind::kNonManifoldEdge:
      return "non-manifold edge";
    case DefectKind::kInconsistentWinding:
      return "inconsistently wound edge";
    case DefectKind::kBowTieVertex:
      return "bow-tie vertex";
    case DefectKind::kUnusedVertex:
      return "unused vertex";
  }
  return "unknown defect";
}

std::vector<Defect> findDefects(const PolygonMesh& mesh, const Adjacency& adjacency,
                                std::size_t mostPerKind) {
  DefectList defects(mostPerKind);
  findRepeatedCorners(mesh, defects);
  const std::vector<EdgeCorner> edges = cornersByEdge(mesh);
  findEdgeDefects(edges, adjacency, defects);
  findVertexDefects(countFans(mesh, edges, adjacency), defects);
  return defects.take();
}

void requireValidArrays(const PolygonMesh& mesh) {
  requireValidOffsets(mesh);
  const auto namesNone = [&](Index c) { return mesh.faceVertices[c] >= mesh.pointCount(); };
  const Index wrong = lowestWhere(mesh.cornerCount(), kElementsPerTask, namesNone);
  if (wrong < mesh.cornerCount()) {
    const auto after = std::upper_bound(mesh.faceOffsets.begin(), mesh.faceOffsets.end(), wrong);
    throw MeshError("face " + std::to_string(after - mesh.faceOffsets.begin() - 1) +
                    " names vertex " + str(mesh.faceVertices[wrong]) + " of " +
                    str(mesh.pointCount()));
  }
  const auto fits = [](const auto& colors, std::size_t n) {
    return colors.empty() || colors.size() == n;
  };
  if (!fits(mesh.pointColors, mesh.pointCount()) || !fits(mesh.faceColors, mesh.faceCount()))
    throw MeshError("pointColors and faceColors must have one colour per point and face, or none");
  if (!fits(mesh.faceGroups, mesh.faceCount()))
    throw MeshError("faceGroups must have one group per face, or none");
  requireValidAttributes(mesh);
  const Index infinite = lowestWhere(mesh.pointCount(), kElementsPerTask,
                                     [&](Index v) { return !mesh.points[v].allFinite(); });
  if (infinite < mesh.pointCount())
    throw MeshError("vertex " + str(infinite) + " has a coordinate that is not finite");
}

void requireManifold(const PolygonMesh& mesh, const Adjacency& adjacency) {
  const auto defects = findDefects(mesh, adjacency, 1);
  const Defect* first = nullptr;
  std::size_t count = 0;
  for (const Defect& defect : defects) {
    if (defect.kind == DefectKind::kBowTieVertex || defect.kind == DefectKind::kUnusedVertex)
      continue;
    if (first == nullptr) first = &defect;
    ++count;
  }
  if (first == nullptr) return;
  throw MeshError(first->message + (count > 1 ? " (and " + str(count - 1) + " more defects)" : "") +
                  "; repair the mesh so that every edge has one or two faces, wound consistently");
}

}  // namespace vox
