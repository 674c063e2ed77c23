#pragma once

#include "libvox/inspect/diff.h"
#include "libvox/inspect/diff_folders.h"
#include "libvox/io/write_junit.h"

#include <string>

namespace vox::app {

// Differences as tests. A test that fails says what vox diff prints.

/// A test for each grid, and one for the metadata of the file.
/// @param name  of the suite
JunitSuite suiteOf(const FileDiff& diff, const std::string& name);

/// A test for each file.
JunitSuite suiteOf(const FolderDiff& diff, const std::string& name);

/// A test that could not be made.
JunitSuite suiteOfError(const std::string& error, const std::string& name);

}  // namespace vox::app
