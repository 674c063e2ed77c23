#pragma once

#include "libvox/prepare/orient.h"
#include "libvox/prepare/repair.h"

#include <string>

namespace vox {

/// Changes that soundMesh made. Both parts name elements of the input, also as origins. The joints
/// of `repair` are used up.
struct SoundReport {
  RepairReport repair;
  OrientReport orient;
};

/// Repairs and then orients a mesh, so that it can be subdivided. The result may be empty. Copies
/// of points and faces get the colour of their original; welded points get the mean of their
/// colours.
/// @throws MeshError, UsageError, LimitError  as repair and orient
PolygonMesh soundMesh(PolygonMesh mesh, const RepairOptions& options, SoundReport& report);

/// Summary in one line: "dropped 2 duplicate faces, flipped 12 faces"; empty if there was no
/// change.
std::string summary(const SoundReport& report);

/// The first change: "dropped face 1, which repeats face 0"; empty if there was none.
std::string firstAction(const SoundReport& report);

}  // namespace vox
