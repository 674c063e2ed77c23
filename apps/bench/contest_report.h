#pragma once

#include "apps/bench/contest.h"
#include "apps/bench/plot.h"

#include <nlohmann/json.hpp>

#include <string>

namespace vox::bench {

/// A Markdown table of medians: a row for each contender at each resolution. Ratios are to the vox
/// contender that makes the same grid.
std::string markdownOf(const Contest& contest);

/// The same numbers with the commands. Seconds and bytes; null if there is no value.
nlohmann::ordered_json jsonOf(const Contest& contest);

/// Plots of wall time and of peak memory over the resolution.
Plot timePlot(const Contest& contest);
Plot memoryPlot(const Contest& contest);

}  // namespace vox::bench
