// Faces with holes and concave faces, from the file to the voxels.

#include "libvox/grid/openvdb.h"
#include "libvox/inspect/summary.h"
#include "libvox/mesh/star_shaped.h"
#include "libvox/pipeline/convert.h"
#include "libvox/prepare/sound.h"
#include "tests/outlines.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace vox;
using test::Bridge;
using test::Outline;

namespace {

constexpr Bridge kBridges[] = {Bridge::kSameVertices, Bridge::kEqualPositions, Bridge::kChain,
                               Bridge::kHoleToHole, Bridge::kSameDirection};

std::vector<Outline> outlines() {
  return {test::letterU(),      test::letterA(),   test::letterB(12), test::letterC(20),
          test::letterS(40),    test::letterO(40), test::letterI(),   test::figureEight(40),
          test::spiral(150, 3), test::comb(5),     test::gear(12, 0), test::gear(12, 1.5),
          test::plate(3, 2, 10)};
}

Conversion solid(const PolygonMesh& mesh, double voxelSize, FaceRule faces = FaceRule::kSplit,
                 std::optional<StopRule> until = {}) {
  ConvertOptions options;
  options.voxelSize = voxelSize;
  options.volume.fill = Fill::kSolid;
  options.smoothing.faces = faces;
  options.until = until;
  return convert(test::sceneOf({mesh}), options);
}

const openvdb::FloatGrid& densityOf(const Conversion& conversion) {
  return dynamic_cast<const openvdb::FloatGrid&>(*conversion.grids.at(0));
}

/// The largest distance of the centre of a solid voxel from an outline, in voxels.
double farthestOutside(const Conversion& conversion, const Outline& outline,
                       const Outline& spline) {
  const double size = conversion.report.voxelSize;
  double farthest = 0;
  for (auto voxel = densityOf(conversion).cbeginValueOn(); voxel; ++voxel) {
    const openvdb::CoordBBox box = voxel.getBoundingBox();
    for (auto at = box.begin(); at; ++at) {
      const Vec3d p(size * (*at).x(), size * (*at).y(), 0);
      double distance = test::distanceFrom(outline, p);
      if (distance > farthest) distance = std::min(distance, test::distanceFrom(spline, p));
      farthest = std::max(farthest, distance);
    }
  }
  return farthest / size;
}

struct Sound {
  PolygonMesh mesh;
  SoundReport report;
};

Sound soundOf(const PolygonMesh& mesh, FaceRule faces = FaceRule::kSplit) {
  Sound sound;
  RepairOptions options;
  options.faces = faces;
  sound.mesh = soundMesh(mesh, options, sound.report);
  return sound;
}

Vec3d areaVector(const PolygonMesh& mesh, Index f) {
  Vec3d sum = Vec3d::Zero();
  const auto face = mesh.face(f);
  for (std::size_t i = 0; i < face.size(); ++i)
    sum += mesh.points[face[i]].cross(mesh.points[face[(i + 1) % face.size()]]) / 2;
  return sum;
}

/// The area of the faces whose corners all lie on top, counted negative where a face turns down.
double areaOnTop(const PolygonMesh& mesh, double height) {
  double sum = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    if (std::all_of(face.begin(), face.end(),
                    [&](Index v) { return mesh.points[v].z() == height; }))
      sum += areaVector(mesh, f).z();
  }
  return sum;
}

/// The largest sine by which a corner bends inward.
double worstBend(const PolygonMesh& mesh) {
  double worst = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    const Vec3d normal = areaVector(mesh, f).normalized();
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec3d a = mesh.points[face[(i + face.size() - 1) % face.size()]];
      const Vec3d b = mesh.points[face[i]];
      const Vec3d c = mesh.points[face[(i + 1) % face.size()]];
      const double bend = (b - a).normalized().cross((c - b).normalized()).dot(normal);
      worst = std::max(worst, -bend);
    }
  }
  return worst;
}

/// Lattice points of a closed region with corners on lattice points (Pick's theorem with holes),
/// for a lattice `fine` times finer.
double latticePoints(const Outline& outline, int fine) {
  double rim = 0;
  for (const test::Loop& loop : outline.loops)
    for (std::size_t i = 0; i < loop.size(); ++i)
      rim += (loop[(i + 1) % loop.size()] - loop[i]).lpNorm<1>();  // sides along the axes
  const auto holes = static_cast<double>(outline.loops.size() - 1);
  return fine * fine * test::area(outline) + fine * rim / 2 + 1 - holes;
}

