#pragma once

#include "libvox/foot/biquadratic.h"
#include "libvox/foot/star_fit.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/region.h"
#include "libvox/grid/transform.h"

#include <tbb/concurrent_vector.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vox {

/// Factor from parameters at a corner of a cell at a crease to those a little farther in. In the
/// corner a derivative is 0, and the product of rounding errors has any direction; beside it there
/// is a normal.
inline constexpr float kBesideCorner = 1 - 1.0F / 1024;

inline constexpr int kBinLog2 = 5;
inline constexpr int kBinSide = 1 << kBinLog2;  ///< voxels

/// Where to look for the voxels of a cell: the space between three pairs of parallel planes, within
/// a box of voxels. Coordinates are relative to `origin`, so that floats are precise enough.
struct Prism {
  openvdb::Coord origin;
  Float3 centre;
  std::array<Float3, 3> normals;  ///< |normals[k] . (x - centre)| <= 1 inside
  openvdb::CoordBBox box;
};

/// A cell: a part of the limit surface that turns so little, or is so small, that Newton's method
/// finds the foot of a point near it.
struct NewtonCell {
  Prism prism;
  Biquadratic surface;          ///< from prism.origin
  std::array<Float3, 2> guess;  ///< first a, b of a point x: guess . (x - surface[0])
  int mostSteps = 0;
  bool severalStarts = false;  ///< it turns so much that there may be several local minima
  bool isCurve = false;        ///< a curve in which the surface ends
  float creaseBias = 0;        ///< voxels added where the foot is at a crease, and not upright
  float stop = 0;              ///< a step of fewer parameters is the last one
  // Its place: parameter u of the square of the corner is u + side[0] a, v is v + side[1] b.
  float u = 0, v = 0;
  std::array<float, 2> side = {};
};

/// A cell with distance t and parameters a, b as cubic polynomials of x - prism.centre. Order of
/// the terms: 1; the coordinates; their 6 products of two; their 10 products of three, each in the
/// order of the alphabet.
struct PolynomialCell {
  Prism prism;
  std::array<std::array<float, 20>, 3> terms;  ///< of t, a, b
  float limitA = 1, limitB = 1;  ///< the foot is in the cell if |a| and |b| are at most these
};

/// A part of the surface as a height above a rectangle (foot/star_fit.h), without a place.
struct HeightCell {
  Prism prism;
  Float3 middle;                   ///< of the rectangle, from prism.origin
  std::array<Float3, 3> axes;      ///< unit: along a, along b, and up
  Quartic<float> height;           ///< a, b in voxels
  std::array<float, 2> half = {};  ///< half sides of the rectangle
  /// Feet are where s[0] a + s[1] b <= s[2]; (s[0], s[1]) is a unit vector.
  std::array<Float3, kMostOfStar> sides;
  std::uint32_t sideCount = 0;
  float stop = 0;  ///< a shorter step is the last one, voxels
};

/// A flat triangle of a polygon mesh. The foot of a point is in its face, on an edge or at a
/// vertex; the normal of this place tells the side of the point.
struct TriangleCell {
  Prism prism;
  std::array<Float3, 3> points;       ///< counter-clockwise, from prism.origin
  Float3 normal;                      ///< unit
  std::array<Float3, 3> edgeNormals;  ///< of the edge from point i to the next: sum of both faces'
  std::array<Float3, 3> vertexNormals;  ///< means of the faces', weighted by their angles
  float creaseBias = 0;                 ///< kRibbon: as that of a NewtonCell
  /// kRibbon: place of each point in the square of the corner that owns the cell.
  std::array<std::array<float, 2>, 3> places = {};
};

enum class CellKind : std::uint8_t {
  kNewton,
  kPolynomial,
  kHeight,
  kTriangle,  ///< of a polygon mesh
  kRibbon,    ///< a triangle of a sliver of the limit surface
};

/// A cell in a bin: a cube of 32^3 voxels, aligned, which one task scans.
struct BinnedCell {
  openvdb::Coord bin;   ///< lowest voxel / 32
  std::uint32_t owner;  ///< orders the cells; all cells of an owner are in one store
  std::uint32_t cell;   ///< index in its store, among the cells of its kind
  std::uint16_t store;
  CellKind kind;
};

/// Cells that stay where they are while others are added: a vector that grows would copy them, and
/// hold twice their memory meanwhile.
template <class Cell>
using Cells = tbb::concurrent_vector<Cell>;

/// The cells that one thread has made.
struct CellStore {
  std::uint16_t number = 0;
  Cells<NewtonCell> newton;
  Cells<PolynomialCell> polynomial;
  Cells<HeightCell> heights;
  Cells<TriangleCell> triangles;
  std::vector<BinnedCell> binned;
  const std::vector<openvdb::Coord>* onlyBins =
      nullptr;         ///< if not null: the bins of interest, sorted
  Region region = {};  ///< of interest are the bins that it meets

  /// Whether the bins of a box of voxels are of no interest to its region.
  bool isFar(const openvdb::CoordBBox& box) const {
    constexpr int kLast = kBinSide - 1;
    if (!region.hasPages()) return false;
    const openvdb::Coord low = box.min() & ~kLast;
    const openvdb::Coord high = (box.max() & ~kLast).offsetBy(kLast);
    return !region.meetsPages({low, high});
  }

  /// Whether a part of a surface with its tube reaches no bin of interest.
  /// @param part   box of the part, or of its control points
  /// @param reach  of the tube, voxels
  bool isFar(const Box& part, double reach) const;

  std::uint64_t bytes() const {
    return newton.size() * sizeof(NewtonCell) + polynomial.size() * sizeof(PolynomialCell) +
           heights.size() * sizeof(HeightCell) + triangles.size() * sizeof(TriangleCell) +
           binned.capacity() * sizeof(BinnedCell);
  }

  /// Enters a cell in all bins of interest that its box meets.
  void bin(const Prism& prism, std::uint32_t owner, std::ptrdiff_t cell, CellKind kind);
};

}  // namespace vox
