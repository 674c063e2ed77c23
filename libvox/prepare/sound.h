#pragma once

#include "libvox/prepare/orient.h"
#include "libvox/prepare/repair.h"

#include <string>

namespace vox {

/// What soundMesh did. All elements that both parts name, as origins too, are those of the input.
struct SoundReport {
  RepairReport repair;
  OrientReport orient;
};

/// A mesh that can be subdivided: repaired, then oriented. May be empty. Copies of points and faces
/// have the colours of what they copy; points that are welded, the mean of theirs.
/// @throws MeshError, UsageError, LimitError  as repair and orient
PolygonMesh soundMesh(PolygonMesh mesh, const RepairOptions& options, SoundReport& report);

/// One line: "dropped 2 duplicate faces, flipped 12 faces"; empty if nothing was done.
std::string summary(const SoundReport& report);

/// The first thing that was done: "dropped face 1, which repeats face 0"; empty if nothing was.
std::string firstAction(const SoundReport& report);

}  // namespace vox
