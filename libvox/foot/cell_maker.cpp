// Pieces to cells: how far a part turns and spreads decides whether it is cut, and what cell it is.

#include "libvox/foot/cell_maker.h"

#include "libvox/foot/foot_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vox {
namespace {

constexpr float kLongestFlat = 20;   // voxels
constexpr float kLongestCurved = 4;  // voxels
constexpr float kReachMargin = 0.05F;
constexpr float kMostSine = 0.5F;  // of the turn of a normal within a cell
constexpr int kMostDepth = 20;
constexpr float kLeastArea = 1e-18F;  // squares of smaller numbers are 0 in floats
constexpr float kCreaseBias = 1e-3F;  // voxels

/// Longest step between control points along u, or along v.
float longestStep(const LimitPiece& piece, bool alongU) {
  double longest = 0;
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const auto& p = piece.points;
      const Vec3d step = alongU ? Vec3d(p[i + 1][j] - p[i][j]) : Vec3d(p[j][i + 1] - p[j][i]);
      longest = std::max(longest, step.norm());
    }
  return static_cast<float>(longest);
}

/// Range of values.
struct Range {
  float low = std::numeric_limits<float>::max();
  float high = std::numeric_limits<float>::lowest();
  void add(float value, float margin) {
    low = std::min(low, value - margin);
    high = std::max(high, value + margin);
  }
};

}  // namespace

/// What is known of a part of a piece: its coefficients, the frame in its middle, and how it
/// extends in this frame, measured at 4 x 4 points.
struct CellMaker::Shape {
  Biquadratic c;
  openvdb::Coord origin;
  Float3 alongA, alongB, normal = {};  // derivatives and unit normal in the middle
  std::array<Float3, 2> guess = {};    // a and b of a point, if the surface were flat
  float lengthA, lengthB;              // of alongA, alongB: half of the cell's sides
  bool degenerate;                     // it has no normal in the middle
  bool badNormal;                      // it has no normal somewhere, or nearly so
  std::array<Range, 3> tube;           // extent of the tube in the frame; along the normal: surface
  std::array<float, 2> flat = {};      // largest |a| and |b| of the surface itself
  float sine = 1;                      // of the largest turn of the normal from the middle
  float flare = 1;                     // how much the tube is wider than the surface
  std::array<Range, 3> box;            // of the tube
  float turnA, turnB;                  // how much it turns along a and b

