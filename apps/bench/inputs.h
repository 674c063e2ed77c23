#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <string_view>
#include <vector>

/// Generated meshes for benchmarks: nothing to download, the same on every machine.
namespace vox::bench {

/// One generated mesh. All are closed oriented manifolds of one component, wound outward.
struct Input {
  std::string_view name;
  std::string_view what;
  PolygonMesh (*make)();
  bool isLarge = false;  ///< takes seconds and gigabytes
};

/// Every generated mesh, by name:
///
///   torus               64 x 32 quads, major radius 1, minor 0.4
///   cube                [-1, 1]^3, 6 quads
///   triangles           bumpy sphere of 100 352 triangles
///   triangles_shuffled  the same, points and faces in random order (always the same one)
///   triangles_graded    as many, edges apart by about 10, as in adaptive meshes and scans
///   cone                apex shared by 2000 triangles, closed by a 2000-gon
///   prism               two 5000-gons joined by 5000 quads
///   sliver              flat bar of 16 strips side by side, each 1000 times longer than wide
///   graded              tapering spire, faces from 1 down to 1e-6 in size
///   quads               6144 quads, points of valence 3, 4 and 6, sizes apart by about 10
///   scan_1m             scan of 998 000 triangles; large
///   scan_4m             of 3 996 000 triangles; large
///   scan_4m_shuffled    the same in random order; large
///   scan_10m            of 10 233 600 triangles; large
const std::vector<Input>& inputs();

/// A mesh like a scan of a sphere with bumps of three sizes: 4 n (n - 1) triangles between circles
/// of latitude, positions rounded to floats.
PolygonMesh scan(int n);

/// The generated mesh with this name.
/// @throws UsageError  there is none
PolygonMesh makeInput(std::string_view name);

}  // namespace vox::bench
