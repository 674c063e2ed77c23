#pragma once

#include <openvdb/version.h>

#include <cstdint>

// Declares OpenVDB's types without their definitions. Reading <openvdb/openvdb.h> takes seconds: a
// header that only names these types includes this file, a source that looks into them includes
// grid/openvdb.h. Both may come in either order.
namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

class GridBase;
class MetaMap;
class ValueMask;
template <typename TreeType>
class Grid;

namespace io {
class GridDescriptor;
}

namespace math {
class Coord;
class CoordBBox;
class Transform;
template <typename T>
class Vec3;
}  // namespace math
using math::Coord;
using math::CoordBBox;

namespace tree {
template <typename ValueType, std::uint32_t Log2Side>
class LeafNode;
template <typename ChildType, std::uint32_t Log2Side>
class InternalNode;
template <typename ChildType>
class RootNode;
template <typename RootType>
class Tree;
}  // namespace tree

template <typename ValueType>
using Tree543 = tree::Tree<
    tree::RootNode<tree::InternalNode<tree::InternalNode<tree::LeafNode<ValueType, 3>, 4>, 5>>>;
using FloatTree = Tree543<float>;
using MaskTree = Tree543<ValueMask>;
using Vec3STree = Tree543<math::Vec3<float>>;
using FloatGrid = Grid<FloatTree>;
using MaskGrid = Grid<MaskTree>;
using Vec3SGrid = Grid<Vec3STree>;

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb
