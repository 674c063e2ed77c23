#pragma once

#include "apps/bench/compare.h"
#include "apps/bench/scaling.h"

#include <nlohmann/json.hpp>

#include <string>

namespace vox::bench {

/// Results as text tables that end with a line end.
std::string tableOf(const Comparison& comparison);
std::string tableOf(const Scaling& scaling);

/// The same numbers with the commands. Seconds and bytes; null if there is no value.
nlohmann::ordered_json jsonOf(const Comparison& comparison);
nlohmann::ordered_json jsonOf(const Scaling& scaling);

/// Results of one program.
nlohmann::ordered_json jsonOf(const Side& side);

/// The machine that measures: its processor, number of processors and bytes of memory.
nlohmann::ordered_json machineJson();

}  // namespace vox::bench