  Shape(const LimitPiece& piece, const ParameterBox& part, float reach) {
    const auto exact = coefficientsOf(piece.points, part);
    for (int k = 0; k < 3; ++k) origin[k] = static_cast<int>(std::lround(exact[0][k]));
    for (std::size_t m = 0; m < 9; ++m)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        const double shift = m == 0 ? origin[static_cast<int>(k)] : 0;
        c[m][k] = static_cast<float>(exact[m][axis] - shift);
      }
    setFrame();
    measure(reach);
    setTurn();
  }

 private:
  void setFrame() {
    alongA = c[1];
    alongB = c[3];
    normal = cross(alongA, alongB);
    const float area = length(normal);
    lengthA = length(alongA);
    lengthB = length(alongB);
    degenerate = !(area > 1e-5F * lengthA * lengthB) || area < 1e-12F;
    badNormal = degenerate;
    if (degenerate) {
      normal = {};
      return;
    }
    for (float& x : normal) x /= area;
    guess = {cross(alongB, normal), cross(normal, alongA)};
    for (Float3& g : guess)
      for (float& x : g) x /= area;
  }

  /// Measures at 4 x 4 points. Loops run over the points, so that the compiler uses vectors.
  void measure(float reach) {
    constexpr std::size_t kPoints = 16;
    using Points = std::array<float, kPoints>;
    constexpr std::array<float, 4> kPlaces = {-1, -1.0F / 3, 1.0F / 3, 1};
    std::array<Points, 3> s, sa, sb, n;
    for (std::size_t x = 0; x < 3; ++x)
      for (std::size_t i = 0; i < kPoints; ++i) {
        const float a = kPlaces[i % 4], b = kPlaces[i / 4];
        const float r1 = c[3][x] + a * (c[4][x] + a * c[5][x]);
        const float r2 = c[6][x] + a * (c[7][x] + a * c[8][x]);
        const float d1 = c[4][x] + 2 * a * c[5][x];
        const float d2 = c[7][x] + 2 * a * c[8][x];
        s[x][i] = c[0][x] + a * (c[1][x] + a * c[2][x]) + b * (r1 + b * r2);
        sa[x][i] = c[1][x] + 2 * a * c[2][x] + b * (d1 + b * d2);
        sb[x][i] = r1 + 2 * b * r2;
      }
    Points sizes;
    for (std::size_t i = 0; i < kPoints; ++i) {
      const float nx = sa[1][i] * sb[2][i] - sa[2][i] * sb[1][i];
      const float ny = sa[2][i] * sb[0][i] - sa[0][i] * sb[2][i];
      const float nz = sa[0][i] * sb[1][i] - sa[1][i] * sb[0][i];
      const float size = std::sqrt(nx * nx + ny * ny + nz * nz);
      const float inverse = size > kLeastArea ? 1 / size : 0;
      sizes[i] = size;
      n[0][i] = nx * inverse, n[1][i] = ny * inverse, n[2][i] = nz * inverse;
    }
    Points at, spread;
    const auto alongFrame = [&](const Float3& axis) {
      for (std::size_t i = 0; i < kPoints; ++i) {
        at[i] = axis[0] * (s[0][i] - c[0][0]) + axis[1] * (s[1][i] - c[0][1]) +
                axis[2] * (s[2][i] - c[0][2]);
        spread[i] = axis[0] * n[0][i] + axis[1] * n[1][i] + axis[2] * n[2][i];
      }
    };
    for (std::size_t k = 0; k < 2; ++k) {
      alongFrame(guess[k]);
      for (std::size_t i = 0; i < kPoints; ++i) {
        flat[k] = std::max(flat[k], std::abs(at[i]));
        tube[k].add(at[i], reach * std::abs(spread[i]));
      }
    }
    alongFrame(normal);
    float turn = 0;  // square of the sine
    for (std::size_t i = 0; i < kPoints; ++i) {
      tube[2].add(at[i], 0);
      turn = std::max(turn, spread[i] < 0 ? 1 : 1 - spread[i] * spread[i]);
      for (std::size_t k = 0; k < 3; ++k) box[k].add(s[k][i], reach * std::abs(n[k][i]));
    }
    const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
    if (*least <= kLeastArea || *least < 0.02F * *most) badNormal = true;
    sine = std::sqrt(std::max(0.0F, turn));
    const auto wider = [&](std::size_t k) {
      return std::max(-tube[k].low, tube[k].high) - flat[k];
    };
    flare = std::max(wider(0), wider(1));
  }

  /// Second derivatives along the normal, as far as they reach over the cell.
  void setTurn() {
    const auto bend = [&](std::size_t m) {
      return std::abs(dot(c[m], normal)) + 0.1F * length(c[m]);
    };
    turnA = badNormal ? lengthA : bend(2) + 0.5F * bend(4);
    turnB = badNormal ? lengthB : bend(6) + 0.5F * bend(4);
  }
};

float CellMaker::biasOf(unsigned sides) const {
  return options_.creases && sides != 0 ? kCreaseBias : 0;
}

bool CellMaker::isFar(const LimitPiece& piece) const {
  if (!store_.region.hasPages()) return false;
  Box box;
  for (const auto& row : piece.points)
    for (const Vec3d& point : row) box.add(point);
  return store_.isFar(box, options_.reach);
}

