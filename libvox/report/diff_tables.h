#pragma once

#include "libvox/report/diff_report.h"

#include <string>

namespace vox {

/// True if there is something to tell: a difference, or voxels that moved within the tolerance.
bool isRemarkable(const GridDiff& grid);
bool isRemarkable(const FilePairDiff& file);

/// A few words: "The same".
std::string headingOf(const Comparison& comparison);

/// One sentence: what differs.
std::string verdictOf(const Comparison& comparison);

/// A table of the files with links to those that differ. Of more than 1,000 files it has only those
/// with something to tell.
std::string indexOf(const Comparison& comparison);

/// A table of the grids of a file, and what differs in its metadata; or why there is
/// none.
std::string tablesOf(const FilePairDiff& file);

/// What differs in a grid, as sentences and as a table of its properties and metadata.
std::string factsOf(const GridDiff& grid);

}  // namespace vox
