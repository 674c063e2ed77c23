#pragma once

#include <openvdb/openvdb.h>

// OpenVDB's library holds its trees and grids compiled. A source that makes a grid would compile
// their virtual functions again, all reading and writing of files among them, which takes longer
// than the rest of most sources. These declarations say that they are in the library.
//
// Our own targets define VOX_COMPILED_TREES (cmake/Warnings.cmake). A library that is built without
// explicit instantiation does not hold them. Without optimisation the declarations would leave out
// small functions, too, which the library has only inlined. If the linker misses a function of a
// tree or grid all the same, openvdb.cpp is the place to name it.
#if defined(VOX_COMPILED_TREES) && defined(OPENVDB_USE_EXPLICIT_INSTANTIATION) && \
    defined(__OPTIMIZE__)
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
#endif
