// Voxels as points for the viewer.

#include "libvox/report/point_cloud.h"

#include "libvox/report/html.h"
#include "libvox/report/palette.h"
#include "libvox/report/sample_voxels.h"

#include <cmath>
#include <sstream>
#include <vector>

namespace vox {
namespace {

using openvdb::Coord;

/// Voxels that do not differ are at most this part of the points asked for.
constexpr std::uint64_t kCommonPart = 5;
constexpr double kLevels = 63;

/// Appends points to a cloud.
class PointWriter {
 public:
  explicit PointWriter(PointCloud& cloud) : cloud_(cloud), before_(cloud.box.min()) {}

  void add(const Coord& voxel, VoxelChange change, double part) {
    for (int axis = 0; axis < 3; ++axis) addNumber(voxel[axis] - before_[axis]);
    before_ = voxel;
    const auto level = static_cast<unsigned>(std::lround(kLevels * part));
    cloud_.bytes += static_cast<char>(static_cast<unsigned>(change) << 6U | level);
  }

 private:
  void addNumber(std::int32_t number) {
    auto zigzag = static_cast<std::uint32_t>(number) << 1U;
    if (number < 0) zigzag = ~zigzag;
    for (; zigzag >= 0x80; zigzag >>= 7U)
      cloud_.bytes += static_cast<char>(0x80U | (zigzag & 0x7FU));
    cloud_.bytes += static_cast<char>(zigzag);
  }

  PointCloud& cloud_;
  Coord before_;
};

void addCommon(const openvdb::MaskTree& voxels, std::uint64_t most, PointWriter& points,
               PointCloud& cloud) {
  for (const Coord& voxel : sampleVoxels(voxels, most)) {
    points.add(voxel, VoxelChange::kUnchanged, 0);
    ++cloud.common;
  }
}

std::string checkbox(const std::string& name, const std::string& color, const std::string& label) {
  return "<label><input type=\"checkbox\" name=\"" + name +
         "\" checked><span class=\"chip\" style=\"background:" + color + "\">&nbsp;</span>" +
         label + "</label>\n";
}

std::string button(const std::string& action, const std::string& label, const std::string& sign) {
  return "<button type=\"button\" name=\"" + action + "\" aria-label=\"" + label + "\" title=\"" +
         label + "\">" + sign + "</button>\n";
}

}  // namespace

PointCloud pointsOf(const DifferenceLook& look, std::uint64_t most) {
  PointCloud cloud;
  look.all().evalActiveVoxelBoundingBox(cloud.box);
  PointWriter points(cloud);
  cloud.step = (look.differing().activeVoxelCount() + most - 1) / most;
  for (const Coord& voxel : sampleVoxels(look.differing(), most)) {
    const VoxelChange change = look.changeAt(voxel);
    points.add(voxel, change, change == VoxelChange::kValue ? look.valuePart(voxel) : 0);
    ++cloud.differing;
  }
  openvdb::MaskTree common(look.all());
  common.topologyDifference(look.differing());
  addCommon(common, most / kCommonPart, points, cloud);
  return cloud;
}

PointCloud pointsOf(const openvdb::MaskTree& voxels, std::uint64_t most) {
  PointCloud cloud;
  voxels.evalActiveVoxelBoundingBox(cloud.box);
  PointWriter points(cloud);
  addCommon(voxels, most, points, cloud);
  cloud.step = (voxels.activeVoxelCount() + most - 1) / most;
  return cloud;
}

std::string viewerOf(const PointCloud& cloud, const openvdb::math::Transform& toWorld,
                     const View& view, const std::string& id) {
  const openvdb::Mat4d matrix = toWorld.baseMap()->getAffineMap()->getMat4();
  std::ostringstream html;
  html << "<div class=\"viewer\" id=\"" << id << "\" data-count=\""
       << cloud.differing + cloud.common << "\" data-box=\"";
  for (int axis = 0; axis < 3; ++axis) html << cloud.box.min()[axis] << ' ';
  for (int axis = 0; axis < 3; ++axis) html << cloud.box.max()[axis] << (axis < 2 ? " " : "");
  html << "\" data-view=\"" << view.azimuth << ' ' << view.elevation << "\" data-axes=\"";
  for (int axis = 0; axis < 3; ++axis)  // where a step along each axis of the index space leads
    for (int k = 0; k < 3; ++k) html << matrix(axis, k) << (axis + k < 4 ? " " : "");
  html << "\" data-colors=\"";
  for (const Pixel& color : {kCommonColor, kOnlyAColor, kOnlyBColor, kSmallColor, kLargeColor})
    html << cssColor(color) << ' ';
  const bool isDifference = cloud.differing > 0;
  html << "\">\n<canvas tabindex=\"0\" role=\"img\" aria-label=\"The voxels"
       << (isDifference ? " that differ" : "") << ", to turn by dragging or with the arrow keys\">"
       << "</canvas>\n<div class=\"controls\">\n"
       << button("left", "turn left", "&#8592;") << button("right", "turn right", "&#8594;")
       << button("up", "turn up", "&#8593;") << button("down", "turn down", "&#8595;")
       << button("nearer", "nearer", "+") << button("farther", "farther", "&#8722;")
       << button("start", "as at first", "&#8634;");
  if (isDifference)
    html << checkbox("common", cssColor(kCommonColor), "in both")
         << checkbox("onlyA", cssColor(kOnlyAColor), "only in A")
         << checkbox("onlyB", cssColor(kOnlyBColor), "only in B")
         << checkbox("value", cssColor(kSmallColor), "another value");
  html
      << "</div>\n<p class=\"fallback\">This browser shows no WebGL, which the turning view needs. "
         "The pictures on this page show the same.</p>\n<p class=\"note\">"
      << grouped(isDifference ? cloud.differing : cloud.common)
      << (cloud.differing + cloud.common == 1 ? " voxel" : " voxels");
  if (isDifference) html << " that differ";
  if (cloud.step > 1) html << ", one in " << grouped(cloud.step);
  if (isDifference && cloud.common > 0)
    html << ", and " << grouped(cloud.common) << " of the others";
  html << ". Drag to turn, turn the wheel to come nearer; or use the arrow keys, + and -. What is "
          "switched off hides nothing.</p>\n"
       << "<script type=\"application/octet-stream\">" << base64(cloud.bytes)
       << "</script>\n</div>\n";
  return html.str();
}

}  // namespace vox
