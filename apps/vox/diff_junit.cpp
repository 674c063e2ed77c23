// Differences as tests.

#include "apps/vox/diff_junit.h"

#include "apps/vox/diff_text.h"

#include <utility>

namespace vox::app {
namespace {

JunitCase caseOf(std::string name, bool same, std::string text) {
  if (same) return {std::move(name)};
  return {std::move(name), JunitCase::Result::kFailed, std::move(text)};
}

}  // namespace

JunitSuite suiteOf(const FileDiff& diff, const std::string& name) {
  JunitSuite suite{name, {}};
  for (const GridDiff& grid : diff.grids)
    suite.cases.push_back(caseOf(grid.name, grid.same(), textOf(grid)));
  suite.cases.push_back(
      caseOf("metadata of the file", diff.metadata.empty(), textOfMetadata(diff)));
  return suite;
}

JunitSuite suiteOf(const FolderDiff& diff, const std::string& name) {
  JunitSuite suite{name, {}};
  for (const FilePairDiff& file : diff.files) {
    suite.cases.push_back(caseOf(file.name, file.same(), textOf(file)));
    if (!file.error.empty()) suite.cases.back().result = JunitCase::Result::kError;
  }
  return suite;
}

JunitSuite suiteOfError(const std::string& error, const std::string& name) {
  return {name, {{"comparison", JunitCase::Result::kError, error}}};
}

}  // namespace vox::app
