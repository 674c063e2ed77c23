// CGAL's Doo-Sabin subdivision down to the voxel, then rounding, or OpenVDB's meshToVolume.

#include "apps/bench/peers/peer.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/subdivision_method_3.h>
#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>
#include <memory>
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

Mesh refined(const PolygonMesh& meshIndex, double span) {
  Mesh mesh = toCgal(meshIndex);
  do {
    CGAL::Subdivision_method_3::DooSabin_subdivision(mesh,
                                                     CGAL::parameters::number_of_iterations(1));
  } while (largestSpan(mesh) > span);
  return mesh;
}

openvdb::GridBase::Ptr rounded(const Mesh& mesh) {
  const auto mask = vox::peer::newMask();
  auto voxels = mask->getAccessor();
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    voxels.setValueOn(vox::peer::voxelOf(p.x(), p.y(), p.z()));
  }
  return mask;
}

/// Distances by meshToVolume.
/// @param flags  those of meshToVolume
openvdb::GridBase::Ptr distances(Mesh& mesh, float band, int flags) {
  mesh.collect_garbage();  // else replaced elements would keep their numbers
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> polygons;
  points.reserve(mesh.number_of_vertices());
  polygons.reserve(mesh.number_of_faces());
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    points.emplace_back(p.x(), p.y(), p.z());
  }
  std::vector<std::uint32_t> face;
  for (const auto f : mesh.faces()) {
    face.clear();
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) face.push_back(v);
    if (face.size() == 4)
      polygons.emplace_back(face[0], face[1], face[2], face[3]);
    else
      for (std::size_t i = 2; i < face.size(); ++i)
        polygons.emplace_back(face[0], face[i - 1], face[i], openvdb::util::INVALID_IDX);
  }
  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec4I> adapter(
      points, polygons);
  const auto transform = openvdb::math::Transform::createLinearTransform(1);
  auto grid =
      openvdb::tools::meshToVolume<openvdb::FloatGrid>(adapter, *transform, band, band, flags);
  grid->setName("surface");
  return grid;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("CGAL's Doo-Sabin, down to the voxel, and rounding or distances.", "vox_peer_cgal");
  std::string kind = "mask";
  app.add_option("--as", kind, "What to make of it")
      ->check(CLI::IsMember({"mask", "level-set", "unsigned"}))
      ->capture_default_str();
  return vox::peer::run(argc, argv, app, [&](const PolygonMesh& meshIndex, double span) {
    Mesh mesh = refined(meshIndex, span);
    if (kind == "mask") return rounded(mesh);
    if (kind == "level-set") return distances(mesh, 3, 0);
    return distances(mesh, 1, openvdb::tools::UNSIGNED_DISTANCE_FIELD);
  });
}
