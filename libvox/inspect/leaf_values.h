#pragma once

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"

#include <memory>
#include <string>

namespace vox {

/// The values of a leaf. If they are in a file that is read on demand, they are in memory only as
/// long as this object lives. For leaves whose values are an array: not for masks and bools.
template <class Leaf>
class LeafValues {
 public:
  using Value = typename Leaf::ValueType;

  /// @throws InputError  the file is damaged there
  explicit LeafValues(const Leaf& leaf) {
    if (!leaf.buffer().isOutOfCore()) {
      values_ = leaf.buffer().data();
      return;
    }
    auto copy = std::make_unique<Buffer>(leaf.buffer());
    try {
      values_ = copy->data();
    } catch (const std::exception& wrong) {
      // OpenVDB leaves the buffer in a state in which it cannot be destroyed.
      static_cast<void>(copy.release());
      throw InputError(std::string("values of a grid cannot be read: ") + wrong.what());
    }
    loaded_ = std::move(copy);
  }

  /// In OpenVDB's order: z fastest.
  const Value& operator[](openvdb::Index offset) const { return values_[offset]; }
  const Value* data() const { return values_; }

 private:
  using Buffer = typename Leaf::Buffer;
  std::unique_ptr<Buffer> loaded_;
  const Value* values_ = nullptr;
};

}  // namespace vox
