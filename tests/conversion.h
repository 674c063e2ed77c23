#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/convert.h"

#include <ios>
#include <sstream>
#include <string>

namespace vox::test {

/// The first grid of a conversion.
inline const openvdb::MaskGrid& maskOf(const Conversion& conversion) {
  return dynamic_cast<const openvdb::MaskGrid&>(*conversion.grids.at(0));
}
inline const openvdb::Vec3SGrid& colorOf(const Conversion& conversion) {
  return dynamic_cast<const openvdb::Vec3SGrid&>(*conversion.grids.at(0));
}

/// The bytes of its file.
inline std::string bytesOf(const Conversion& conversion) {
  std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
  writeGrids(stream, conversion);
  return stream.str();
}

}  // namespace vox::test
