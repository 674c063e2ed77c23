#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/inspect/diff.h"
#include "libvox/inspect/leaf_values.h"
#include "libvox/inspect/topology.h"
#include "libvox/inspect/tree_pair.h"
#include "libvox/io/read_vdb.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <type_traits>

namespace vox {

/// Whether a grid is to be compared.
bool isChosen(const std::string& name, const DiffOptions& options);

/// Calls visit(name, a, b) for each grid to compare, in order of names. If only one of the files
/// has a grid of that name, the other argument is null.
/// @throws InputError  a name of options.onlyGrids is in neither
using VisitPair = std::function<void(const std::string& name, const openvdb::GridBase::Ptr& a,
                                     const openvdb::GridBase::Ptr& b)>;
void forEachPair(const VdbFile& a, const VdbFile& b, const DiffOptions& options,
                 const VisitPair& visit);

struct Tolerance {
  double absolute;
  double relative;

  /// @throws UsageError  one is negative or not finite
  explicit Tolerance(const DiffOptions& options);
};

/// How far apart two values are, and if that is more than the tolerance.
struct Difference {
  double size = 0;
  bool counts = false;
};

template <class Value>
Difference differenceOf(const Value& a, const Value& b, const Tolerance& tolerance) {
  if constexpr (openvdb::VecTraits<Value>::IsVec) {
    Difference most;
    for (int i = 0; i < openvdb::VecTraits<Value>::Size; ++i) {
      const Difference one = differenceOf(a[i], b[i], tolerance);
      most = {std::max(most.size, one.size), most.counts || one.counts};
    }
    return most;
  } else {
    if (a == b) return {};
    const auto x = static_cast<long double>(a);  // holds 64-bit integers
    const auto y = static_cast<long double>(b);
    if (std::isnan(x) && std::isnan(y)) return {};
    const auto size = static_cast<double>(std::abs(x - y));
    if (!std::isfinite(size)) return {std::numeric_limits<double>::infinity(), true};
    const auto larger = static_cast<double>(std::max(std::abs(x), std::abs(y)));
    return {size, size > tolerance.absolute + tolerance.relative * larger};
  }
}

/// The values of a leaf; if there is no leaf, the one value of the region.
template <class Leaf>
class RegionValues {
 public:
  using Value = typename Leaf::ValueType;
  explicit RegionValues(const Region<Leaf>& region) : region_(region) {
    if constexpr (!std::is_same_v<Value, bool>)
      if (region.node != nullptr) loaded_.emplace(*region.node);
  }
  Value operator[](openvdb::Index offset) const {
    if (region_.node == nullptr) return region_.value;
    if constexpr (std::is_same_v<Value, bool>)
      return region_.node->getValue(offset);
    else
      return (*loaded_)[offset];
  }
  bool sameBitsAs(const RegionValues& other) const {
    if constexpr (std::is_same_v<Value, bool>)
      return false;
    else
      return loaded_ && other.loaded_ &&
             std::memcmp(loaded_->data(), other.loaded_->data(), Leaf::SIZE * sizeof(Value)) == 0;
  }

 private:
  struct Nothing {};
  const Region<Leaf>& region_;
  std::conditional_t<std::is_same_v<Value, bool>, Nothing, std::optional<LeafValues<Leaf>>> loaded_;
};

}  // namespace vox
