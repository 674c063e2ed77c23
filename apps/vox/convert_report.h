#pragma once

#include "libvox/pipeline/convert.h"

#include <string>
#include <vector>

namespace vox::app {

/// What a conversion was, for those who want to know.
struct FinishedRun {
  const Scene& scene;
  const ConvertOptions& options;
  const Conversion& conversion;
  std::string output;
  double readSeconds;
  double writeSeconds;
};

/// As JSON, for --report.
std::string reportJson(const FinishedRun& run);

/// In short, line by line, for --verbose.
std::vector<std::string> reportLines(const FinishedRun& run);

}  // namespace vox::app
