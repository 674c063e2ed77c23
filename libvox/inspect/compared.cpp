// Pairs of grids to compare, and tolerances.

#include "libvox/inspect/compared.h"

#include "libvox/core/error.h"

#include <map>
#include <string>
#include <utility>

namespace vox {

Tolerance::Tolerance(const DiffOptions& options)
    : absolute(options.absoluteTolerance), relative(options.relativeTolerance) {
  for (const double tolerance : {absolute, relative, options.voxelTolerance})
    if (!(tolerance >= 0 && std::isfinite(tolerance)))
      throw UsageError("a tolerance must be a number of at least 0, not " +
                       std::to_string(tolerance));
}

bool isChosen(const std::string& name, const DiffOptions& options) {
  const auto& only = options.onlyGrids;
  return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
}

void forEachPair(const VdbFile& a, const VdbFile& b, const DiffOptions& options,
                 const VisitPair& visit) {
  std::map<std::string, std::pair<openvdb::GridBase::Ptr, openvdb::GridBase::Ptr>> pairs;
  for (const NamedGrid& named : a.grids) pairs[named.name].first = named.grid;
  for (const NamedGrid& named : b.grids) pairs[named.name].second = named.grid;
  for (const std::string& name : options.onlyGrids)
    if (!options.gridsMayLack && !pairs.contains(name))
      throw InputError("neither file has a grid '" + name + "'");
  for (const auto& [name, grids] : pairs)
    if (isChosen(name, options)) visit(name, grids.first, grids.second);
}

}  // namespace vox
