#include "apps/bench/peers/peer.h"

#include "libvox/io/read_mesh.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <new>
#include <stdexcept>

namespace vox::peer {
namespace {

/// Longest side of the box of all points that belong to a face.
double longestSide(const PolygonMesh& mesh) {
  Vec3d low = mesh.points[mesh.faceVertices.front()];
  Vec3d high = low;
  for (const Index v : mesh.faceVertices) {
    low = low.cwiseMin(mesh.points[v]);
    high = high.cwiseMax(mesh.points[v]);
  }
  return (high - low).maxCoeff();
}

struct Options {
  std::string input;
  std::string output;
  int dim = 256;
  double span = kDefaultSpan;
};

void convert(const Options& options, const Voxelize& voxelize) {
  openvdb::initialize();
  PolygonMesh mesh = readMesh(options.input);
  const double voxelSize = longestSide(mesh) / options.dim;
  if (!(voxelSize > 0)) throw std::runtime_error(options.input + ": all points are equal");
  for (Vec3d& point : mesh.points) point /= voxelSize;

  const auto grid = voxelize(mesh, options.span);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxelSize));
  openvdb::io::File(options.output).write({grid});
  std::cout << options.output << ": " << grid->activeVoxelCount() << " active voxels\n";
}

double distance(const Vec3d& a, const Vec3d& b) {
  return (a - b).lpNorm<Eigen::Infinity>();
}

}  // namespace

int run(int argc, char** argv, CLI::App& app, const Voxelize& voxelize) {
  const std::string& name = app.get_name();
  Options options;
  app.add_option("INPUT", options.input, "Mesh")->required();
  app.add_option("-o,--output", options.output, "OpenVDB file to write")->required();
  app.add_option("--dim", options.dim, "Voxels along the longest side of the input")
      ->check(CLI::Range(1, std::numeric_limits<int>::max()))
      ->capture_default_str();
  app.add_option("--span", options.span, "Longest face, in voxels, at which to stop")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  constexpr int kFailed = 1;
  constexpr int kOutOfMemory = 4;
  try {
    convert(options, voxelize);
    return 0;
  } catch (const std::bad_alloc&) {
    std::cerr << name << ": error: out of memory\n";
    return kOutOfMemory;
  } catch (const std::exception& error) {
    std::cerr << name << ": error: " << error.what() << '\n';
    return kFailed;
  }
}

openvdb::MaskGrid::Ptr newMask() {
  const auto mask = openvdb::MaskGrid::create();
  mask->setName("mask");
  return mask;
}

double spanOf(std::span<const Vec3d> corners) {
  if (corners.size() == 4) {
    double edges = 0;
    for (std::size_t i = 0; i < 4; ++i)
      edges = std::max(edges, distance(corners[i], corners[(i + 1) % 4]));
    const double diagonal =
        std::min(distance(corners[0], corners[2]), distance(corners[1], corners[3]));
    return std::max(edges, diagonal);
  }
  Vec3d low = corners.front();
  Vec3d high = low;
  for (const Vec3d& corner : corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  return (high - low).maxCoeff();
}

openvdb::Coord voxelOf(double x, double y, double z) {
  const auto round = [](double a) { return static_cast<openvdb::Int32>(std::floor(a + 0.5)); };
  return {round(x), round(y), round(z)};
}

}  // namespace vox::peer
