// libvox as a library: a mesh made in memory becomes an OpenVDB grid in memory, then a file.
// Usage: example OUT.vdb

#include <libvox/core/error.h>
#include <libvox/pipeline/convert.h>
#include <openvdb/openvdb.h>

#include <iostream>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: example OUT.vdb\n";
    return 2;
  }
  vox::PolygonMesh tetrahedron;
  tetrahedron.points = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  for (const std::vector<vox::Index>& face :
       std::vector<std::vector<vox::Index>>{{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}})
    tetrahedron.addFace(face);

  vox::Scene scene;
  scene.objects.push_back({"tetrahedron", tetrahedron});
  vox::ConvertOptions options;
  options.dim = 128;

  try {
    const vox::Conversion conversion = vox::convert(scene, options);
    const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(conversion.grids[0]);
    std::cout << density->getName() << ": " << density->activeVoxelCount() << " active voxels, "
              << conversion.report.objects[0].levels << " levels\n";
    vox::writeGrids(argv[1], conversion, /*overwrite=*/true);
  } catch (const vox::Error& error) {
    std::cerr << error.what() << '\n';
    return error.exitCode();
  }
}
