// Triangle scan conversion (Cohen, Kaufman & Wang 1994, section 6), exact in integers.
//
// A triangle meets a box iff no axis separates them. The axes to try are those of the box, the
// normal of the triangle, and the cross products of box axes and edges, which are the edge normals
// of the three axis-aligned projections. This holds also for degenerate triangles, and for boxes
// that are segments along an axis. For the box of a voxel each test is a linear inequality in its
// integer centre, so it bounds an interval of voxels along a row or column. The intervals of the
// projections depend on one coordinate only and are tabulated. For each column, only the interval
// of the plane remains to be computed.

#include "libvox/voxelize/scan_large.h"

#include "libvox/core/error.h"
#include "libvox/voxelize/lattice.h"
#include "libvox/voxelize/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace vox::detail {
namespace {

/// Largest extent, in lattice steps, for which 64 bits hold every term: the normal is n <=
/// 2 extent^2, a centre c <= extent / kUnit + 2, and 2 n.c + n.(1, 1, 1) < 2^63.
constexpr std::int64_t kExtent64 = std::int64_t{512} * kUnit;
/// The same for 128 bits.
constexpr std::int64_t kExtent128 = (std::int64_t{1} << 30) * kUnit;
constexpr double kLargestCoordinate = 1 << 30;

/// Columns are scanned in tiles of this side, so that the tables of any triangle fit on the stack.
constexpr int kTile = 256;

/// Corners on the lattice, relative to the voxel that holds the first one.
struct Snapped {
  std::array<std::int32_t, 3> origin;
  std::array<Lattice, 3> corners;
  std::int64_t extent;
};

Snapped snap(std::span<const Vec3d, 3> corners, Index triangle) {
  Snapped snapped{};
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = corners[i][axis];
      if (!(std::abs(x) <= kLargestCoordinate))
        throw LimitError("triangle " + std::to_string(triangle) + " has coordinate " +
                         std::to_string(x) + ", in voxels; the limit is 2^30");
      snapped.corners[i][axis] = std::llrint(x * kUnit);
    }
    const std::int64_t voxel = floorDiv(snapped.corners[0][axis] + kHalf, kUnit);
    snapped.origin[axis] = static_cast<std::int32_t>(voxel);
    for (Lattice& corner : snapped.corners) corner[axis] -= voxel * kUnit;
    const auto [low, high] =
        std::minmax({snapped.corners[0][axis], snapped.corners[1][axis], snapped.corners[2][axis]});
    snapped.extent = std::max(snapped.extent, high - low);
  }
  if (snapped.extent > kExtent128)
    throw LimitError("triangle " + std::to_string(triangle) +
                     " is longer than 2^30 voxels along an axis");
  return snapped;
}

template <class Int>
int largestAxis(const std::array<Int, 3>& v) {
  int largest = 2;
  for (const int axis : {1, 0})
    if (magnitude(v[axis]) > magnitude(v[largest])) largest = axis;
  return largest;
}

/// Normal, not 0, of the plane of a triangle. For a segment or a point: of some plane through it.
template <class Int>
std::array<Int, 3> planeNormal(const std::array<Lattice, 3>& corners) {
  std::array<Int, 3> normal;
  std::array<std::array<Int, 3>, 3> edges;
  for (int i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis)
      edges[i][axis] = Int{corners[(i + 1) % 3][axis]} - corners[i][axis];
  for (int axis = 0; axis < 3; ++axis) {
    const int a = (axis + 1) % 3;
    const int b = (axis + 2) % 3;
    normal[axis] = edges[0][a] * edges[1][b] - edges[0][b] * edges[1][a];
  }
  if (normal != std::array<Int, 3>{}) return normal;

  // A segment or point: a normal in the plane of the axes along which it is longest and shortest.
  std::array<Int, 3> along = edges[0];
  for (const auto& edge : edges)
    if (magnitude(edge[largestAxis(edge)]) > magnitude(along[largestAxis(along)])) along = edge;
  const int longest = largestAxis(along);
  int shortest = (longest + 1) % 3;
  if (magnitude(along[(longest + 2) % 3]) < magnitude(along[shortest]))
    shortest = (longest + 2) % 3;
  normal[longest] = -along[shortest];
  normal[shortest] = along[longest] == 0 ? Int{1} : along[longest];
  return normal;
}