void CellMaker::piece(const LimitPiece& piece) {
  if (isFar(piece)) return;
  piece_ = &piece;
  const float bias = biasOf(piece.boundarySides);
  if (piece.boundarySides != kAllSides && ribbon_.set(piece, bias != 0))
    return addRibbon(ribbon_, piece, options_.reach, bias, owner(), store_);
  const auto parts = [&](bool alongU) {
    return std::max(1,
                    static_cast<int>(std::ceil(longestStep(piece, alongU) / kLongestFlat - 1e-6F)));
  };
  const int countU = parts(true);
  const int countV = parts(false);
  for (int i = 0; i < countU; ++i)
    for (int j = 0; j < countV; ++j) {
      unsigned sides = piece.boundarySides;
      if (i > 0) sides &= ~unsigned{kSideU0};
      if (i + 1 < countU) sides &= ~unsigned{kSideU1};
      if (j > 0) sides &= ~unsigned{kSideV0};
      if (j + 1 < countV) sides &= ~unsigned{kSideV1};
      const auto at = [](int k, int of) { return static_cast<double>(k) / of; };
      makeCell({at(i, countU), at(i + 1, countU), at(j, countV), at(j + 1, countV)}, sides, 0);
    }
}

/// Makes a cell of a part of the piece, or cuts it in two.
void CellMaker::makeCell(const ParameterBox& part, unsigned sides, int depth) {
  const Shape shape(*piece_, part, options_.reach + kReachMargin);
  const float sideA = 2 * shape.lengthA;
  const float sideB = 2 * shape.lengthB;
  const float longest = std::max(sideA, sideB);
  const bool curved = shape.flare > 0.35F || shape.badNormal;
  const bool small = std::min(sideA, sideB) < 1.5F || sideA * sideB < 6;
  const bool byNewton = curved || small || sides != 0 || !options_.polynomials;
  const auto cut = [&](bool alongA) { splitCell(part, sides, depth, alongA); };
  const bool mayCut = depth < kMostDepth;
  if (byNewton) {
    const float limit = curved || sides != 0 ? kLongestCurved : kLongestFlat;
    if (mayCut && longest > 1.3F * limit) return cut(sideA >= sideB);
    if (mayCut && (shape.sine > kMostSine || shape.badNormal) && longest > 0.3F)
      return cut(sideA < 0.1F ? false : sideB < 0.1F || shape.turnA >= shape.turnB);
    return addNewtonCell(shape, part, sides);
  }
  if (mayCut && shape.sine > 0.4F) return cut(shape.turnA >= shape.turnB);
  if (addPolynomialCell(shape)) return;
  if (mayCut && longest >= 3) return cut(shape.turnA >= shape.turnB);
  addNewtonCell(shape, part, sides);
}

void CellMaker::splitCell(const ParameterBox& part, unsigned sides, int depth, bool alongU) {
  ParameterBox low = part;
  ParameterBox high = part;
  if (alongU)
    low.u1 = high.u0 = (part.u0 + part.u1) / 2;
  else
    low.v1 = high.v0 = (part.v0 + part.v1) / 2;
  makeCell(low, sides & ~unsigned{alongU ? kSideU1 : kSideV1}, depth + 1);
  makeCell(high, sides & ~unsigned{alongU ? kSideU0 : kSideV0}, depth + 1);
}

