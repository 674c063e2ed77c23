// The limit surface as pieces: regular vertices, rings around extraordinary faces, and what closes
// the rings.

#include "libvox/subdivide/limit_walk.h"

#include "libvox/mesh/chaikin.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vox {
namespace {

/// The fourth corner of a quad with a given centroid.
Vec3d fourthCorner(const Vec3d& centroid, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return 4.0 * centroid - a - b - c;
}

/// How much a shift along the surface counts as an error. Corners of a face may end at different
/// levels, and then their pieces leave a gap as wide as the shift. Beside flat faces with sharp
/// edges only the gap itself tells; elsewhere it stays below what cells cover, as measured.
double alongWeightOf(const SubdivisionLevel& base) {
  constexpr double kWeight = 0.15;
  return base.seam.empty() ? 0 : kWeight;
}

/// Bound of the distance, along the normal, between the surface and a piece that treats a face as a
/// quad. It follows from how much the next vertex in the face differs from the one in the quad.
/// @param inF    whether the face is the one at u = v = 1, else the one at u = v = 0
/// @param image  the next vertex in the face
/// @param faceSize  of the face
/// @param weightAlong  of a shift along the surface (alongWeightOf)
double errorAsQuad(const Patch& patch, bool inF, const Vec3d& image, std::size_t faceSize,
                   double weightAlong) {
  // Differences fall by 4 from level to level around small faces, by 2 around large ones.
  constexpr std::size_t kLarge = 7;
  const double perDifference = faceSize < kLarge ? 0.6 : 2;
  const auto& p = patch.points;
  const Vec3d& far = inF ? p[2][2] : p[0][0];
  const Vec3d& a = inF ? p[2][1] : p[0][1];
  const Vec3d& b = inF ? p[1][2] : p[1][0];
  const Vec3d difference = image - quadImage(p[1][1], a, b, far);
  const auto along = [&](const Vec3d& n) {
    const double size = n.norm();
    return size > 0 ? std::abs(n.dot(difference)) / size : difference.norm();
  };
  // A shift along the surface is an error as far as the normal turns: so all normals count, at the
  // vertex and in the four quads around it.
  double largest = along((p[2][1] - p[0][1]).cross(p[1][2] - p[1][0]));
  for (const std::size_t u : {0U, 1U})
    for (const std::size_t v : {0U, 1U})
      largest =
          std::max(largest, along((p[u + 1][v + 1] - p[u][v]).cross(p[u][v + 1] - p[u + 1][v])));
  return perDifference * std::max(largest, weightAlong * difference.norm());
}

/// The tolerance of the pieces of a vertex of level 1.
double toleranceOf(const Patch& patch, const PieceTolerance& tolerance) {
  constexpr double kMostSquare = kSmallPiece * kSmallPiece;
  const auto& p = patch.points;
  const bool isSmall = ((p[2][1] - p[0][1]) / 2.0).squaredNorm() <= kMostSquare &&
                       ((p[1][2] - p[1][0]) / 2.0).squaredNorm() <= kMostSquare;
  return isSmall ? tolerance.small : tolerance.large;
}

/// Emits the piece of a regular vertex. If faces around the vertex are missing: the curves between
/// those that exist, to which its descendants converge, as pieces of hardly any width; so they have
/// normals.
void emitPiece(const Patch& patch, std::uint8_t sides, const CornerSquare& square,
               LimitSink& sink) {
  if (patch.quadrants == kAllQuadrants) return sink.piece({patch.points, sides, square});
  constexpr double kWidth = 1e-4;  // of the faces
  const auto& p = patch.points;
  const auto has = [&](unsigned quadrants) { return (patch.quadrants & quadrants) == quadrants; };
  /// @param narrowU, narrowV  whether the piece has no width along u, v
  /// @param u, v              its middle, 0 or 1 where it has no width
  const auto emitNarrow = [&](bool narrowU, std::size_t u, bool narrowV, std::size_t v) {
    const auto along = [&](bool narrow, std::size_t at, std::size_t i, const auto& point) -> Vec3d {
      if (!narrow) return point(i);
      const Vec3d across = point(at + 1) - point(at);
      return middle(point(at), point(at + 1)) + (static_cast<double>(i) - 1) * kWidth * across;
    };
    LimitPiece piece{{}, kAllSides, square};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        piece.points[i][j] = along(narrowU, u, i, [&](std::size_t k) -> Vec3d {
          return along(narrowV, v, j, [&](std::size_t l) -> Vec3d { return p[k][l]; });
        });
    sink.piece(piece);
  };
  if (has(1U | 2U)) emitNarrow(true, 0, false, 0);
  if (has(4U | 8U)) emitNarrow(true, 1, false, 0);
  if (has(1U | 4U)) emitNarrow(false, 0, true, 0);
  if (has(2U | 8U)) emitNarrow(false, 0, true, 1);
  if (patch.quadrants == 8U) emitNarrow(true, 1, true, 1);
}

/// Emits the pieces of a vertex.
class Pieces {
 public:
  /// @param sides  of the square of the vertex that lie on the boundary of the surface
  Pieces(std::uint8_t sides, double tolerance, double weightAlong, LimitSink& sink)
      : sides_(sides), tolerance_(tolerance), weightAlong_(weightAlong), sink_(sink) {}

