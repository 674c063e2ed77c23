#pragma once

#include "libvox/io/gltf_file.h"
#include "libvox/io/read_report.h"
#include "libvox/io/unique_names.h"
#include "libvox/mesh/material.h"
#include "libvox/mesh/mesh_attributes.h"

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vox {

/// The materials of a glTF file that faces use: base colours and their images. What is wrong with
/// one is no error, but a line in report.materialProblems.
class GltfMaterials {
 public:
  GltfMaterials(GltfFile& file, ReadReport& report) : file_(file), report_(report) {}

  /// Number of a material among those that were asked for.
  /// @throws InputError  the file has no such material
  Index numberOf(const GltfValue& material);

  /// Names and looks of the materials, by number.
  const std::vector<Material>& looks() const { return looks_; }

 private:
  void read(const GltfValue& material, Material& look);
  ImageMap mapOf(const GltfValue& textureInfo);
  void setImage(const GltfValue& image, ImageMap& map);

  GltfFile& file_;
  ReadReport& report_;
  std::map<std::string, Index> numbers_;  // by place
  std::vector<Material> looks_;
  UniqueNames names_;
  /// Of images, by the bytes that store them: several images may be stored in one place.
  std::map<std::pair<const char*, std::size_t>, std::shared_ptr<const std::string>> contents_;
};

}  // namespace vox
