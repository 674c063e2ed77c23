// The lattice of another file: --like.

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/read_lattice.h"
#include "libvox/options/option_text.h"
#include "libvox/pipeline/convert.h"
#include "tests/conversion.h"
#include "tests/scenes.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>
#include <openvdb/tools/LevelSetSphere.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace vox;
using Catch::Contains;
using openvdb::math::Transform;

namespace {

/// Writes a grid with one active voxel.
std::string fileOf(const test::TemporaryFolder& folder, const std::string& name,
                   const Transform::Ptr& transform, const openvdb::Coord& active = {3, -4, 5}) {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(0.0F);
  grid->setName("reference");
  grid->setTransform(transform);
  if (active != openvdb::Coord::max()) grid->tree().setValue(active, 1.0F);
  const std::string file = folder / name;
  openvdb::io::File(file).write({grid});
  return file;
}

Transform::Ptr latticeAt(double size, const openvdb::Vec3d& origin) {
  auto transform = Transform::createLinearTransform(size);
  transform->postTranslate(origin);
  return transform;
}

ConvertOptions optionsLike(const std::string& reference, bool clip = false) {
  const FileLattice lattice = readLattice(reference, clip);
  ConvertOptions options;
  options.voxelSize = lattice.voxelSize;
  options.origin = lattice.origin;
  options.clip = lattice.activeBox;
  return options;
}

}  // namespace

TEST_CASE("a conversion like its own file is that file", "[lattice]") {
  const test::TemporaryFolder folder;
  const Scene scene = test::oneObject(test::torusGrid(12, 8));
  for (const auto& [target, up] :
       {std::pair(Target::kBlender, UpAxis::kZ), std::pair(Target::kBlender, UpAxis::kY),
        std::pair(Target::kBlender34, UpAxis::kZ), std::pair(Target::kHoudini, UpAxis::kZ)}) {
    ConvertOptions options;
    options.dim = 30;
    options.grids = {GridKind::kDensity, GridKind::kSurface, GridKind::kNormal};
    options.volume.target = target;
    options.volume.up = up;
    const Conversion made = convert(scene, options);
    const std::string file = folder / "reference.vdb";
    writeGrids(file, made, true);
    const ConvertOptions like = optionsLike(file);
    options.dim.reset();
    options.voxelSize = like.voxelSize;
    options.origin = like.origin;
    const Conversion again = convert(scene, options);
    for (const Conversion* one : {&made, &again})
      for (const auto& grid : one->grids) grid->removeMeta("vox_options");
    if (target != Target::kBlender34) {
      CHECK(test::bytesOf(made) == test::bytesOf(again));
      continue;
    }
    for (std::size_t i = 0; i < made.grids.size(); ++i) {  // OpenVDB rounded the first transform
      CHECK(made.grids[i]->activeVoxelCount() == again.grids[i]->activeVoxelCount());
      CHECK(made.grids[i]->evalActiveVoxelBoundingBox() ==
            again.grids[i]->evalActiveVoxelBoundingBox());
    }
  }
}

TEST_CASE("outputs of different meshes share the transform of the reference exactly", "[lattice]") {
  const test::TemporaryFolder folder;
  const double size = 0.1 / 3;
  const openvdb::Vec3d origin(0.1, -1.0 / 7, 1e3 + 0.3);
  const auto transform = GENERATE_COPY(latticeAt(size, origin), latticeAt(size, {0, 0, 0}));
  const std::string file = fileOf(folder, "reference.vdb", transform);
  for (const Target target : {Target::kBlender, Target::kBlender34, Target::kHoudini})
    for (const PolygonMesh& mesh : {test::cube(), test::torusGrid(8, 6)}) {
      ConvertOptions options = optionsLike(file);
      options.volume.target = target;
      const auto grid = convert(test::oneObject(mesh), options).grids[0];
      CHECK(grid->transform() == *transform);
      const openvdb::Coord far(12345, -678, 91011);
      CHECK(grid->indexToWorld(far) == transform->indexToWorld(far));  // every bit
    }
}

