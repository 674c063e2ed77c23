#pragma once

#include "libvox/report/diff_report.h"

#include <string>

namespace vox {

/// One sentence: what differs.
std::string verdictOf(const Comparison& comparison);

/// A table of all files with links to those that differ.
std::string indexOf(const Comparison& comparison);

/// A table of the grids of a file, and what differs in its metadata; or why there is
/// none.
std::string tablesOf(const FilePairDiff& file);

/// What differs in a grid, as sentences and as a table of its properties and metadata.
std::string factsOf(const GridDiff& grid);

}  // namespace vox
