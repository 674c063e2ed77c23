// Cubic polynomials for distance and foot: least squares at 4 x 4 x 3 Chebyshev nodes of a prism.

// Highway compiles this file once per instruction set, between HWY_BEFORE_ and HWY_AFTER_NAMESPACE.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libvox/foot/foot_fit.cpp"
#include "libvox/foot/foot_fit.h"

#include <Eigen/Cholesky>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// clang-format off
#include "libvox/foot/newton-inl.h"  // after foreach_target.h: once per instruction set
// clang-format on

#include <algorithm>
#include <array>
#include <cmath>

#ifndef VOX_FOOT_FIT_SHARED
#define VOX_FOOT_FIT_SHARED
namespace vox {
namespace {

constexpr float kDistanceError = 0.002F;  // voxels
constexpr float kLateralError = 0.02F;    // voxels
constexpr float kUnsolved = 0.01F;        // last step of Newton's method, voxels

constexpr std::size_t kNodes = 48;
constexpr std::size_t kTerms = 19;  // all but ZZZ: three nodes along Z do not tell it from Z

/// The term that each of the terms 1 .. ZZ becomes when multiplied by X, Y or Z.
constexpr std::array<std::array<std::size_t, 10>, 3> kTimes = {
    {{1, 4, 5, 6, 10, 11, 12, 13, 14, 15},
     {2, 5, 7, 8, 11, 13, 14, 16, 17, 18},
     {3, 6, 8, 9, 12, 14, 15, 17, 18, 19}}};

using Terms = std::array<float, 20>;

/// The nodes in -1 .. 1, the terms there, and the matrix of the least squares.
struct FitTables {
  using Nodes = std::array<float, kNodes>;
  alignas(64) std::array<Nodes, 3> node;
  alignas(64) std::array<Nodes, kTerms> terms;
  std::array<std::array<float, kTerms>, kNodes> solve;

