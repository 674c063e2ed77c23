// The formats of grids by the names of files.

#include "libvox/io/grid_file.h"

#include "libvox/grid/openvdb.h"
#include "libvox/io/input_file.h"
#include "libvox/io/write_nvdb.h"
#include "libvox/io/write_vdb.h"

namespace vox {

bool isGridFile(const std::filesystem::path& file) {
  return lowerExtension(file) == ".vdb" || isNvdb(file);
}

bool isNvdb(const std::filesystem::path& file) {
  return lowerExtension(file) == ".nvdb";
}

void writeGridFile(std::iostream& stream, const std::filesystem::path& name,
                   const std::vector<openvdb::GridBase::Ptr>& grids,
                   const openvdb::MetaMap& fileMetadata, std::optional<Compression> compression) {
  if (isNvdb(name))
    writeNvdb(stream, grids, compression);
  else
    writeVdb(stream, grids, fileMetadata, compression);
}

}  // namespace vox
