// Repair and orientation as one step; its report names elements of the input.

#include "libvox/prepare/sound.h"

#include "libvox/mesh/validate.h"

#include <utility>
#include <vector>

namespace vox {
namespace {

void nameInputElements(OrientReport& report, const RepairReport& before) {
  report.pointOrigin = composed(before.pointOrigin, report.pointOrigin);
  report.faceOrigin = composed(before.faceOrigin, report.faceOrigin);
  for (Index& f : report.oneSided) f = before.faceOrigin[f];
  if (report.firstFlipped != kNone) report.firstFlipped = before.faceOrigin[report.firstFlipped];
}

/// For each point, the mean colour of the points welded to it, summed in the order of their
/// numbers.
std::vector<Vec3f> meanOfWelded(const std::vector<Vec3f>& colors, const Origins& weldedTo) {
  std::vector<Vec3d> sums(colors.size(), Vec3d::Zero());
  std::vector<Index> counts(colors.size(), 0);
  for (Index v = 0; v < colors.size(); ++v) {
    sums[weldedTo[v]] += colors[v].cast<double>();
    ++counts[weldedTo[v]];
  }
  std::vector<Vec3f> means(colors);
  for (std::size_t v = 0; v < colors.size(); ++v)
    if (counts[v] > 1) means[v] = (sums[v] / counts[v]).cast<float>();
  return means;
}

std::vector<Vec3f> followed(const std::vector<Vec3f>& colors, const Origins& origin) {
  if (colors.empty()) return {};
  std::vector<Vec3f> result;
  result.reserve(origin.size());
  for (Index i = 0; i < origin.size(); ++i) result.push_back(colors[origin[i]]);
  return result;
}

}  // namespace

PolygonMesh soundMesh(PolygonMesh mesh, const RepairOptions& options, SoundReport& report) {
  requireValidArrays(mesh);
  const std::vector<Vec3f> pointColors = std::exchange(mesh.pointColors, {});
  const std::vector<Vec3f> faceColors = std::exchange(mesh.faceColors, {});
  mesh = repairValid(std::move(mesh), options, report.repair);
  mesh = orient(std::move(mesh), std::move(report.repair.joints), report.orient);
  nameInputElements(report.orient, report.repair);
  mesh.pointColors =
      followed(meanOfWelded(pointColors, report.repair.weldedTo), report.orient.pointOrigin);
  mesh.faceColors = followed(faceColors, report.orient.faceOrigin);
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
