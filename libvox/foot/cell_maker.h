#pragma once

#include "libvox/foot/cell.h"
#include "libvox/foot/ribbon.h"
#include "libvox/mesh/limit_piece.h"

#include <cstdint>

namespace vox {

struct CellOptions {
  float reach = 3;          ///< largest distance of interest, voxels
  bool polynomials = true;  ///< make polynomial cells and heights where they are precise enough
  double heightTolerance = 0.01;  ///< of heights, voxels
  PieceTolerance tolerance = {.small = 0.02, .large = 0.003};
  float newtonStop = 0.15F;  ///< a shorter step of Newton's method is the last one, voxels
  bool creases = false;      ///< boundary sides are sides of creases (DESIGN section 19)
  bool places = true;        ///< cells need their places; without them there are fewer cells
};

/// Cuts pieces of the limit surface into cells. One object per thread.
/// Source: DESIGN section 18.
class CellMaker : public LimitSink {
 public:
  /// @param firstOwner  added to the numbers of corners, so that several surfaces differ
  CellMaker(const CellOptions& options, std::uint32_t firstOwner, CellStore& store)
      : options_(options), firstOwner_(firstOwner), store_(store) {}

  void piece(const LimitPiece& piece) override;

 private:
  struct Shape;

  bool isFar(const LimitPiece& piece) const;
  void makeCell(const ParameterBox& part, unsigned sides, int depth);
  void splitCell(const ParameterBox& part, unsigned sides, int depth, bool alongU);
  Prism prismOf(const Shape& shape, unsigned sides) const;
  void addNewtonCell(const Shape& shape, const ParameterBox& part, unsigned sides);
  bool addPolynomialCell(const Shape& shape);
  float biasOf(unsigned sides) const;
  std::uint32_t owner() const { return firstOwner_ + piece_->square.corner; }

  CellOptions options_;
  std::uint32_t firstOwner_;
  CellStore& store_;
  const LimitPiece* piece_ = nullptr;
  Ribbon ribbon_;
};

}  // namespace vox
