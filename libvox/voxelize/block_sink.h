#pragma once

#include "libvox/voxelize/scan.h"

#include <array>
#include <cstddef>

namespace vox::detail {

/// Collects blocks and hands them on many at a time.
class BlockSink {
 public:
  BlockSink(EmitBlocks emit, void* visit) : emit_(emit), visit_(visit) {}

  /// A place for `count` blocks, of which `take` keeps some.
  VoxelBlock* room(std::size_t count) {
    if (filled_ + count > blocks_.size()) flush();
    return blocks_.data() + filled_;
  }
  void take(std::size_t count) { filled_ += count; }

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
