// OpenSubdiv's uniform Catmull-Clark refinement of a mesh, topology and positions. (OpenSubdiv has
// no Doo-Sabin and no voxels.)

#include "libvox/io/read_mesh.h"

#include <CLI/CLI.hpp>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace {

namespace Far = OpenSubdiv::Far;

/// A position, with the interface that OpenSubdiv needs for interpolation.
struct Point {
  vox::Vec3d at = vox::Vec3d::Zero();
  void Clear() { at.setZero(); }
  void AddWithWeight(const Point& other, double weight) { at += weight * other.at; }
};

std::unique_ptr<Far::TopologyRefiner> refinerOf(const vox::PolygonMesh& mesh) {
  std::vector<int> sizes;
  for (vox::Index f = 0; f < mesh.faceCount(); ++f)
    sizes.push_back(static_cast<int>(mesh.faceSize(f)));
  const std::vector<int> corners(mesh.faceVertices.begin(), mesh.faceVertices.end());
  Far::TopologyDescriptor descriptor;
  descriptor.numVertices = static_cast<int>(mesh.pointCount());
  descriptor.numFaces = static_cast<int>(mesh.faceCount());
  descriptor.numVertsPerFace = sizes.data();
  descriptor.vertIndicesPerFace = corners.data();
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  return std::unique_ptr<Far::TopologyRefiner>(
      Factory::Create(descriptor, {OpenSubdiv::Sdc::SCHEME_CATMARK, {}}));
}

void refine(const std::string& file, int levels) {
  const vox::PolygonMesh mesh = vox::readMesh(file);
  const auto refiner = refinerOf(mesh);
  refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(levels));
  const Far::PrimvarRefinerReal<double> interpolate(*refiner);
  std::vector<Point> points(mesh.pointCount());
  for (vox::Index i = 0; i < mesh.pointCount(); ++i) points[i].at = mesh.points[i];
  for (int level = 1; level <= levels; ++level) {
    std::vector<Point> finer(static_cast<std::size_t>(refiner->GetLevel(level).GetNumVertices()));
    interpolate.Interpolate(level, points, finer);
    points = std::move(finer);
  }
  std::cout << points.size() << " vertices of level " << levels << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("OpenSubdiv's uniform Catmull-Clark refinement.", "vox_peer_opensubdiv");
  std::string file;
  int levels = 0;
  app.add_option("INPUT", file, "Mesh")->required();
  app.add_option("--levels", levels, "Levels")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    refine(file, levels);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "vox_peer_opensubdiv: error: " << error.what() << '\n';
    return 1;
  }
}
