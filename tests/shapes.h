#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

/// Mesh families and helpers for the tests.
namespace vox::test {

PolygonMesh meshOf(std::vector<Vec3d> points, std::initializer_list<std::vector<Index>> faces);

PolygonMesh cube();                           ///< [-1, 1]^3, 6 quads
PolygonMesh tetrahedron();                    ///< 4 triangles
PolygonMesh regularPolygon(int sides);        ///< one open face in the plane z = 0
PolygonMesh pyramid(int sides);               ///< apex of valence `sides` over an n-gon
PolygonMesh prism(int sides);                 ///< two n-gons joined by quads
PolygonMesh dodecahedron();                   ///< 12 pentagons
PolygonMesh torusGrid(int major, int minor);  ///< closed quads
/// A torus of triangles, all of about the size 1, with waves, and points moved by up to `jitter`.
PolygonMesh wavyTriangles(int around, double jitter);
PolygonMesh sheet(int columns, int rows);  ///< open grid of quads, wavy
PolygonMesh valenceTwo();                  ///< closed, with a point between only two faces
PolygonMesh bowTie();                      ///< two tetrahedra that share a point
PolygonMesh moebius(int quads);            ///< cannot be oriented

PolygonMesh klein(int columns, int rows);  ///< closed quads, cannot be oriented

PolygonMesh book(int count);  ///< triangles around one edge
PolygonMesh twoCones();       ///< open, with a common apex
PolygonMesh finOnSheet();     ///< a sheet, and two quads that stand on its middle

/// One shape of every family that can be subdivided.
struct Shape {
  std::string name;
  PolygonMesh mesh;
  bool closed;
};
const std::vector<Shape>& shapes();

/// The mesh without some faces.
/// @param gone  numbers of these faces
PolygonMesh withoutFaces(const PolygonMesh& mesh, const std::vector<Index>& gone);

PolygonMesh openFan(int faces, int sides);  ///< n-gons around one boundary vertex
PolygonMesh tube(int around, int along);    ///< quads around a circle, both ends open

/// Open shapes of every face size 3..8 and boundary valence 1..7, some with several loops.
const std::vector<Shape>& openShapes();

PolygonMesh unwelded(const PolygonMesh& mesh);  ///< every face with vertices of its own

void flipFace(PolygonMesh& mesh, Index f);
PolygonMesh insideOut(PolygonMesh mesh);

/// Rotates every face and flips each with the given probability.
PolygonMesh stirred(PolygonMesh mesh, double flips, std::uint32_t seed);

/// Both meshes as one. The second is scaled and moved; its vertices and faces come after those of
/// the first.
PolygonMesh together(PolygonMesh a, const PolygonMesh& b, const Vec3d& shift, double scale = 1);

PolygonMesh scaled(PolygonMesh mesh, double scale);  ///< about the origin

/// Scaled about the origin, then moved.
PolygonMesh moved(PolygonMesh mesh, const Vec3d& shift, double scale = 1);

/// Damages a mesh in one of many random ways: flips, doubles or deletes a face, welds vertices,
/// collapses an edge, moves corners to random vertices. The arrays stay valid.
void mutate(PolygonMesh& mesh, std::mt19937& random);

/// The same mesh with points and faces renumbered and faces rotated, at random.
PolygonMesh shuffled(const PolygonMesh& mesh, std::uint32_t seed);

bool sameMesh(const PolygonMesh& a, const PolygonMesh& b);

/// Points - edges + faces. Precondition: every point is used.
std::int64_t eulerCharacteristic(const PolygonMesh& mesh);

/// Message about the first fault of a mesh: it cannot be subdivided, or has a defect. Empty if
/// there is none.
std::string faultOf(const PolygonMesh& mesh);

Vec3d centroid(const std::vector<Vec3d>& points);
Vec3d faceCentroid(const PolygonMesh& mesh, Index f);

/// Whether two clouds have the same points up to `tolerance`, in any order. The points of a cloud
/// must be further apart than that.
bool samePoints(std::vector<Vec3d> a, std::vector<Vec3d> b, double tolerance);

}  // namespace vox::test