/// Writes blocks with runs of voxels along axis w, one for each column of a row along u. Use a
/// local copy: no block can overlap it, so the compiler keeps its members in registers.
class RowWriter {
 public:
  RowWriter(const std::array<int, 3>& axes, const std::array<std::int32_t, 3>& origin,
            Index triangle)
      : u_(axes[0]),
        v_(axes[1]),
        w_(axes[2]),
        originU_(origin[u_]),
        originW_(origin[w_]),
        pattern_{origin, triangle, 1} {
    const int stride = 4 - 2 * w_;  // log2 of the bits from voxel to voxel
    for (int count = 0; count < 4; ++count)
      runs_[count + 1] = runs_[count] | std::uint64_t{1} << (count << stride);
  }

  RowWriter inRow(std::int32_t v) const {
    RowWriter writer = *this;
    writer.pattern_.origin[v_] += v;
    return writer;
  }

  /// Writes a block with voxel (u, v, w).
  void one(VoxelBlock& block, std::int32_t u, std::int32_t w) const {
    block = pattern_;
    block.origin[u_] = originU_ + u;
    block.origin[w_] = originW_ + w;
  }

  /// Writes a block with `count` voxels (0 to 4) from (u, v, w) on.
  void run(VoxelBlock& block, std::int32_t u, std::int32_t w, int count) const {
    one(block, u, w);
    block.voxels = runs_[count];
  }

 private:
  int u_, v_, w_;
  std::int32_t originU_, originW_;
  VoxelBlock pattern_;
  std::array<std::uint64_t, 5> runs_{};
};

/// The scan of one triangle. Axis w is the one along which its normal is largest; columns run along
/// w, rows along u. Within a column the plane rises by two voxels at most, so that a column has at
/// most four active voxels.
template <class Int>
class TriangleScan {
 public:
  TriangleScan(const Snapped& snapped, Index triangle, BlockSink& sink);

  void scan(Separation separation) {
    for (std::int64_t part = 0; part < partCount(); ++part) scanPart(part, separation);
  }

  /// Number of parts; a part is a tile of rows.
  std::int64_t partCount() const { return (std::int64_t{rows_.hi} - rows_.lo + kTile) / kTile; }
  void scanPart(std::int64_t part, Separation separation) {
    const auto v = static_cast<std::int32_t>(rows_.lo + part * kTile);
    const auto count = static_cast<std::size_t>(std::min(kTile, rows_.hi - v + 1));
    if (separation == Separation::k26)
      scanRows26(v, count);
    else
      scanRows6(v, count);
  }

 private:
  using Table = std::array<Interval, kTile>;

  /// Tables of the projections for separation 6. A name gives the two axes and the pads along them.
  struct Tables6 {
    Table uv00, uv10, uv01, wv00, wu00;
  };

  void scanRows26(std::int32_t firstV, std::size_t count);
  void scanRows6(std::int32_t firstV, std::size_t count);
  void scanRow6(const Tables6& tables, std::int32_t firstU, std::int32_t firstV, std::size_t row,
                Interval columns);
  bool active6(const Tables6& tables, std::size_t column, std::size_t row, std::int32_t u,
               std::int32_t w, Int height) const;

  /// Calls tile(columns) for the tiles along u that cover all columns of some rows.
  template <class Tile>
  static void forTiles(std::span<const Interval> rows, Tile&& tile) {
    Interval all = {std::numeric_limits<std::int32_t>::max(),
                    std::numeric_limits<std::int32_t>::min()};
    for (const Interval& row : rows)
      if (!row.empty()) all = {std::min(all.lo, row.lo), std::max(all.hi, row.hi)};
    for (std::int32_t u = all.lo; u <= all.hi; u += kTile)
      tile(Interval{u, std::min(all.hi, u + kTile - 1)});
  }

  /// floor((top - 2 n.(u, v, 0)) / 2 n_w) for u, u + 1, ...: the highest w with 2 n.c <= top.
  FloorLine<Int> highest(Int top, std::int32_t u, std::int32_t v) const {
    return {top - 2 * (normalU_ * u + normalV_ * v), -2 * normalU_, 2 * normalW_};
  }

  BlockSink& sink_;
  const std::array<Int, 3> normal_;
  const int axisW_, axisU_, axisV_;
  const Projection<Int> uv_, wv_, wu_;
  const RowWriter writer_;
  Interval rows_;
  Int normalU_, normalV_, normalW_;  ///< normal of the plane; W is positive and the largest
  Int sizeU_, sizeV_;                ///< magnitudes of normalU_ and normalV_
  /// A box of centre c and half widths t meets the plane iff ceil - t.|n| <= 2 n.c <= floor +
  /// t.|n|.
  Int planeFloor_, planeCeil_;
};