  FitTables() {
    // Chebyshev nodes: cosines of pi / 8, 3 pi / 8 and pi / 6. Square roots are exact everywhere.
    const double outer = std::sqrt(2 + std::sqrt(2.0)) / 2,
                 inner = std::sqrt(2 - std::sqrt(2.0)) / 2;
    const std::array<double, 4> four = {-outer, -inner, inner, outer};
    const std::array<double, 3> three = {-std::sqrt(3.0) / 2, 0, std::sqrt(3.0) / 2};
    Eigen::Matrix<double, kNodes, kTerms> matrix;
    for (std::size_t k = 0; k < kNodes; ++k) {
      const std::array<double, 3> at = {four[k % 4], four[k / 4 % 4], three[k / 16]};
      std::array<double, 20> value;
      value[0] = 1;
      for (std::size_t i = 0; i < 10; ++i)
        for (std::size_t d = 0; d < 3; ++d) value[kTimes[d][i]] = value[i] * at[d];
      for (std::size_t d = 0; d < 3; ++d) node[d][k] = static_cast<float>(at[d]);
      for (std::size_t i = 0; i < kTerms; ++i) {
        terms[i][k] = static_cast<float>(value[i]);
        matrix(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = value[i];
      }
    }
    const Eigen::Matrix<double, kTerms, kNodes> inverse =
        (matrix.transpose() * matrix).ldlt().solve(matrix.transpose());
    for (std::size_t k = 0; k < kNodes; ++k)
      for (std::size_t i = 0; i < kTerms; ++i)
        solve[k][i] =
            static_cast<float>(inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
  }
};
const FitTables kFit;

/// Distance, a and b at the nodes, less what they would be for a flat surface.
struct NodeValues {
  alignas(64) std::array<FitTables::Nodes, 3> value;
  float unsolved = 0;  // largest last step, in parameters
};

/// Half widths and middle of a prism along its frame.
struct PrismFrame {
  std::array<Float3, 3> axes;
  Float3 half, middle;

  PrismFrame(const Prism& prism, const Float3& surfaceMiddle, const std::array<Float3, 3>& frame)
      : axes(frame) {
    Float3 shift;
    for (std::size_t x = 0; x < 3; ++x) shift[x] = prism.centre[x] - surfaceMiddle[x];
    for (std::size_t k = 0; k < 3; ++k) {
      half[k] = 1 / dot(prism.normals[k], frame[k]);
      middle[k] = half[k] * dot(prism.normals[k], shift);
    }
  }
};

/// Puts linear functions of x, y, z in the place of X, Y, Z.
Terms substituted(const Terms& k, const std::array<Float3, 3>& linear) {
  const auto addTimes = [&](const auto& from, std::size_t count, const Float3& times, auto& to) {
    for (std::size_t m = 0; m < count; ++m)
      for (std::size_t d = 0; d < 3; ++d) to[kTimes[d][m]] += times[d] * from[m];
  };
  // Horner's scheme: X (k1 + X (k4 + ...) + Y (k5 + ...) ...) + ...
  const auto affine = [&](float constant, float x, float y, float z) {
    std::array<float, 4> f{constant, 0, 0, 0};
    for (std::size_t d = 0; d < 3; ++d)
      f[1 + d] = x * linear[0][d] + y * linear[1][d] + z * linear[2][d];
    return f;
  };
  std::array<std::array<float, 10>, 3> quadratic{};
  quadratic[0][0] = k[1];
  quadratic[1][0] = k[2];
  quadratic[2][0] = k[3];
  addTimes(affine(k[4], k[10], k[11], k[12]), 4, linear[0], quadratic[0]);
  addTimes(affine(k[5], 0, k[13], k[14]), 4, linear[1], quadratic[0]);
  addTimes(affine(k[6], 0, 0, k[15]), 4, linear[2], quadratic[0]);
  addTimes(affine(k[7], 0, k[16], k[17]), 4, linear[1], quadratic[1]);
  addTimes(affine(k[8], 0, 0, k[18]), 4, linear[2], quadratic[1]);
  addTimes(affine(k[9], 0, 0, k[19]), 4, linear[2], quadratic[2]);
  Terms all{};
  all[0] = k[0];
  for (std::size_t i = 0; i < 3; ++i) addTimes(quadratic[i], 10, linear[i], all);
  return all;
}

}  // namespace
}  // namespace vox
#endif

HWY_BEFORE_NAMESPACE();
namespace vox::HWY_NAMESPACE {

/// Distances and feet of the nodes.
void solveNodes(const Biquadratic& surface, const PrismFrame& frame, NodeValues& values) {
  const D d;
  constexpr float kFarthest = 2.5F;
  const std::size_t lanes = hn::Lanes(d);
  V unsolved = hn::Zero(d);
  for (std::size_t k = 0; k < kNodes; k += lanes) {
    V3 at;
    for (std::size_t i = 0; i < 3; ++i)
      at[i] =
          mulAdd(hn::Load(d, kFit.node[i].data() + k), set(frame.half[i]), set(frame.middle[i]));
    V3 x;
    for (std::size_t i = 0; i < 3; ++i)
      x[i] = mulAdd(at[0], set(frame.axes[0][i]),
                    mulAdd(at[1], set(frame.axes[1][i]),
                           mulAdd(at[2], set(frame.axes[2][i]), set(surface[0][i]))));
    V a = at[0];
    V b = at[1];
    newtonStep(surface, x, set(kFarthest), a, b);
    newtonStep(surface, x, set(kFarthest), a, b);
    unsolved = hn::Max(unsolved, newtonStep(surface, x, set(kFarthest), a, b));
    JetV jet;
    jetAt(surface, a, b, jet);
    const V3 n = cross3(jet.sa, jet.sb);
    const V3 r = {hn::Sub(x[0], jet.s[0]), hn::Sub(x[1], jet.s[1]), hn::Sub(x[2], jet.s[2])};
    const V t = hn::Div(dot3(r, n), hn::Sqrt(hn::Max(dot3(n, n), set(1e-30F))));
    hn::Store(hn::Sub(t, at[2]), d, values.value[0].data() + k);
    hn::Store(hn::Sub(a, at[0]), d, values.value[1].data() + k);
    hn::Store(hn::Sub(b, at[1]), d, values.value[2].data() + k);
  }
  values.unsolved = hn::GetLane(hn::MaxOfLanes(d, unsolved));
}

/// Largest difference between a polynomial and its values.
float residualOf(const Terms& terms, const FitTables::Nodes& value) {
  const D d;
  V most = hn::Zero(d);
  for (std::size_t k = 0; k < kNodes; k += hn::Lanes(d)) {
    V rest = hn::Load(d, value.data() + k);
    for (std::size_t m = 0; m < kTerms; ++m)
      rest = hn::Sub(rest, hn::Mul(set(terms[m]), hn::Load(d, kFit.terms[m].data() + k)));
    most = hn::Max(most, hn::Abs(rest));
  }
  return hn::GetLane(hn::MaxOfLanes(d, most));
}

}  // namespace vox::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {
namespace {

HWY_EXPORT(solveNodes);
HWY_EXPORT(residualOf);

}  // namespace

bool fitFoot(const Biquadratic& surface, const std::array<Float3, 3>& frameAxes,
             PolynomialCell& cell) {
  const PrismFrame frame(cell.prism, surface[0], frameAxes);
  NodeValues nodes;
  HWY_DYNAMIC_DISPATCH(solveNodes)(surface, frame, nodes);
  const float lengthA = length(frameAxes[0]);
  const float lengthB = length(frameAxes[1]);
  if (!(nodes.unsolved * std::max(lengthA, lengthB) < kUnsolved)) return false;
  std::array<Terms, 3> terms{};
  for (std::size_t f = 0; f < 3; ++f)
    for (std::size_t k = 0; k < kNodes; ++k)
      for (std::size_t i = 0; i < kTerms; ++i) terms[f][i] += nodes.value[f][k] * kFit.solve[k][i];
  std::array<float, 3> residual;
  for (std::size_t f = 0; f < 3; ++f)
    residual[f] = HWY_DYNAMIC_DISPATCH(residualOf)(terms[f], nodes.value[f]);
  if (!(residual[0] <= kDistanceError) ||
      !(std::max(residual[1] * lengthA, residual[2] * lengthB) <= kLateralError))
    return false;
  // What a flat surface has: t along the normal, a and b along the other two.
  const std::array<std::size_t, 3> axis = {2, 0, 1};
  for (std::size_t f = 0; f < 3; ++f) {
    terms[f][0] += frame.middle[axis[f]];
    terms[f][1 + axis[f]] += frame.half[axis[f]];
    cell.terms[f] = substituted(terms[f], cell.prism.normals);
  }
  cell.limitA = 1 + 2 * residual[1] + 0.005F / lengthA;
  cell.limitB = 1 + 2 * residual[2] + 0.005F / lengthB;
  return true;
}

}  // namespace vox
#endif
