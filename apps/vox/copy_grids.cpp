// vox convert from one format of grids to another.

#include "apps/vox/copy_grids.h"

#include "apps/vox/counted.h"
#include "apps/vox/options.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/grid_file.h"
#include "libvox/io/read_vdb.h"
#include "libvox/io/scene_file.h"

#include <iostream>
#include <memory>
#include <sstream>
#include <vector>

namespace vox::app {

void copyGrids(const std::string& input, const std::string& output,
               std::optional<Compression> compression, const CommonOptions& common) {
  Scene files;
  files.files = {input};
  requireOutput(output, common, files);
  onThreads(common.run.threads, [&] {
    const VdbFile file = readVdb(input);
    std::vector<std::shared_ptr<openvdb::GridBase>> grids;
    for (const NamedGrid& grid : file.grids) grids.push_back(grid.grid);
    if (isStdout(output)) {
      std::stringstream bytes(std::ios::in | std::ios::out | std::ios::binary);
      writeGridFile(bytes, output, grids, *file.metadata, compression);
      std::cout << bytes.view();
      return;
    }
    AtomicFile target(output, common.force);
    writeGridFile(target.stream(), output, grids, *file.metadata, compression);
    target.commit();
    say(common, output + ": " + counted(grids.size(), "grid"));
  });
}

}  // namespace vox::app