template <class Int>
TriangleScan<Int>::TriangleScan(const Snapped& snapped, Index triangle, BlockSink& sink)
    : sink_(sink),
      normal_(planeNormal<Int>(snapped.corners)),
      axisW_(largestAxis(normal_)),
      axisU_(axisW_ == 2 ? 1 : 2),
      axisV_(axisW_ == 0 ? 1 : 0),
      uv_(snapped.corners, axisU_, axisV_),
      wv_(snapped.corners, axisW_, axisV_),
      wu_(snapped.corners, axisW_, axisU_),
      writer_({axisU_, axisV_, axisW_}, snapped.origin, triangle) {
  const auto [lowV, highV] = std::minmax(
      {snapped.corners[0][axisV_], snapped.corners[1][axisV_], snapped.corners[2][axisV_]});
  rows_ = voxelsAcross(lowV, highV, 1);

  const Int sign = normal_[axisW_] < 0 ? -1 : 1;
  normalU_ = sign * normal_[axisU_];
  normalV_ = sign * normal_[axisV_];
  normalW_ = sign * normal_[axisW_];
  sizeU_ = magnitude(normalU_);
  sizeV_ = magnitude(normalV_);
  const Lattice& corner = snapped.corners[0];
  const Int128 offset = Int128{normalU_} * corner[axisU_] + Int128{normalV_} * corner[axisV_] +
                        Int128{normalW_} * corner[axisW_];
  planeFloor_ = static_cast<Int>(offset >> kHalfLog2);
  planeCeil_ = static_cast<Int>(-(-offset >> kHalfLog2));
}

template <class Int>
void TriangleScan<Int>::scanRows26(std::int32_t firstV, std::size_t count) {
  Table uv, wv, wu;
  uv_.slice(1, 1, firstV, std::span(uv).first(count));
  wv_.slice(1, 1, firstV, std::span(wv).first(count));

  // In a column, the plane meets the voxels w from floor(lowest / 2 n_w) to floor((lowest + spread)
  // / 2 n_w).
  const Int size = sizeU_ + sizeV_ + normalW_;
  const Int lowest = planeCeil_ - size + 2 * normalW_ - 1;
  const Int spread = planeFloor_ + size - lowest;
  forTiles(std::span(uv).first(count), [&](Interval tile) {
    wu_.slice(1, 1, tile.lo, std::span(wu).first(tile.size()));
    for (std::size_t row = 0; row < count; ++row) {
      const Interval columns = tile.common(uv[row]);
      if (columns.empty()) continue;
      const auto v = firstV + static_cast<std::int32_t>(row);
      const RowWriter writer = writer_.inRow(v);
      FloorLine<Int> line = highest(lowest, columns.lo, v);
      VoxelBlock* const blocks = sink_.room(kTile);
      VoxelBlock* block = blocks;
      for (std::int32_t u = columns.lo; u <= columns.hi; ++u, line.next()) {
        const Int reach = line.rest + spread;
        const int more =
            (reach >= line.divisor) + (reach >= 2 * line.divisor) + (reach >= 3 * line.divisor);
        const auto low = static_cast<std::int32_t>(line.floor);
        const Interval run = Interval{low, low + more}.common(wv[row]).common(wu[u - tile.lo]);
        writer.run(*block++, u, run.lo, run.hi - run.lo + 1);
      }
      sink_.take(static_cast<std::size_t>(block - blocks));
    }
  });
}

template <class Int>
void TriangleScan<Int>::scanRows6(std::int32_t firstV, std::size_t count) {
  Tables6 tables;
  const auto rows = [&](Table& table) { return std::span(table).first(count); };
  uv_.slice(0, 0, firstV, rows(tables.uv00));
  uv_.slice(1, 0, firstV, rows(tables.uv10));
  uv_.slice(0, 1, firstV, rows(tables.uv01));
  wv_.slice(0, 0, firstV, rows(tables.wv00));

  Table hull;
  for (std::size_t row = 0; row < count; ++row) hull[row] = tables.uv10[row].hull(tables.uv01[row]);
  forTiles(rows(hull), [&](Interval tile) {
    wu_.slice(0, 0, tile.lo, std::span(tables.wu00).first(tile.size()));
    for (std::size_t row = 0; row < count; ++row) {
      const Interval met = tile.common(hull[row]);
      if (!met.empty()) scanRow6(tables, tile.lo, firstV, row, met);
    }
  });
}

