#pragma once

#include "libvox/io/scene_file.h"
#include "libvox/options/part_options.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vox {

/// The parts of a scene. They are numbered from 1, in the order in which their faces first appear.
struct Parts {
  std::vector<std::string> names;  ///< of parts 1, 2, ..., as in the input
  /// For each object, the part of each face of its mesh.
  std::vector<std::vector<std::int32_t>> ofFaces;
};

/// Parts by groups or materials with one name are one part, also in several objects. Faces without
/// a set are a part with the name of the object. With several objects, the objects of a mesh file
/// are named "OBJECT/NAME".
/// @throws LimitError  there are 2^31 parts or more
Parts partsOf(const Scene& scene, PartBy by);

/// The first of object, group and material by which a scene has several parts; else object.
PartBy defaultPartBy(const Scene& scene);

/// Name of the metadata of the grid `part`, with the names of parts as partsJson() writes them.
inline constexpr const char* kPartsMetadata = "vox_part_names";

/// {"1": "body", "2": "wheel"}. What is no UTF-8 becomes U+FFFD.
std::string partsJson(const std::vector<std::string>& names);
/// The name without what is no UTF-8.
std::string textOfName(const std::string& name);

/// Names of grids for parts: letters, digits and _ of ASCII, no digit first; no two are equal, and
/// none is that of another grid of a conversion.
std::vector<std::string> gridNamesOfParts(const std::vector<std::string>& names);

}  // namespace vox
