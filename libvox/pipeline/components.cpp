// Sets of connected faces.

#include "libvox/pipeline/components.h"

#include "libvox/mesh/winding_forest.h"
#include "libvox/prepare/enclosure.h"

namespace vox {
namespace {

MeshComponent::Side sideOf(const PolygonMesh& mesh, const MeshComponent& component) {
  if (component.boundaryCorner != kNone) return MeshComponent::Side::kNoInside;
  const int sign = signedVolume(mesh, component.faces).sign();
  if (sign == 0) return MeshComponent::Side::kNoInside;
  return sign > 0 ? MeshComponent::Side::kOut : MeshComponent::Side::kIn;
}

}  // namespace

std::vector<MeshComponent> componentsOf(const SubdivisionLevel& base) {
  const auto& [twin, cornerFace] = base.adjacency;
  WindingForest forest(base.mesh.faceCount());
  for (Index c = 0; c < base.mesh.cornerCount(); ++c) {
    if (twin[c] != kNone) forest.unite(cornerFace[c], cornerFace[twin[c]], false);
    if (!base.seam.empty() && base.seam[c] != kNone)
      forest.unite(cornerFace[c], cornerFace[base.seam[c]], false);
  }

  std::vector<MeshComponent> components;
  std::vector<Index> number(base.mesh.faceCount(),
                            kNone);  // index of the component, at the root of its faces
  for (Index f = 0; f < base.mesh.faceCount(); ++f) {
    Index& n = number[forest.find(f).root];
    if (n == kNone) {
      n = static_cast<Index>(components.size());
      components.emplace_back();
    }
    MeshComponent& component = components[n];
    component.faces.push_back(f);
    for (Index c = base.mesh.faceOffsets[f]; c < base.mesh.faceOffsets[f + 1]; ++c)
      if (base.isOpen(c) && component.boundaryCorner == kNone) component.boundaryCorner = c;
  }
  for (MeshComponent& component : components) component.side = sideOf(base.mesh, component);
  return components;
}

PolygonMesh submeshOf(const PolygonMesh& mesh, const std::vector<Index>& faces) {
  PolygonMesh part;
  std::vector<Index> renamed(mesh.pointCount(), kNone);
  std::vector<Index> face;
  for (const Index f : faces) {
    face.clear();
    for (const Index v : mesh.face(f)) {
      if (renamed[v] == kNone) {
        renamed[v] = part.pointCount();
        part.points.push_back(mesh.points[v]);
      }
      face.push_back(renamed[v]);
    }
    part.addFace(face);
  }
  return part;
}

}  // namespace vox
