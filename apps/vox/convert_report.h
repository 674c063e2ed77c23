#pragma once

#include "libvox/pipeline/convert.h"

#include <string>
#include <vector>

namespace vox::app {

/// A conversion and its times.
struct FinishedRun {
  const Scene& scene;
  const ConvertOptions& options;
  const Conversion& conversion;
  std::string output;
  double readSeconds;
  double writeSeconds;
};

/// Report as JSON, for --report.
std::string reportJson(const FinishedRun& run);

/// Short report, line by line, for --verbose.
std::vector<std::string> reportLines(const FinishedRun& run);

}  // namespace vox::app
