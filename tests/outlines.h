#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <cstdint>
#include <string>
#include <vector>

/// Letters, gears and other outlines with holes, and solids with such faces.
namespace vox::test {

/// A closed polygon in the plane z = 0.
using Loop = std::vector<Vec3d>;

/// A rim, counter-clockwise, and the holes in it, clockwise.
struct Outline {
  std::string name;
  std::vector<Loop> loops;
};

Loop circle(int corners, double radius, const Vec3d& center = Vec3d::Zero());
Loop rectangle(const Vec3d& low, const Vec3d& high);

Outline letterU();
Outline letterA();
Outline letterB(int corners);  ///< of each half circle
Outline letterC(int corners);  ///< of each of its arcs
Outline letterS(int corners);  ///< of each side
Outline letterO(int corners);
Outline letterI();  ///< with serifs
Outline figureEight(int corners);
Outline spiral(int corners, double turns);  ///< of each side
Outline comb(int teeth);
Outline gear(int teeth, double hole);  ///< radii: 3 to 4, and that of the hole, if any
Outline star(int tips);
Outline plate(int columns, int rows, int corners);  ///< with a round hole in each square of side 4

/// A random connected set of unit squares, as its outline with holes. Corners are on all lattice
/// points of the rim, so many lie between neighbours on a line. Its squares meet in sides only.
struct Squares {
  Outline outline;
  int count = 0;
  std::vector<Vec3d> lows;  ///< the lower left corner of each square
};
Squares randomSquares(int count, std::uint32_t seed);

double area(const Outline& outline);
/// Distance from a point of the plane z = 0 to the region of an outline; 0 inside.
double distanceFrom(const Outline& outline, const Vec3d& p);

/// The closed uniform quadratic B-splines with the loops as control polygons, as polygons.
Outline splineOf(const Outline& outline);

/// How a face with holes is written.
enum class Bridge {
  kSameVertices,    ///< each hole is walked from the first corner of the rim and back
  kEqualPositions,  ///< the same; every corner is a vertex of its own
  kChain,           ///< bridges with two vertices between their ends
  kHoleToHole,      ///< from the first corner of each hole to the next hole
  kSameDirection,   ///< the holes run like the rim
};

/// The solid between an outline in z = 0 and its copy in z = height: two faces, with bridges, and
/// quads.
PolygonMesh solidOf(const Outline& outline, double height, Bridge bridge = Bridge::kSameVertices);

}  // namespace vox::test
