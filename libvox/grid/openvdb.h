#pragma once

#include <openvdb/openvdb.h>

// The trees and grids that OpenVDB registers. Its library holds them compiled. These declarations
// keep a translation unit from compiling them again, which takes longer than most of our files.
namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

extern template class tree::Tree<BoolTree::RootNodeType>;
extern template class tree::Tree<DoubleTree::RootNodeType>;
extern template class tree::Tree<FloatTree::RootNodeType>;
extern template class tree::Tree<Int32Tree::RootNodeType>;
extern template class tree::Tree<Int64Tree::RootNodeType>;
extern template class tree::Tree<MaskTree::RootNodeType>;
extern template class tree::Tree<Vec3DTree::RootNodeType>;
extern template class tree::Tree<Vec3ITree::RootNodeType>;
extern template class tree::Tree<Vec3STree::RootNodeType>;
extern template class Grid<BoolTree>;
extern template class Grid<DoubleTree>;
extern template class Grid<FloatTree>;
extern template class Grid<Int32Tree>;
extern template class Grid<Int64Tree>;
extern template class Grid<MaskTree>;
extern template class Grid<Vec3DTree>;
extern template class Grid<Vec3ITree>;
extern template class Grid<Vec3STree>;

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb
