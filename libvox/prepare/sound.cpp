// Repair and orientation as one step, told in terms of the input.

#include "libvox/prepare/sound.h"

#include <utility>

namespace vox {
namespace {

void nameInputElements(OrientReport& report, const RepairReport& before) {
  for (Index& v : report.pointOrigin) v = before.pointOrigin[v];
  for (Index& f : report.faceOrigin) f = before.faceOrigin[f];
  for (Index& f : report.oneSided) f = before.faceOrigin[f];
  if (report.firstFlipped != kNone) report.firstFlipped = before.faceOrigin[report.firstFlipped];
}

}  // namespace

PolygonMesh soundMesh(PolygonMesh mesh, const RepairOptions& options, SoundReport& report) {
  mesh = orient(repair(std::move(mesh), options, report.repair), report.orient);
  nameInputElements(report.orient, report.repair);
  return mesh;
}

std::string summary(const SoundReport& report) {
  const std::string repaired = summary(report.repair);
  const std::string turned = summary(report.orient);
  return repaired + (repaired.empty() || turned.empty() ? "" : ", ") + turned;
}

std::string firstAction(const SoundReport& report) {
  for (const RepairAction& action : report.repair.actions)
    if (action.count > 0) return action.message;
  const OrientReport& orient = report.orient;
  if (orient.firstFlipped != kNone)
    return "flipped face " + std::to_string(orient.firstFlipped) +
           ", which was wound against its neighbours or inward";
  if (!orient.oneSided.empty())
    return "doubled the component of face " + std::to_string(orient.oneSided[0]) +
           ", which is one-sided";
  return {};
}

}  // namespace vox
