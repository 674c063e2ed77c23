#pragma once

#include "libvox/io/scene_file.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vox::python {

/// Names of sets of faces, and for each face the number of its set, or -1.
using Sets = std::pair<std::vector<std::string>, pybind11::array>;

/// Arrays of a mesh, as vox/_arrays.py brings them into form: contiguous, of native byte order.
struct MeshArrays {
  pybind11::array points;                      ///< (V, 3) float32 or float64
  pybind11::array faceOffsets;                 ///< (F + 1,) int32, uint32, int64 or uint64
  pybind11::array faceVertices;                ///< (C,) the same
  std::optional<pybind11::array> pointColors;  ///< (V, 3) floats, linear; or uint8, sRGB
  std::optional<pybind11::array> faceColors;   ///< (F, 3) the same
  std::optional<pybind11::array> texcoords;    ///< (C, 2) floats; NaN: none
  std::optional<pybind11::array> faceGroups;   ///< (F,) integers
  std::optional<Sets> objects, groups, materials;
};

/// Copies arrays into a mesh. Nothing about them is trusted.
/// @throws MeshError   an element is wrong; the message names it
/// @throws InputError  an array has a wrong shape or type
/// @throws LimitError  there are too many elements
PolygonMesh meshOf(const MeshArrays& arrays);

/// Copies numbers of vertices, flat.
/// @param name  of the argument, for messages
/// @throws InputError  one is negative or too large
std::vector<Index> indicesOf(const char* name, const pybind11::array& array);

// Arrays that show the memory of a mesh, without a copy. They cannot be changed, and keep the scene
// alive.

using SharedScene = std::shared_ptr<const Scene>;

pybind11::array view(const SharedScene& owner, const std::vector<Vec3d>& rows);
pybind11::object viewOrNone(const SharedScene& owner, const std::vector<Vec3f>& rows);
pybind11::object viewOrNone(const SharedScene& owner, const std::vector<Vec2f>& rows);
pybind11::array view(const SharedScene& owner, const std::vector<Index>& numbers);
pybind11::object viewOrNone(const SharedScene& owner, const std::vector<Index>& numbers);

}  // namespace vox::python