TEST_CASE("distances belong to the centres of the voxels of the reference", "[lattice]") {
  const test::TemporaryFolder folder;
  const double size = 0.07;
  const std::string file =
      fileOf(folder, "reference.vdb", latticeAt(size, {0.0123, 0.0456, -0.0311}));
  ConvertOptions options = optionsLike(file);
  options.until = StopRule{.levels = 0};  // the surface is the cube
  options.grids = {GridKind::kSurface, GridKind::kMask};
  const Conversion made = convert(test::oneObject(test::cube()), options);
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(made.grids[0]);
  REQUIRE(grid->activeVoxelCount() > 1000);
  double worst = 0;
  for (auto value = grid->cbeginValueOn(); value; ++value) {
    const openvdb::Vec3d p = grid->indexToWorld(value.getCoord());
    double outside = 0;
    double deepest = -1;
    for (int axis = 0; axis < 3; ++axis) {
      const double beyond = std::abs(p[axis]) - 1;
      outside += std::pow(std::max(beyond, 0.0), 2);
      deepest = std::max(deepest, beyond);
    }
    const double exact = deepest > 0 ? std::sqrt(outside) : deepest;
    worst = std::max(worst, std::abs(double{*value} - exact));
  }
  CHECK(worst < 1e-5);
  // Marked voxels: the faces of the cube cross them.
  for (auto voxel = openvdb::gridPtrCast<openvdb::MaskGrid>(made.grids[1])->cbeginValueOn(); voxel;
       ++voxel) {
    const openvdb::Vec3d p = grid->indexToWorld(voxel.getCoord());
    const double most = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    REQUIRE(std::abs(most - 1) <= size / 2 + 1e-9);
  }
}

TEST_CASE("the lattice of OpenVDB's own level set is taken bit for bit", "[lattice]") {
  openvdb::initialize();
  const test::TemporaryFolder folder;
  auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
      0.8F, openvdb::Vec3f(0.2F, 0.1F, 0), 0.05F);
  sphere->transform().postTranslate({0.011, 0.022, 0.033});
  sphere->setName("ball");
  const std::string file = folder / "ball.vdb";
  openvdb::io::File(file).write({sphere});
  const ConvertOptions options = optionsLike(file + ":ball", true);
  const auto grid = convert(test::oneObject(test::torusGrid(12, 8)), options).grids[0];
  CHECK(grid->transform() == sphere->transform());
  CHECK(sphere->evalActiveVoxelBoundingBox().isInside(grid->evalActiveVoxelBoundingBox()));
}

TEST_CASE("voxels that OpenVDB's rounding alone makes uneven are cubes", "[lattice]") {
  const test::TemporaryFolder folder;
  const auto map = std::make_shared<openvdb::math::ScaleTranslateMap>(
      openvdb::Vec3d(0.1 / 3), openvdb::Vec3d(0.1, -1.0 / 7, 1e3));
  const std::string file = fileOf(folder, "copy.vdb", std::make_shared<Transform>(map));
  CHECK(readLattice(file, false).voxelSize == Approx(0.1 / 3).epsilon(1e-14));
}

TEST_CASE("the box of a reference is that of its active voxels", "[lattice]") {
  const test::TemporaryFolder folder;
  const std::string file = fileOf(folder, "one.vdb", latticeAt(0.5, {0, 0, 0}));
  CHECK(readLattice(file, true).activeBox == std::array{3, -4, 5, 3, -4, 5});
  CHECK_FALSE(readLattice(file, false).activeBox.has_value());
  const std::string empty =
      fileOf(folder, "none.vdb", latticeAt(0.5, {0, 0, 0}), openvdb::Coord::max());
  CHECK_THROWS_WITH(readLattice(empty, true), Contains("no active voxel"));
}

TEST_CASE("a file that has the whole text as its name wins over a name of a grid", "[lattice]") {
  const test::TemporaryFolder folder;
  const std::string plain = fileOf(folder, "a.vdb", latticeAt(0.5, {0, 0, 0}));
  CHECK(readLattice(plain + ":reference", false).voxelSize == 0.5);
  CHECK_THROWS_WITH(readLattice(plain + ":other", false),
                    Contains("no grid 'other'") && Contains("reference"));
  fileOf(folder, "a.vdb:reference", latticeAt(0.25, {0, 0, 0}));
  CHECK(readLattice(plain + ":reference", false).voxelSize == 0.25);
  CHECK_THROWS_AS(readLattice(folder / "missing.vdb:x", false), InputError);
}

