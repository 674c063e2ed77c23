// Areas of faces.

#include "libvox/mesh/area.h"

#include "libvox/mesh/area_vector.h"

namespace vox {

double areaOf(const PolygonMesh& mesh, Index face) {
  const auto vertices = mesh.face(face);
  return twiceAreaVector(vertices.size(), [&](std::size_t i) { return mesh.points[vertices[i]]; })
             .norm() /
         2;
}

double areaOf(const PolygonMesh& mesh) {
  double area = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) area += areaOf(mesh, f);
  return area;
}

}  // namespace vox
