#pragma once

#include "libvox/io/read_report.h"
#include "libvox/mesh/polygon_mesh.h"

#include <filesystem>

namespace vox {

/// Reads the material files that a mesh file names, and gives the mesh the looks of its materials.
/// Nothing that is wrong with them is an error, since only colours need them: it is noted in
/// report.materialProblems.
/// @param meshFile  its folder is that of the material files
/// @param report    of the mesh; the paths of the files that were read are added to its companions
/// @throws LimitError  a file is larger than the available memory
void readMaterials(const std::filesystem::path& meshFile, PolygonMesh& mesh, ReadReport& report);

}  // namespace vox