  void regular(const Patch& patch, int /*level*/, const CornerSquare& square) {
    emitPiece(patch, sidesOf(square), square, sink_);
  }

  bool ends(const FaceCorner& corner, int level, const CornerSquare& square) {
    Patch patch = corner.around;
    auto& p = patch.points;
    p[2][2] = fourthCorner(corner.face.shape(level).centroid, p[1][1], p[2][1], p[1][2]);
    if (errorAsQuad(patch, true, corner.face.corners(level + 1)[corner.place], corner.face.size(),
                    weightAlong_) > tolerance_)
      return false;
    regular(patch, level, square);
    return true;
  }

  /// The rest is closed by a piece that treats the triangle as a quad with the vertex at two
  /// corners.
  bool ends(const BoundaryCorner& corner, int level, const CornerSquare& square) {
    constexpr double kSmall = 0.005;  // voxels, also along the surface: there it ends
    const Vec3d difference = (corner.u - middle(corner.mStart, corner.mEnd)) / 4.0;
    if (difference.norm() >= kSmall) return false;
    regular(corner.around(), level, square);
    return true;
  }

 private:
  /// The sides of a part of the square that lie on the boundary of the surface.
  std::uint8_t sidesOf(const CornerSquare& square) const {
    const auto alongBoundary = [&](double at, unsigned low, unsigned high) {
      return (at == 0 && (sides_ & low) != 0) || (at == 1 && (sides_ & high) != 0);
    };
    const auto side = [](bool is, unsigned which) { return is ? which : 0U; };
    return static_cast<std::uint8_t>(
        side(alongBoundary(square.u, kSideU0, kSideU1), kSideU0) |
        side(alongBoundary(square.u + square.sideU, kSideU0, kSideU1), kSideU1) |
        side(alongBoundary(square.v, kSideV0, kSideV1), kSideV0) |
        side(alongBoundary(square.v + square.sideV, kSideV0, kSideV1), kSideV1));
  }

  std::uint8_t sides_;
  double tolerance_;
  double weightAlong_;
  LimitSink& sink_;
};

}  // namespace

void LimitWalk::emit(std::span<const Index> faces, LimitSink& sink) {
  vertices_.set(faces);
  vertices_.images().forEachFace([&](const SubmeshCorner& first) {
    for (Index i = 0; i < first.size; ++i) emitVertex(first.at(i), sink);
  });
}

void LimitWalk::emitVertex(const SubmeshCorner& at, LimitSink& sink) {
  const LevelOneVertex vertex = vertices_.at(at);
  const double weightAlong = alongWeightOf(base());
  const double tolerance = toleranceOf(vertex.around, tolerance_);
  Pieces pieces(boundarySidesAt(at), tolerance, weightAlong, sink);
  const CornerSquare square{at.number};
  if (vertex.regular) return pieces.regular(vertex.around, 1, square);

  // Treats faces that are not quads as quads.
  Patch patch = vertex.around;
  auto& p = patch.points;
  const bool quadF = vertex.face->size() == 4;
  const bool quadVFace = vertex.vFace == nullptr || vertex.vFace->size() == 4;
  if (!quadF) p[2][2] = fourthCorner(vertex.face->shape(1).centroid, p[1][1], p[2][1], p[1][2]);
  if (!quadVFace)
    p[0][0] = fourthCorner(vertex.vFace->shape(1).centroid, p[1][1], p[0][1], p[1][0]);
  const auto near = [&](bool inF, FaceLevels& face, std::size_t place) {
    return errorAsQuad(patch, inF, face.corners(2)[place], face.size(), weightAlong) <= tolerance;
  };
  if (!vertex.triangle && (quadF || near(true, *vertex.face, vertex.place)) &&
      (quadVFace || near(false, *vertex.vFace, vertex.placeInVFace)))
    pieces.regular(patch, 1, square);
  else
    Descent(pieces).below(vertex, square);
}

/// An extended surface ends in the middle of the faces beyond its boundary edges. Another one ends
/// where the neighbours of a vertex lack faces.
std::uint8_t LimitWalk::boundarySidesAt(const SubmeshCorner& at) const {
  const LocalImages& images = vertices_.images();
  unsigned sides = 0;
  if (images.extends()) {
    if (!images.edgeFace(at.slot()).interior) sides |= kSideV0;
    if (!images.edgeFace(at.previousSlot()).interior) sides |= kSideU0;
  } else {
    if (!images.vFace(at.nextSlot()).closed) sides |= kSideU1;
    if (!images.vFace(at.previousSlot()).closed) sides |= kSideV1;
  }
  return static_cast<std::uint8_t>(sides);
}

}  // namespace vox