TEST_CASE("names of grids may have colons, and so may names of files", "[lattice]") {
  const test::TemporaryFolder folder;
  auto grid = openvdb::FloatGrid::create(0.0F);
  grid->setName("smoke:0");
  grid->setTransform(latticeAt(0.5, {0, 0, 0}));
  openvdb::io::File(folder / "a:b.vdb").write({grid});
  CHECK(readLattice(folder / "a:b.vdb:smoke:0", false).voxelSize == 0.5);
  CHECK(readLattice(folder / "a:b.vdb", false).voxelSize == 0.5);
  CHECK_THROWS_WITH(readLattice(folder / "a:b.vdb:smoke:1", false),
                    Contains("a:b.vdb: has no grid 'smoke:1'"));
}

TEST_CASE("a truncated reference is called so", "[lattice][error]") {
  const test::TemporaryFolder folder;
  const std::string file = fileOf(folder, "a.vdb", latticeAt(0.5, {0, 0, 0}));
  const auto size = std::filesystem::file_size(file);
  for (const std::uintmax_t kept : {std::uintmax_t{20}, size / 2, size - 1}) {
    CAPTURE(kept, size);
    std::filesystem::resize_file(file, kept);
    CHECK_THROWS_WITH(readLattice(file, false), Contains("a.vdb: is truncated or damaged"));
    fileOf(folder, "a.vdb", latticeAt(0.5, {0, 0, 0}));
  }
}

TEST_CASE("transforms that are no cubes along the axes are refused by what they are", "[lattice]") {
  const test::TemporaryFolder folder;
  const auto refusal = [&](const Transform::Ptr& transform) -> std::string {
    const std::string file = fileOf(folder, "odd.vdb", transform);
    try {
      readLattice(file, false);
    } catch (const InputError& wrong) {
      return wrong.what();
    }
    return "";
  };
  auto rotated = Transform::createLinearTransform(0.5);
  rotated->postRotate(0.3, openvdb::math::X_AXIS);
  CHECK_THAT(refusal(rotated), Contains("'reference' is rotated") && Contains("resample"));
  auto sheared = Transform::createLinearTransform(0.5);
  sheared->postShear(0.3, openvdb::math::X_AXIS, openvdb::math::Y_AXIS);
  CHECK_THAT(refusal(sheared), Contains("is sheared"));
  auto flat = Transform::createLinearTransform(0.5);
  flat->postScale({1, 1, 2});
  CHECK_THAT(refusal(flat), Contains("0.5 x 0.5 x 1"));
  auto mirrored = Transform::createLinearTransform(0.5);
  mirrored->postScale({1, 1, -1});
  CHECK_THAT(refusal(mirrored), Contains("mirrored"));
  CHECK_THAT(refusal(Transform::createFrustumTransform(
                 openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(10)), 0.5, 1, 0.5)),
             Contains("frustum"));
}

TEST_CASE("recorded options say lattice and box to the last bit", "[lattice]") {
  ConvertOptions options;
  options.voxelSize = 0.1 / 3;
  options.origin = std::array{-0.1, 1.0 / 7, 1e-17};
  options.bounds = std::array{-1.0 / 3, -2.0, -3.5, 0.1, 0.2, 1e9};
  options.clip = std::array{-5, 0, 7, -4, 100, 1 << 30};
  const ConvertOptions read = parseOptionText(optionText(options)).options;
  CHECK(read.voxelSize == options.voxelSize);
  CHECK(read.origin == options.origin);
  CHECK(read.bounds == options.bounds);
  CHECK(read.clip == options.clip);
  CHECK_THROWS_AS(parseOptionText("bounds=1,2,3,4,5"), InputError);
  CHECK_THROWS_AS(parseOptionText("bounds=1,2,3,4,5,6,7"), InputError);
  CHECK_THROWS_AS(parseOptionText("origin=1,nan,3"), InputError);
}

TEST_CASE("an origin needs a voxel size", "[lattice][error]") {
  ConvertOptions options;
  options.origin = std::array{0.1, 0.2, 0.3};
  CHECK_THROWS_AS(convert(test::oneObject(test::cube()), options), UsageError);
}

TEST_CASE("inputs far from the lattice are refused", "[lattice][error]") {
  ConvertOptions options;
  options.voxelSize = 0.1;
  options.origin = std::array{1e12, 0.0, 0.0};
  CHECK_THROWS_WITH(convert(test::oneObject(test::cube()), options), Contains("lattice"));
}