/// Somewhere in space, and bent a little.
PolygonMesh placed(PolygonMesh mesh, double scale, double shift, double dent, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized();
  for (Vec3d& p : mesh.points)
    p = scale * (turn * (p + dent * Vec3d(0, 0, std::sin(p.x()) * std::cos(p.y())))) +
        shift * Vec3d(any(random) > 2 ? 0 : 1, 0.5, 0.7);
  return mesh;
}

/// Closed, without any fault, and with as many handles as the outline has holes.
void checkTopology(const Sound& sound, const Outline& outline) {
  CHECK(test::faultOf(sound.mesh) == "");
  const MeshSummary summary = summarize(sound.mesh);
  CHECK(summary.closed);
  CHECK(summary.components == 1);
  CHECK(summary.genus == static_cast<std::int64_t>(outline.loops.size()) - 1);
}

}  // namespace

TEST_CASE("faces with holes keep their holes, however the bridges are written",
          "[prepare][faces]") {
  for (const Outline& outline : outlines())
    for (const Bridge bridge : kBridges) {
      CAPTURE(outline.name, static_cast<int>(bridge));
      const PolygonMesh mesh = test::solidOf(outline, 1, bridge);
      for (const FaceRule rule : {FaceRule::kSplit, FaceRule::kKeep}) {
        const Sound sound = soundOf(mesh, rule);
        checkTopology(sound, outline);
        CHECK(areaOnTop(sound.mesh, 1) == Approx(test::area(outline)).epsilon(1e-12));
        const FaceSplitReport& split = sound.report.repair.faces;
        CHECK(split.keyholes.faces == (outline.loops.size() > 1 ? 2 : 0));
        CHECK(sound.report.repair.faceOrigin.size() == sound.mesh.faceCount());
        if (rule == FaceRule::kSplit && summary(split) != "") CHECK(worstBend(sound.mesh) < 1e-9);
      }
    }
}

TEST_CASE("random outlines with holes keep area and genus", "[prepare][faces][property]") {
  const double dent = GENERATE(0, 0.02);
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    test::Squares squares = test::randomSquares(5 + static_cast<int>(5 * seed), seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> jitter(-0.2, 0.2);
    if (seed % 3 != 0)
      for (test::Loop& loop : squares.outline.loops)
        for (Vec3d& p : loop) p += Vec3d(jitter(random), jitter(random), 0);
    const Outline& outline = squares.outline;
    const Bridge bridge = kBridges[seed % std::size(kBridges)];
    CAPTURE(seed, squares.count, outline.loops.size(), static_cast<int>(bridge));
    const PolygonMesh mesh = test::solidOf(outline, 1, bridge);
    const Sound flat = soundOf(mesh);
    checkTopology(flat, outline);
    CHECK(areaOnTop(flat.mesh, 1) == Approx(test::area(outline)).epsilon(1e-12));
    const bool isWhole = outline.loops.size() == 1 && isStarShaped(outline.loops[0]);
    CHECK(summary(flat.report.repair.faces).empty() == isWhole);
    CHECK((isWhole || worstBend(flat.mesh) < 1e-4));
    for (const double scale : {1e-6, 1.0, 1e6}) {
      const double shift = scale < 1 ? 0 : 1e6 * scale;
      checkTopology(soundOf(placed(mesh, scale, shift, dent, seed)), outline);
    }
  }
}

TEST_CASE("a solid of squares with holes has the voxels of Pick's theorem",
          "[prepare][faces][golden]") {
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    const test::Squares squares = test::randomSquares(10 + static_cast<int>(4 * seed), seed);
    CAPTURE(seed, squares.outline.loops.size());
    CHECK(test::area(squares.outline) == squares.count);
    for (const Bridge bridge : kBridges) {
      const Conversion conversion = solid(test::solidOf(squares.outline, 1, bridge), 0.25,
                                          FaceRule::kSplit, StopRule{.levels = 0});
      CHECK(static_cast<double>(densityOf(conversion).activeVoxelCount()) ==
            latticePoints(squares.outline, 4) * 5);
    }
  }
  // A frame of 4 x 4 with a hole of 2 x 2, a unit thick.
  const Outline frame = {
      "frame",
      {test::rectangle({0, 0, 0}, {4, 4, 0}), {{1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}}}};
  const Conversion conversion =
      solid(test::solidOf(frame, 1), 0.0625, FaceRule::kSplit, StopRule{.levels = 0});
  CHECK(densityOf(conversion).activeVoxelCount() == 55488);
}

