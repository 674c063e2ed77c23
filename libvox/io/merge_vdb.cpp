// Chooses between the parts of a conversion and other files.

#include "libvox/io/merge_vdb.h"

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/merge_parts.h"
#include "libvox/io/read_vdb.h"
#include "libvox/io/unite_grids.h"
#include "libvox/io/write_vdb.h"
#include "libvox/options/run_part.h"

#include <algorithm>
#include <iostream>
#include <iterator>
#include <utility>

namespace vox {
namespace {

/// The indices of files; those that libvox did not write have no grids.
/// @throws InputError  a file is damaged
std::vector<VdbIndex> indicesOf(const std::vector<std::filesystem::path>& files) {
  std::vector<VdbIndex> indices;
  for (const auto& file : files) {
    indices.emplace_back().file = file;
    if (isSoundOwnVdb(file)) indices.back() = readVdbIndex(file);
  }
  return indices;
}

MergeReport mergeOthers(std::iostream& stream, const std::vector<VdbIndex>& files,
                        const MergeOptions& options) {
  const VdbFile united = unitedGrids(files, options.maxMemory);
  if (united.grids.empty()) throw InputError(files[0].file.string() + ": has no grids");
  MergeReport report;
  std::vector<openvdb::GridBase::Ptr> grids;
  for (const NamedGrid& grid : united.grids) {
    grids.push_back(grid.grid);
    report.grids.push_back({grid.name, grid.grid->activeVoxelCount()});
  }
  writeVdb(stream, grids, *united.metadata);
  return report;
}

}  // namespace

MergeReport mergeVdb(std::iostream& stream, const std::vector<std::filesystem::path>& files,
                     const MergeOptions& options) {
  std::vector<VdbIndex> indices = indicesOf(files);
  const auto part = std::find_if(indices.begin(), indices.end(), isPartFile);
  for (const VdbIndex& file : indices)
    if (!file.grids.empty() && (*file.grids[0].head)[kMissingPartsMetadata])
      throw InputError(file.file.string() + ": lacks parts; merge all parts at once");
  if (part == indices.end()) return mergeOthers(stream, indices, options);
  const auto other = std::find_if_not(indices.begin(), indices.end(), isPartFile);
  if (other != indices.end())
    throw InputError(other->file.string() +
                     ": is not a part as vox convert --part writes it, but " + part->file.string() +
                     " is");
  PartFiles parts = orderedParts(std::move(indices));
  if (!parts.missing.empty() && !options.partial)
    throw InputError(parts.parts[0].file.string() + ": is one of " + std::to_string(parts.count) +
                     " parts, of which " + partsText(parts.missing) +
                     (parts.missing.size() == 1 ? " is" : " are") +
                     " missing; --partial merges the others");
  MergeReport report;
  report.grids = mergeParts(stream, parts, options.maxMemory);
  report.partCount = parts.count;
  report.missing = std::move(parts.missing);
  return report;
}

}  // namespace vox
