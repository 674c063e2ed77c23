#pragma once

#include "apps/bench/contest.h"
#include "apps/bench/plot.h"

#include <nlohmann/json.hpp>

#include <string>

namespace vox::bench {

/// A Markdown table, medians: a row for each contender at each resolution. Ratios are those to what
/// vox takes for the same.
std::string markdownOf(const Contest& contest);

/// The same numbers and the commands that gave them. Seconds and bytes; null where there is none.
nlohmann::ordered_json jsonOf(const Contest& contest);

/// Wall time, and peak memory, against the resolution.
Plot timePlot(const Contest& contest);
Plot memoryPlot(const Contest& contest);

}  // namespace vox::bench