TEST_CASE("islands in holes are faces of their own", "[prepare][faces]") {
  // Frames within frames, all written as one face: rim, hole, rim ...
  PolygonMesh mesh;
  std::vector<Index> face;
  constexpr int kLoops = 6;
  for (int k = 0; k < kLoops; ++k) {
    const double r = kLoops - k;
    test::Loop loop = test::rectangle({-r, -r, 0}, {r, r, 0});
    if (k % 2 == 1) std::reverse(loop.begin() + 1, loop.end());
    const Index first = mesh.pointCount();
    mesh.points.insert(mesh.points.end(), loop.begin(), loop.end());
    for (Index i = 0; i <= 4; ++i) face.push_back(first + i % 4);
  }
  for (int k = kLoops - 1; k-- > 1;) face.push_back(4 * k);
  mesh.addFace(face);
  const Sound sound = soundOf(mesh);
  CHECK(test::faultOf(sound.mesh) == "");
  const MeshSummary summary = summarize(sound.mesh);
  CHECK(summary.components == 3);
  CHECK(summary.eulerCharacteristic == 0);  // three rings
  CHECK(summary.boundaryLoops.size() == 6);
  CHECK(areaOnTop(sound.mesh, 0) == Approx(144 - 100 + 64 - 36 + 16 - 4));
}

TEST_CASE("holes that touch the rim or each other stay holes", "[prepare][faces]") {
  // A square with two triangular holes; both touch its corner 0 and each other there.
  PolygonMesh mesh;
  mesh.points = {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0},
                 {2, 1, 0}, {3, 1, 0}, {1, 2, 0}, {1, 3, 0}};
  mesh.addFace(std::vector<Index>{0, 1, 2, 3, 0, 6, 7, 0, 5, 4});
  const Sound sound = soundOf(mesh);
  CHECK(test::faultOf(sound.mesh) == "");
  CHECK(areaOnTop(sound.mesh, 0) == Approx(81 - 0.5 - 0.5));
  CHECK(sound.report.repair.faces.keyholes.faces == 1);
}

TEST_CASE("convex and star-shaped faces stay as they are", "[prepare][faces]") {
  for (const auto& shape : test::shapes()) {
    CAPTURE(shape.name);
    CHECK(test::sameMesh(soundOf(shape.mesh).mesh, soundOf(shape.mesh, FaceRule::kKeep).mesh));
  }
  for (const Outline& outline : {test::star(9), test::gear(12, 0)}) {
    const Sound sound = soundOf(test::solidOf(outline, 1));
    CHECK(test::sameMesh(sound.mesh, soundOf(test::solidOf(outline, 1), FaceRule::kKeep).mesh));
    CHECK(summary(sound.report.repair.faces) == "");
    CHECK(summary(sound.report) == "");
  }
}

TEST_CASE("a face is star-shaped if the mean of its corners sees all sides", "[prepare][faces]") {
  CHECK(isStarShaped(test::circle(7, 1)));
  CHECK(isStarShaped(test::star(5).loops[0]));
  CHECK(isStarShaped(test::gear(9, 0).loops[0]));
  for (const Outline& outline :
       {test::letterU(), test::letterC(20), test::letterI(), test::spiral(40, 2), test::comb(4)})
    CHECK_FALSE(isStarShaped(outline.loops[0]));
  // A dart: the mean of its corners is at y = (3 + 2 tip) / 4, the tip in the middle at y = tip.
  const auto dart = [](double tip) {
    return std::vector<Vec3d>{{-1, 0, 0}, {0, tip, 0}, {1, 0, 0}, {0, 3, 0}};
  };
  CHECK(isStarShaped(dart(0.99)));
  CHECK(isStarShaped(dart(1)));
  CHECK_FALSE(isStarShaped(dart(1.01)));
}