/// The prism around the tube of a cell, somewhat larger, so that prisms of neighbours overlap. At a
/// boundary also around everything within reach beyond it.
Prism CellMaker::prismOf(const Shape& shape, unsigned sides) const {
  const float reach = options_.reach + kReachMargin;
  // The way out of a side is perpendicular to it: in a skew cell it also leads along the side.
  const float sizes = length(shape.guess[0]) * length(shape.guess[1]);
  const float cosine = sizes > 0 ? std::abs(dot(shape.guess[0], shape.guess[1])) / sizes : 1;
  const float skew = std::min(1.0F, 0.3F + cosine);
  std::array<float, 3> low, high;
  for (std::size_t k = 0; k < 2; ++k) {
    const float size = k == 0 ? shape.lengthA : shape.lengthB;
    const Range& tube = shape.tube[k];
    const float inflation =
        0.2F * std::max(0.0F, std::max(-tube.low, tube.high) - 1) + 0.02F * shape.flat[k];
    const float least = 1 + 0.02F / size;
    low[k] = std::min(tube.low - inflation, -least);
    high[k] = std::max(tube.high + inflation, least);
    const float across = reach * length(shape.guess[k]);
    if (shape.badNormal) {
      high[k] = 1.2F * shape.flat[k] + across;
      low[k] = -high[k];
    }
    if ((sides & (k == 0 ? kSideU0 : kSideV0)) != 0) low[k] -= across;
    if ((sides & (k == 0 ? kSideU1 : kSideV1)) != 0) high[k] += across;
    if (sides != 0) {
      low[k] -= skew * across;
      high[k] += skew * across;
    }
  }
  const float sag = 0.2F * (shape.tube[2].high - shape.tube[2].low) + 0.01F;
  low[2] = shape.tube[2].low - sag - reach;
  high[2] = shape.tube[2].high + sag + reach;

  Prism prism;
  prism.origin = shape.origin;
  prism.centre = shape.c[0];
  prism.normals = {};
  const std::array<Float3, 3> along = {shape.alongA, shape.alongB, shape.normal};
  const std::array<Float3, 3> across = {shape.guess[0], shape.guess[1], shape.normal};
  for (std::size_t k = 0; k < 3 && !shape.degenerate; ++k)
    for (std::size_t x = 0; x < 3; ++x) {
      prism.centre[x] += (low[k] + high[k]) / 2 * along[k][x];
      prism.normals[k][x] = across[k][x] * 2 / (high[k] - low[k]);
    }
  for (std::size_t x = 0; x < 3; ++x) {
    float margin = 0.05F + 0.1F * (std::abs(shape.c[2][x]) + std::abs(shape.c[4][x]) +
                                   std::abs(shape.c[6][x]));
    if (shape.badNormal || sides != 0) margin += reach;
    const int axis = static_cast<int>(x);
    prism.box.min()[axis] =
        shape.origin[axis] + static_cast<int>(std::ceil(shape.box[x].low - margin));
    prism.box.max()[axis] =
        shape.origin[axis] + static_cast<int>(std::floor(shape.box[x].high + margin));
  }
  return prism;
}

void CellMaker::addNewtonCell(const Shape& shape, const ParameterBox& part, unsigned sides) {
  const Prism prism = prismOf(shape, sides);
  if (prism.box.empty()) return;
  const auto added = store_.newton.emplace_back();
  NewtonCell& cell = *added;
  cell.prism = prism;
  cell.surface = shape.c;
  cell.guess = shape.guess;
  cell.isCurve = piece_->boundarySides == kAllSides;
  cell.creaseBias = biasOf(sides);
  cell.severalStarts = shape.badNormal || shape.sine > kMostSine;
  cell.mostSteps = cell.severalStarts ? 16 : 6;
  // Small cells may be strongly curved: there a small step counts in parameters.
  constexpr float kMostStop = 0.05F;
  cell.stop = std::min(kMostStop, options_.newtonStop / std::max(shape.lengthA, shape.lengthB));
  const CornerSquare& square = piece_->square;
  cell.u = static_cast<float>(square.u + square.sideU * (part.u0 + part.u1) / 2);
  cell.v = static_cast<float>(square.v + square.sideV * (part.v0 + part.v1) / 2);
  cell.side = {static_cast<float>(square.sideU * (part.u1 - part.u0) / 2),
               static_cast<float>(square.sideV * (part.v1 - part.v0) / 2)};
  store_.bin(prism, owner(), added - store_.newton.begin(), CellKind::kNewton);
}

/// Returns false if polynomials are not precise enough.
bool CellMaker::addPolynomialCell(const Shape& shape) {
  const Prism prism = prismOf(shape, 0);
  if (prism.box.empty()) return true;
  if (store_.isFar(prism.box)) return true;
  PolynomialCell cell;
  cell.prism = prism;
  if (!fitFoot(shape.c, {shape.alongA, shape.alongB, shape.normal}, cell)) return false;
  const auto added = store_.polynomial.push_back(cell);
  store_.bin(prism, owner(), added - store_.polynomial.begin(), CellKind::kPolynomial);
  return true;
}

}  // namespace vox
