#pragma once

#include "libvox/prepare/orient.h"
#include "libvox/prepare/repair.h"

#include <string>
#include <vector>

namespace vox {

/// What soundMesh did. All elements that both parts name, as origins too, are those of the input.
struct SoundReport {
  RepairReport repair;
  OrientReport orient;
};

/// A mesh that can be subdivided: repaired, then oriented. May be empty.
/// @throws MeshError, UsageError, LimitError  as repair and orient
PolygonMesh soundMesh(PolygonMesh mesh, const RepairOptions& options, SoundReport& report);

/// What was done, a line for repair and one for orientation; none where nothing was done.
std::vector<std::string> summaries(const SoundReport& report);

/// The first thing that was done: "dropped face 1, which repeats face 0"; empty if nothing was.
std::string firstAction(const SoundReport& report);

}  // namespace vox