TEST_CASE("parts depend neither on winding and first corner of a face nor on its bridges",
          "[prepare][faces]") {
  for (const Outline& outline : outlines()) {
    CAPTURE(outline.name);
    const PolygonMesh mesh = test::solidOf(outline, 1);
    const PolygonMesh expected = soundOf(mesh).mesh;
    CHECK(test::sameMesh(soundOf(test::solidOf(outline, 1, Bridge::kHoleToHole)).mesh, expected));
    CHECK(test::sameMesh(soundOf(test::stirred(mesh, 0.5, 3)).mesh, expected));
    PolygonMesh twice = mesh;  // every face once more, turned round
    for (Index f = 0; f < mesh.faceCount(); ++f) {
      std::vector<Index> face(mesh.face(f).rbegin(), mesh.face(f).rend());
      twice.addFace(face);
    }
    CHECK(test::sameMesh(soundOf(twice).mesh, expected));
  }
}

TEST_CASE("faces that cross themselves are as sound as before", "[prepare][faces][property]") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 400; ++i) {
    PolygonMesh mesh;
    const int n = 4 + i % 9;
    for (int k = 0; k < n; ++k)
      mesh.points.emplace_back(std::round(4 * any(random)), std::round(4 * any(random)),
                               i % 2 == 0 ? 0 : any(random));
    std::vector<Index> face;
    for (int k = 0; k < 2 * n; ++k) face.push_back(static_cast<Index>(random() % n));
    mesh.addFace(face);
    CAPTURE(i);
    const Sound sound = soundOf(mesh);
    if (sound.mesh.faceCount() > 0) CHECK(test::faultOf(sound.mesh) == "");
  }
  PolygonMesh bowTie;
  bowTie.points = {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 1, 0}};
  bowTie.addFace(std::vector<Index>{0, 1, 2, 3});
  CHECK(soundOf(bowTie).mesh.faceCount() == 1);
}

TEST_CASE("parts have the colour of their face", "[prepare][faces]") {
  PolygonMesh mesh = test::solidOf(test::letterB(6), 1);
  for (Index f = 0; f < mesh.faceCount(); ++f)
    mesh.faceColors.emplace_back(static_cast<float>(f), 0.0F, 1.0F);
  for (Index v = 0; v < mesh.pointCount(); ++v)
    mesh.pointColors.emplace_back(0.0F, static_cast<float>(v), 1.0F);
  const Sound sound = soundOf(mesh);
  REQUIRE(sound.mesh.faceColors.size() == sound.mesh.faceCount());
  for (Index f = 0; f < sound.mesh.faceCount(); ++f) {
    const bool isBottom = areaVector(sound.mesh, f).z() < -1e-9;
    const bool isTop = areaVector(sound.mesh, f).z() > 1e-9;
    const float color = sound.mesh.faceColors[f].x();
    CHECK((isBottom ? color == 0 : isTop ? color == 1 : color > 1));
  }
  for (Index v = 0; v < sound.mesh.pointCount(); ++v) {
    const auto from = static_cast<Index>(sound.mesh.pointColors[v].y());
    CHECK(mesh.points[from] == sound.mesh.points[v]);
  }
}

TEST_CASE("the polygons of the input are not split where nothing is smoothed", "[prepare][faces]") {
  const PolygonMesh mesh = placed(test::solidOf(test::comb(5), 1), 1, 0, 0.1, 1);
  const StopRule none{.levels = 0};
  const Conversion split = solid(mesh, 0.1, FaceRule::kSplit, none);
  const Conversion kept = solid(mesh, 0.1, FaceRule::kKeep, none);
  CHECK(split.report.warnings == kept.report.warnings);
  CHECK(densityOf(split).tree().hasSameTopology(densityOf(kept).tree()));
  CHECK(densityOf(split).activeVoxelCount() == densityOf(kept).activeVoxelCount());
}

TEST_CASE("the smooth solid of an outline stays within it, but for its rounded corners",
          "[prepare][faces][property]") {
  for (const Outline& outline : outlines()) {
    CAPTURE(outline.name);
    const Conversion conversion = solid(test::solidOf(outline, 1), 0.1);
    CHECK(farthestOutside(conversion, outline, test::splineOf(outline)) <= 1);
  }
}
