#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/io/read_vdb.h"
#include "libvox/io/scene_file.h"
#include "libvox/pipeline/convert.h"

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

namespace vox::python {

/// A mesh: an object of a scene, which is never changed.
struct MeshHandle {
  std::shared_ptr<const Scene> scene;
  std::size_t number;

  const SceneObject& object() const { return scene->objects[number]; }
  const PolygonMesh& mesh() const { return object().mesh; }
};

struct SceneHandle {
  std::shared_ptr<const Scene> scene;
};

struct GridHandle {
  std::string name;
  std::shared_ptr<openvdb::GridBase> grid;
};

/// Grids in memory: those of a conversion, or of a file that was read.
class GridsHandle {
 public:
  GridsHandle(Conversion conversion, std::string report);
  explicit GridsHandle(VdbFile file) : file_(std::move(file)) {}

  const VdbFile& file() const { return file_; }
  /// As --report writes it; empty if the grids were read.
  const std::string& report() const { return report_; }
  pybind11::list warnings() const;

  /// Writes a new file, all or nothing.
  /// @throws IoError, UsageError
  void write(const std::string& path, bool overwrite, std::optional<Compression> compression,
             Progress& progress) const;

 private:
  VdbFile file_;
  std::optional<Conversion> conversion_;
  std::string report_;
};

/// The functions that do the work of commands.
void addCommands(pybind11::module_& module);

}  // namespace vox::python
