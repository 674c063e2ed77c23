// The extension vox._vox: the commands of vox on objects of Python. vox/__init__.py is what users
// see.

#include "apps/python/commands.h"
#include "apps/python/grid_arrays.h"
#include "apps/python/mesh_arrays.h"
#include "apps/python/run.h"
#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/version.h"
#include "libvox/grid/openvdb.h"

#include <pybind11/stl.h>

#include <algorithm>

namespace vox::python {
namespace {

namespace py = pybind11;

// Meshes and scenes

MeshHandle makeMesh(const std::string& name, const py::array& points, const py::array& offsets,
                    const py::array& corners, std::optional<py::array> pointColors,
                    std::optional<py::array> faceColors, std::optional<py::array> uv,
                    std::optional<py::array> groupsOfSmoothing, std::optional<Sets> objects,
                    std::optional<Sets> groups, std::optional<Sets> materials) {
  auto scene = std::make_shared<Scene>();
  SceneObject& object = scene->objects.emplace_back();
  object.name = name;
  object.mesh = meshOf({points, offsets, corners, std::move(pointColors), std::move(faceColors),
                        std::move(uv), std::move(groupsOfSmoothing), std::move(objects),
                        std::move(groups), std::move(materials)});
  return {std::move(scene), 0};
}

SceneHandle makeScene(const std::vector<MeshHandle>& meshes) {
  if (meshes.empty()) throw InputError("a scene needs at least one mesh");
  auto scene = std::make_shared<Scene>();
  for (const MeshHandle& mesh : meshes) scene->objects.push_back(mesh.object());
  return {std::move(scene)};
}

/// None, or the names of sets and the number of each face's set, -1 for none.
py::object setsOrNone(const FaceSets& sets) {
  if (sets.empty()) return py::none();
  py::list names;
  for (const std::string& name : sets.names) names.append(text(name));
  py::array_t<std::int64_t> numbers(static_cast<py::ssize_t>(sets.ofFaces.size()));
  std::transform(sets.ofFaces.begin(), sets.ofFaces.end(), numbers.mutable_data(),
                 [](Index set) { return set == kNone ? std::int64_t{-1} : std::int64_t{set}; });
  return py::make_tuple(names, numbers);
}

void addMeshes(py::module_& module) {
  py::class_<MeshHandle>(module, "MeshHandle")
      .def(py::init(&makeMesh))
      .def_property_readonly("name", [](const MeshHandle& m) { return text(m.object().name); })
      .def_property_readonly("points",
                             [](const MeshHandle& m) { return view(m.scene, m.mesh().points); })
      .def_property_readonly(
          "offsets", [](const MeshHandle& m) { return view(m.scene, m.mesh().faceOffsets); })
      .def_property_readonly(
          "corners", [](const MeshHandle& m) { return view(m.scene, m.mesh().faceVertices); })
      .def_property_readonly(
          "point_colors",
          [](const MeshHandle& m) { return viewOrNone(m.scene, m.mesh().pointColors); })
      .def_property_readonly(
          "face_colors",
          [](const MeshHandle& m) { return viewOrNone(m.scene, m.mesh().faceColors); })
      .def_property_readonly(
          "uv",
          [](const MeshHandle& m) { return viewOrNone(m.scene, m.mesh().attributes.texcoords); })
      .def_property_readonly(
          "smoothing_groups",
          [](const MeshHandle& m) { return viewOrNone(m.scene, m.mesh().faceGroups); })
      .def_property_readonly(
          "objects", [](const MeshHandle& m) { return setsOrNone(m.mesh().attributes.objects); })
      .def_property_readonly(
          "groups", [](const MeshHandle& m) { return setsOrNone(m.mesh().attributes.groups); })
      .def_property_readonly("materials", [](const MeshHandle& m) {
        return setsOrNone(m.mesh().attributes.materials);
      });
  py::class_<SceneHandle>(module, "SceneHandle")
      .def(py::init(&makeScene))
      .def_property_readonly("files",
                             [](const SceneHandle& s) {
                               py::list files;
                               for (const auto& file : s.scene->files)
                                 files.append(text(file.string()));
                               return files;
                             })
      .def_property_readonly("meshes", [](const SceneHandle& s) {
        std::vector<MeshHandle> meshes;
        for (std::size_t i = 0; i < s.scene->objects.size(); ++i) meshes.push_back({s.scene, i});
        return meshes;
      });
}

// Grids

/// Short work that uses no object of Python.
template <class Work>
void withoutLock(Work&& work) {
  const py::gil_scoped_release released;
  work();
}

/// A new array for values of a grid.
py::array arrayFor(const openvdb::GridBase& grid, std::vector<py::ssize_t> shape) {
  const ValueType type = valueTypeOf(grid);
  if (type.components > 1) shape.push_back(static_cast<py::ssize_t>(type.components));
  long double bytes = static_cast<long double>(type.bytes);
  for (const py::ssize_t side : shape) bytes *= static_cast<long double>(side);
  constexpr long double kMost = 1e18L;
  const MemoryBudget budget(0);
  budget.require(static_cast<std::uint64_t>(std::min(bytes, kMost)),
                 "an array of the grid " + grid.getName(), "take a smaller part of it");
  return py::array(py::dtype(type.name), shape);
}

py::array coordsOf(const GridHandle& handle) {
  const auto count = static_cast<py::ssize_t>(handle.grid->activeVoxelCount());
  constexpr std::uint64_t kBytes = 3 * sizeof(std::int32_t);
  MemoryBudget(0).require(kBytes * static_cast<std::uint64_t>(count), "an array of voxels",
                          "take a smaller part of the grid");
  py::array_t<std::int32_t> coords(std::vector<py::ssize_t>{count, 3});
  std::int32_t* const data = coords.mutable_data();
  withoutLock([&] { gatherCoords(*handle.grid, data); });
  return coords;
}

py::array valuesOf(const GridHandle& handle) {
  py::array values =
      arrayFor(*handle.grid, {static_cast<py::ssize_t>(handle.grid->activeVoxelCount())});
  void* const data = values.mutable_data();
  withoutLock([&] { gatherValues(*handle.grid, data); });
  return values;
}

py::array denseOf(const GridHandle& handle, const std::array<std::int32_t, 3>& low,
                  const std::array<std::int32_t, 3>& high) {
  const VoxelBox box{low, high};
  std::vector<py::ssize_t> shape;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    constexpr std::int32_t kFarthest = 1 << 30;
    if (low[axis] < -kFarthest || high[axis] > kFarthest)
      throw InputError("to_dense: the box reaches beyond 2^30 voxels");
    shape.push_back(static_cast<py::ssize_t>(std::max<std::int64_t>(0, box.side(axis))));
  }
  py::array values = arrayFor(*handle.grid, shape);
  if (values.size() == 0) return values;
  void* const data = values.mutable_data();
  withoutLock([&] { fillDense(*handle.grid, box, data); });
  return values;
}

py::object boundsOf(const GridHandle& handle) {
  std::optional<VoxelBox> box;
  withoutLock([&] { box = activeBox(*handle.grid); });
  if (!box) return py::none();
  return py::make_tuple(py::make_tuple(box->low[0], box->low[1], box->low[2]),
                        py::make_tuple(box->high[0], box->high[1], box->high[2]));
}

/// Voxel sizes along the axes, and the world position of voxel (0, 0, 0).
py::tuple transformOf(const GridHandle& handle) {
  const openvdb::math::Transform& transform = handle.grid->transform();
  const auto map = transform.isLinear() ? transform.baseMap()->getAffineMap() : nullptr;
  if (!map || !openvdb::math::isDiagonal(map->getMat4().getMat3()))
    throw InputError("grid " + handle.grid->getName() +
                     ": its voxels are turned or sheared, so they have no size along the axes");
  const openvdb::Mat4d matrix = map->getMat4();
  return py::make_tuple(py::make_tuple(matrix(0, 0), matrix(1, 1), matrix(2, 2)),
                        py::make_tuple(matrix(3, 0), matrix(3, 1), matrix(3, 2)));
}

py::object valueOf(const openvdb::Metadata& entry) {
  if (const auto* whole = dynamic_cast<const openvdb::Int32Metadata*>(&entry))
    return py::int_(whole->value());
  if (const auto* large = dynamic_cast<const openvdb::Int64Metadata*>(&entry))
    return py::int_(large->value());
  if (const auto* flag = dynamic_cast<const openvdb::BoolMetadata*>(&entry))
    return py::bool_(flag->value());
  if (const auto* number = dynamic_cast<const openvdb::FloatMetadata*>(&entry))
    return py::float_(number->value());
  if (const auto* exact = dynamic_cast<const openvdb::DoubleMetadata*>(&entry))
    return py::float_(exact->value());
  return text(entry.str());
}

py::dict metadataOf(const GridHandle& handle) {
  py::dict all;
  for (auto entry = handle.grid->beginMeta(); entry != handle.grid->endMeta(); ++entry)
    all[text(entry->first)] = valueOf(*entry->second);
  return all;
}

void addGrids(py::module_& module) {
  py::class_<GridHandle>(module, "GridHandle")
      .def_property_readonly("name", [](const GridHandle& g) { return text(g.name); })
      .def_property_readonly("dtype", [](const GridHandle& g) { return valueTypeOf(*g.grid).name; })
      .def_property_readonly("grid_class",
                             [](const GridHandle& g) {
                               return openvdb::GridBase::gridClassToString(g.grid->getGridClass());
                             })
      .def_property_readonly("active_voxels",
                             [](const GridHandle& g) { return g.grid->activeVoxelCount(); })
      .def_property_readonly("bounds", &boundsOf)
      .def_property_readonly("transform", &transformOf)
      .def_property_readonly("metadata", &metadataOf)
      .def("coords", &coordsOf)
      .def("values", &valuesOf)
      .def("to_dense", &denseOf);
  py::class_<GridsHandle>(module, "GridsHandle")
      .def_property_readonly("grids",
                             [](const GridsHandle& all) {
                               std::vector<GridHandle> grids;
                               for (const NamedGrid& one : all.file().grids)
                                 grids.push_back({one.name, one.grid});
                               return grids;
                             })
      .def_property_readonly("report", [](const GridsHandle& all) { return text(all.report()); })
      .def_property_readonly("warnings", [](const GridsHandle& all) { return all.warnings(); });
}

}  // namespace

PYBIND11_MODULE(_vox, module) {
  module.doc() = "The commands of vox on objects of Python. Use the package vox.";
  module.attr("__version__") = version();
  addErrors(module);
  addMeshes(module);
  addGrids(module);
  addCommands(module);
}

}  // namespace vox::python
