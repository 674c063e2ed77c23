// CGAL's Doo-Sabin subdivision down to the voxel, then rounding.

#include "apps/bench/peers/peer.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/subdivision_method_3.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using vox::Index;
using vox::PolygonMesh;
using vox::Vec3d;
using Mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;

Mesh toCgal(const PolygonMesh& mesh) {
  Mesh out;
  for (const Vec3d& p : mesh.points) out.add_vertex({p.x(), p.y(), p.z()});
  std::vector<Mesh::Vertex_index> face;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    face.clear();
    for (const Index v : mesh.face(f)) face.emplace_back(v);
    if (out.add_face(face) == Mesh::null_face())
      throw std::runtime_error("face " + std::to_string(f) + " does not fit in a manifold");
  }
  return out;
}

double largestSpan(const Mesh& mesh) {
  double largest = 0;
  std::vector<Vec3d> corners;
  for (const auto f : mesh.faces()) {
    corners.clear();
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) {
      const auto& p = mesh.point(v);
      corners.emplace_back(p.x(), p.y(), p.z());
    }
    largest = std::max(largest, vox::peer::spanOf(corners));
  }
  return largest;
}

void voxelize(const PolygonMesh& meshIndex, double span, openvdb::MaskGrid& mask) {
  Mesh mesh = toCgal(meshIndex);
  do {
    CGAL::Subdivision_method_3::DooSabin_subdivision(mesh,
                                                     CGAL::parameters::number_of_iterations(1));
  } while (largestSpan(mesh) > span);
  auto voxels = mask.getAccessor();
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    voxels.setValueOn(vox::peer::voxelOf(p.x(), p.y(), p.z()));
  }
}

}  // namespace

int main(int argc, char** argv) {
  return vox::peer::run(argc, argv, "vox_peer_cgal",
                        "CGAL's Doo-Sabin, down to the voxel, and rounding.", voxelize);
}
