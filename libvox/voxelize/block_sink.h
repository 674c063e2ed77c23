#pragma once

#include "libvox/voxelize/scan.h"

#include <array>
#include <cstddef>

namespace vox::detail {

/// Collects blocks and passes them on in groups.
class BlockSink {
 public:
  BlockSink(EmitBlocks emit, void* visit) : emit_(emit), visit_(visit) {}

  /// Room to write up to `count` blocks (at most 512). take() then says how many to keep.
  VoxelBlock* room(std::size_t count) {
    if (filled_ + count > blocks_.size()) flush();
    return blocks_.data() + filled_;
  }
  /// Keeps the first `count` blocks that were written to room().
  void take(std::size_t count) { filled_ += count; }

  /// Passes on all blocks.
  void flush() {
    emit_(visit_, {blocks_.data(), filled_});
    filled_ = 0;
  }

 private:
  EmitBlocks emit_;
  void* visit_;
  std::size_t filled_ = 0;
  std::array<VoxelBlock, 512> blocks_;
};

}  // namespace vox::detail