/// In a column whose centre line meets the triangle, the voxels nearest to the plane are active:
/// mostly one. In columns around it, only the same voxels can be active, if their segments along u
/// or v meet the triangle: along half a voxel the plane rises by at most half a voxel.
template <class Int>
void TriangleScan<Int>::scanRow6(const Tables6& tables, std::int32_t firstU, std::int32_t firstV,
                                 std::size_t row, Interval columns) {
  const auto v = firstV + static_cast<std::int32_t>(row);
  const RowWriter writer = writer_.inRow(v);
  const bool open = planeFloor_ != planeCeil_;
  FloorLine<Int> line = highest(planeCeil_ + normalW_ - 1, columns.lo, v);
  VoxelBlock* const blocks = sink_.room(2 * kTile);
  VoxelBlock* block = blocks;

  // If the plane is halfway between two centres, both voxels are active.
  const auto tied = [&] { return !open && line.rest == line.divisor - 1; };
  const auto tryUntil = [&](std::int32_t& u, std::int32_t end) {
    for (; u < end; ++u, line.next()) {
      const auto w = static_cast<std::int32_t>(line.floor);
      const auto column = static_cast<std::size_t>(u - firstU);
      const Int height = normalW_ - 1 - line.rest;
      writer.one(*block, u, w);
      block += active6(tables, column, row, u, w, height);
      if (!tied()) continue;
      writer.one(*block, u, w + 1);
      block += active6(tables, column, row, u, w + 1, height + 2 * normalW_);
    }
  };

  std::int32_t u = columns.lo;
  const Interval inside = columns.common(tables.uv00[row]);
  if (!inside.empty()) {
    tryUntil(u, inside.lo);
    if (open)
      for (; u <= inside.hi; ++u, line.next())
        writer.one(*block++, u, static_cast<std::int32_t>(line.floor));
    else
      for (; u <= inside.hi; ++u, line.next())
        writer.run(*block++, u, static_cast<std::int32_t>(line.floor), 1 + tied());
  }
  tryUntil(u, columns.hi + 1);
  sink_.take(static_cast<std::size_t>(block - blocks));
}

/// Whether the segment of voxel (u, v, w) along u or v meets the triangle. Precondition: its
/// segment along w does not.
///
/// The inequalities tested here imply the other ones. If n has a component along the segment, the
/// line of the segment meets the triangle (wv00, wu00), and the test of the plane shows that the
/// point is within the segment. If n has none, the segment lies in the plane, whose projection on
/// uv is one to one. There are no branches, because they could not be predicted.
/// @param height  2 n.c - planeCeil_ for the centre c of the voxel
template <class Int>
bool TriangleScan<Int>::active6(const Tables6& tables, std::size_t column, std::size_t row,
                                std::int32_t u, std::int32_t w, Int height) const {
  const auto nearPlane = [&](Int size) {
    return (-size <= height) & (height + planeCeil_ - planeFloor_ <= size);
  };
  const bool alongU =
      tables.uv10[row].contains(u) & tables.wv00[row].contains(w) & nearPlane(sizeU_);
  const bool alongV =
      tables.uv01[row].contains(u) & tables.wu00[column].contains(w) & nearPlane(sizeV_);
  return alongU | alongV;
}

/// Calls work(scan) with the TriangleScan of a triangle, in 64 or 128 bits.
template <class Work>
auto withScan(std::span<const Vec3d, 3> corners, Index triangle, BlockSink& sink, Work&& work) {
  const Snapped snapped = snap(corners, triangle);
  if (snapped.extent <= kExtent64) return work(TriangleScan<std::int64_t>(snapped, triangle, sink));
  return work(TriangleScan<Int128>(snapped, triangle, sink));
}

}  // namespace

void scanLarge(std::span<const Vec3d, 3> corners, Index triangle, Separation separation,
               BlockSink& sink) {
  withScan(corners, triangle, sink, [&](auto&& scan) { scan.scan(separation); });
}

std::int64_t largePartCount(std::span<const Vec3d, 3> corners) {
  BlockSink unused([](void*, std::span<const VoxelBlock>) {}, nullptr);
  return withScan(corners, 0, unused, [](auto&& scan) { return scan.partCount(); });
}

void scanLargePart(std::span<const Vec3d, 3> corners, std::int64_t part, Separation separation,
                   BlockSink& sink) {
  withScan(corners, 0, sink, [&](auto&& scan) { scan.scanPart(part, separation); });
}

}  // namespace vox::detail
