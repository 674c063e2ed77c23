#pragma once

#include "libvox/mesh/limit_piece.h"
#include "libvox/subdivide/level.h"

#include <cstdint>
#include <vector>

namespace vox {

/// The vertices of a mesh around which the limit surface is one biquadratic piece, those within
/// four quads, if the piece is small.
class WholeVertices {
 public:
  /// @param base  level 0, as for LimitWalk; it must stay valid
  explicit WholeVertices(const SubdivisionLevel& base);

  /// Whether the piece of a corner is a quarter of the piece of its vertex.
  bool contains(Index corner) const { return isWhole_[corner] != 0; }
  /// The lowest of the four corners at the vertex of a corner that is contained.
  Index firstCorner(Index corner) const;
  /// The piece of the vertex of a corner that is contained. u and v run as in the corner; the
  /// square is that of the corner, from -1 to 1.
  LimitPiece pieceAt(Index corner) const;

 private:
  const SubdivisionLevel& base_;
  std::vector<std::uint8_t> isWhole_;  // by corner
};

/// Passes on the pieces of a limit surface (LimitWalk), but for whole vertices one piece in place
/// of four. For sinks that do not ask for places.
class JoinedPieces : public LimitSink {
 public:
  JoinedPieces(const WholeVertices& whole, LimitSink& next) : whole_(whole), next_(next) {}
  void piece(const LimitPiece& piece) override;

 private:
  const WholeVertices& whole_;
  LimitSink& next_;
};

}  // namespace vox
