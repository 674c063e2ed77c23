#pragma once

#include "apps/bench/compare.h"
#include "apps/bench/scaling.h"

#include <nlohmann/json.hpp>

#include <string>

namespace vox::bench {

/// Text tables, with a line end.
std::string tableOf(const Comparison& comparison);
std::string tableOf(const Scaling& scaling);

/// The same numbers and the commands that gave them. Seconds and bytes; null where there is none.
nlohmann::ordered_json jsonOf(const Comparison& comparison);
nlohmann::ordered_json jsonOf(const Scaling& scaling);

/// What one program took.
nlohmann::ordered_json jsonOf(const Side& side);

/// The machine that measures: its processor, number of processors and bytes of memory.
nlohmann::ordered_json machineJson();

}  // namespace vox::bench
