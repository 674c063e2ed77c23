// Files cut into parts and merged again. The parts are cut here from loaded grids, so that the
// tests do not depend on conversions in parts.

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/merge_vdb.h"
#include "libvox/io/read_vdb.h"
#include "libvox/io/write_vdb.h"
#include "libvox/pipeline/convert.h"
#include "tests/conversion.h"
#include "tests/scenes.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace vox;
using openvdb::Coord;

namespace {

using Files = std::vector<std::filesystem::path>;
using Grids = std::vector<openvdb::GridBase::Ptr>;
using openvdb::Int32Metadata;
using openvdb::Int64Metadata;

/// A brick of 128^3 voxels in the order of OpenVDB's files: upper node, and child of it.
using Brick = std::pair<Coord, openvdb::Index>;
using Kinds = openvdb::TypeList<openvdb::MaskGrid, openvdb::FloatGrid, openvdb::Vec3SGrid,
                                openvdb::Int32Grid>;

const Brick kFirst = {Coord::min(), 0};
const Brick kEnd = {Coord::max(), 0};

/// Calls visit(grid of its type).
template <class Visit>
void withType(openvdb::GridBase& grid, const Visit& visit) {
  REQUIRE(grid.apply<Kinds>(visit));
}

/// The bricks of a grid with nodes or values other than the background.
std::set<Brick> bricksOf(openvdb::GridBase& grid) {
  std::set<Brick> bricks;
  withType(grid, [&](auto& typed) {
    const auto& background = typed.background();
    for (auto node = typed.tree().cbeginNode(); node; ++node) {
      if (node.getDepth() != 1) continue;
      using Upper = typename std::decay_t<decltype(typed.tree().root())>::ChildNodeType;
      const Upper* upper = nullptr;
      node.getNode(upper);
      for (auto brick = upper->cbeginChildOn(); brick; ++brick)
        bricks.emplace(upper->origin(), brick.pos());
      for (auto tile = upper->cbeginValueAll(); tile; ++tile)
        if (tile.isValueOn() || *tile != background) bricks.emplace(upper->origin(), tile.pos());
    }
    for (auto tile = typed.tree().root().cbeginValueAll(); tile; ++tile)
      for (openvdb::Index i = 0; i < 32 * 32 * 32; ++i) bricks.emplace(tile.getCoord(), i);
  });
  return bricks;
}

std::set<Brick> bricksOf(const Grids& grids) {
  std::set<Brick> all;
  for (const auto& grid : grids) all.merge(bricksOf(*grid));
  return all;
}

/// A copy without the bricks outside [from, to).
openvdb::GridBase::Ptr cut(const openvdb::GridBase& whole, const Brick& from, const Brick& to) {
  const auto part = whole.deepCopyGrid();
  withType(*part, [&](auto& typed) {
    auto& root = typed.tree().root();
    using Upper = typename std::decay_t<decltype(root)>::ChildNodeType;
    const auto background = typed.background();
    std::vector<Coord> places;
    for (auto child = root.cbeginChildOn(); child; ++child) places.push_back(child.getCoord());
    for (auto tile = root.cbeginValueAll(); tile; ++tile) places.push_back(tile.getCoord());
    for (const Coord& place : places) {
      const auto isKept = [&](openvdb::Index i) {
        return from <= Brick(place, i) && Brick(place, i) < to;
      };
      if (isKept(0) && isKept(Upper::NUM_VALUES - 1)) continue;
      Upper* upper = root.template probeNode<Upper>(place);
      if (upper == nullptr) {
        upper = new Upper(place, typed.tree().getValue(place), typed.tree().isValueOn(place));
        root.addChild(upper);
      }
      bool isEmpty = true;
      for (openvdb::Index i = 0; i < Upper::NUM_VALUES; ++i) {
        if (!isKept(i)) upper->addTile(i, background, false);
        isEmpty = isEmpty && !upper->isChildMaskOn(i) && !upper->isValueMaskOn(i) &&
                  upper->getTable()[i].getValue() == background;
      }
      if (isEmpty) root.addTile(place, background, false);
    }
    root.eraseBackgroundTiles();
  });
  return part;
}

/// The metadata of part `number` of `count`, as `vox convert --part` writes it. Voxels and levels
/// are divided so that the whole can be told only from all parts.
void describePart(Grids& grids, int number, int count, std::int64_t voxels, int levels) {
  for (const auto& grid : grids) {
    grid->insertMeta("vox_part", Int32Metadata(number));
    grid->insertMeta("vox_parts", Int32Metadata(count));
    if (voxels > 0) {
      grid->insertMeta("vox_active_voxels", Int64Metadata(voxels));
      grid->insertMeta("vox_levels", Int32Metadata(levels));
    } else {
      for (const char* key : {"vox_active_voxels", "vox_levels", "vox_guarantee"})
        grid->removeMeta(key);
    }
  }
}

/// The parts between ascending bricks: one more than bricks.
std::vector<Grids> partsOf(const Conversion& whole, const std::vector<Brick>& cuts) {
  std::vector<Grids> parts;
  std::size_t last = 0;  // part with voxels
  for (std::size_t i = 0; i <= cuts.size(); ++i) {
    Grids part;
    for (const auto& grid : whole.grids)
      part.push_back(cut(*grid, i == 0 ? kFirst : cuts[i - 1], i == cuts.size() ? kEnd : cuts[i]));
    if (!bricksOf(part).empty()) last = i;
    parts.push_back(std::move(part));
  }
  const auto& first = *whole.grids[0];
  const bool any = first["vox_active_voxels"] != nullptr;
  auto left = any ? first.getMetadata<Int64Metadata>("vox_active_voxels")->value() : 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::int64_t voxels = i == last ? left : bricksOf(parts[i]).empty() ? 0 : 1;
    left -= voxels;
    const int levels = any ? first.getMetadata<Int32Metadata>("vox_levels")->value() : 0;
    describePart(parts[i], static_cast<int>(i) + 1, static_cast<int>(parts.size()), voxels,
                 i == last ? levels : 1);
  }
  return parts;
}

std::string bytesOfFile(const Grids& grids, std::optional<Compression> compression) {
  return test::bytesOf({grids, compression, {}});
}

/// Part files in a folder.
Files writeParts(const test::TemporaryFolder& folder, const std::vector<Grids>& parts,
                 std::optional<Compression> compression) {
  Files files;
  for (const Grids& part : parts)
    files.push_back(folder.write("part" + std::to_string(files.size() + 1) + ".vdb",
                                 bytesOfFile(part, compression)));
  return files;
}

std::string merged(const Files& files, const MergeOptions& options = {}) {
  std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
  mergeVdb(stream, files, options);
  return stream.str();
}

std::string mergedParts(const Conversion& whole, const std::vector<Brick>& cuts) {
  const test::TemporaryFolder folder;
  return merged(writeParts(folder, partsOf(whole, cuts), whole.compression));
}

/// Ascending bricks, at random, near those that the conversion has. Some may be the same.
std::vector<Brick> randomCuts(const Conversion& whole, std::size_t count, std::mt19937& random) {
  const std::set<Brick> bricks = bricksOf(whole.grids);
  std::vector<Brick> cuts;
  while (cuts.size() < count) {
    auto brick = bricks.begin();
    std::advance(brick, random() % bricks.size());
    cuts.emplace_back(brick->first, brick->second + random() % 2);
  }
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

/// Two bodies on both sides of all coordinate planes, three bricks along each side.
Conversion bodies(ConvertOptions options) {
  Scene scene = test::sceneOf({test::torusGrid(12, 8), test::moved(test::cube(), {1, 0.5, 0.3})});
  options.dim = 300;
  return convert(scene, options);
}

Conversion allGrids(Fill fill) {
  ConvertOptions options;
  options.grids = {GridKind::kMask,   GridKind::kDensity, GridKind::kSurface,
                   GridKind::kNormal, GridKind::kColor,   GridKind::kPart};
  options.texture = parseTexture("checker");
  options.volume.fill = fill;
  Conversion whole = bodies(options);
  return whole;
}

Conversion maskOnly() {
  ConvertOptions options;
  options.grids = {GridKind::kMask};
  return bodies(options);
}

/// Grids that are no conversion, as if they were one.
Conversion asConversion(Grids grids) {
  for (const auto& grid : grids) {
    grid->insertMeta("vox_active_voxels", Int64Metadata(1000));
    grid->insertMeta("vox_levels", Int32Metadata(7));
  }
  return {std::move(grids), {}, {}};
}

/// Several parts of a mask, for faults.
class MaskParts {
 public:
  MaskParts() {
    std::mt19937 random(7);
    parts_ = partsOf(whole_, randomCuts(whole_, 3, random));
    write();
  }

  std::string whole() const { return test::bytesOf(whole_); }
  Grids& grids(std::size_t i) { return parts_[i]; }
  Files files() const { return files_; }
  void write() { files_ = writeParts(folder_, parts_, {}); }
  const test::TemporaryFolder& folder() const { return folder_; }

  /// The error that merging the files gives.
  std::string errorOf(const Files& files, const MergeOptions& options = {}) const {
    try {
      merged(files, options);
    } catch (const InputError& error) {
      std::string text = error.what();
      const std::string prefix = folder_.path().string() + "/";
      for (std::size_t at; (at = text.find(prefix)) != std::string::npos;)
        text.erase(at, prefix.size());
      return text;
    }
    return {};
  }
  std::string error() const { return errorOf(files_); }

 private:
  test::TemporaryFolder folder_;
  Conversion whole_ = maskOnly();
  std::vector<Grids> parts_;
  Files files_;
};

template <class GridT>
typename GridT::Ptr gridNamed(const char* name, const typename GridT::ValueType& background) {
  auto grid = GridT::create(background);
  grid->setName(name);
  return grid;
}

std::filesystem::path writeGrid(const test::TemporaryFolder& folder, const std::string& name,
                                const Grids& grids) {
  std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
  writeVdb(stream, grids, {});
  return folder.write(name, stream.str());
}

/// Merges files and reads the result.
VdbFile readMerged(const test::TemporaryFolder& folder, const Files& files) {
  return readVdb(folder.write("merged.vdb", merged(files)));
}

}  // namespace

TEST_CASE("merged parts have the bytes of the whole file", "[merge][property]") {
  const Conversion whole = allGrids(GENERATE(Fill::kSurface, Fill::kSolid));
  const std::string bytes = test::bytesOf(whole);
  std::mt19937 random(1);
  for (const std::size_t cuts : {0, 1, 2, 6}) {
    CAPTURE(cuts);
    const bool same = mergedParts(whole, randomCuts(whole, cuts, random)) == bytes;
    CHECK(same);
  }
}

TEST_CASE("every cut between bricks gives the bytes of the whole file", "[merge][property]") {
  const Conversion whole = maskOnly();
  const std::string bytes = test::bytesOf(whole);
  for (const Brick& brick : bricksOf(whole.grids)) {
    const bool same = mergedParts(whole, {brick}) == bytes;
    CHECK(same);
  }
}

TEST_CASE("more parts than bricks are merged, in any order and on any number of threads",
          "[merge][parallel]") {
  const Conversion whole = maskOnly();
  const std::string bytes = test::bytesOf(whole);
  std::mt19937 random(2);
  const test::TemporaryFolder folder;
  Files files = writeParts(folder, partsOf(whole, randomCuts(whole, 63, random)), {});
  std::shuffle(files.begin(), files.end(), random);
  for (const int threads : {1, 2, 8}) {
    const bool same = onThreads(threads, [&] { return merged(files) == bytes; });
    CHECK(same);
  }
}

TEST_CASE("compression and half floats of parts are those of the whole", "[merge]") {
  ConvertOptions options;
  options.grids = {GridKind::kDensity, GridKind::kSurface, GridKind::kNormal, GridKind::kMask};
  options.volume.edge = Edge::kSoft;
  options.volume.half = GENERATE(false, true);
  options.volume.compression =
      GENERATE(Compression::kBlosc, Compression::kZip, Compression::kPlain);
  CAPTURE(*options.volume.half, nameIn(kCompressionNames, *options.volume.compression));
  const Conversion whole = bodies(options);
  std::mt19937 random(3);
  const bool same = mergedParts(whole, randomCuts(whole, 4, random)) == test::bytesOf(whole);
  CHECK(same);
}

TEST_CASE("tiles of all sizes are merged", "[merge]") {
  openvdb::initialize();
  auto mask = gridNamed<openvdb::MaskGrid>("mask", false);
  auto distance = gridNamed<openvdb::FloatGrid>("distance", 3);
  auto label = gridNamed<openvdb::Int32Grid>("label", -1);
  for (const auto level : {1U, 2U, 3U}) {
    const Coord at(-5000 + 4096 * static_cast<int>(level), 100, -9000);
    mask->tree().addTile(level, at, true, true);
    distance->tree().addTile(level, at, -3, false);
    label->tree().addTile(level, at, 7, true);
  }
  mask->tree().setValueOn({-5000, 100, -9000});
  distance->tree().setValueOn({4000, -200, 900}, 1.5F);
  distance->setGridClass(openvdb::GRID_LEVEL_SET);
  const Conversion whole = asConversion({mask, distance, label});
  const std::string bytes = test::bytesOf(whole);
  std::mt19937 random(4);
  for (int i = 0; i < 10; ++i) {
    const bool same = mergedParts(whole, randomCuts(whole, 3, random)) == bytes;
    CHECK(same);
  }
}

TEST_CASE("parts without any voxel give empty grids", "[merge]") {
  openvdb::initialize();
  Conversion whole{
      {gridNamed<openvdb::MaskGrid>("mask", false), gridNamed<openvdb::FloatGrid>("density", 0)},
      {},
      {}};
  const Brick middle = {Coord(0), 0};
  const bool same = mergedParts(whole, {middle, middle}) == test::bytesOf(whole);
  CHECK(same);
}

TEST_CASE("a merge tells grids, voxels and the number of parts", "[merge]") {
  const MaskParts parts;
  std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
  const MergeReport report = mergeVdb(stream, parts.files());
  const bool same = stream.str() == parts.whole();
  CHECK(same);
  CHECK(report.partCount == 4);
  CHECK(report.missing.empty());
  REQUIRE(report.grids.size() == 1);
  CHECK(report.grids[0].name == "mask");
  CHECK(report.grids[0].activeVoxels == maskOnly().grids[0]->activeVoxelCount());
}

TEST_CASE("missing parts are named, and left out on demand", "[merge][error]") {
  const MaskParts parts;
  Files files = parts.files();
  files.erase(files.begin() + 1);
  CHECK(parts.errorOf(files) ==
        "part1.vdb: is one of 4 parts, of which part 2 is missing; --partial merges the others");
  files.pop_back();
  CHECK(parts.errorOf(files) ==
        "part1.vdb: is one of 4 parts, of which parts 2, 4 are missing; --partial merges the "
        "others");
  std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
  const MergeReport report = mergeVdb(stream, files, {.partial = true});
  CHECK(report.missing == std::vector{2, 4});
  const VdbFile file = readVdb(parts.folder().write("whole.vdb", stream.str()));
  CHECK((*file.grids[0].grid)["vox_part"] == nullptr);
  CHECK((*file.grids[0].grid)["vox_parts"] == nullptr);
}

TEST_CASE("numbers of parts are written as ranges", "[merge]") {
  CHECK(partsText({3}) == "part 3");
  CHECK(partsText({1, 2}) == "parts 1-2");
  CHECK(partsText({1, 3, 4, 5, 9}) == "parts 1, 3-5, 9");
}

TEST_CASE("a part that is there twice is refused", "[merge][error]") {
  MaskParts parts;
  Files files = parts.files();
  files.push_back(parts.folder().write("again.vdb", test::contentOf(files[2])));
  CHECK(parts.errorOf(files) == "again.vdb: is part 3 of 4, which is in part3.vdb, too");
  describePart(parts.grids(1), 5, 4, 1, 1);
  parts.write();
  CHECK(parts.error() == "part2.vdb: is part 5 of 4, which cannot be");
}

TEST_CASE("a part of another conversion is refused, whichever it is", "[merge][error]") {
  const std::size_t i = GENERATE(0U, 1U, 3U);
  MaskParts parts;
  openvdb::GridBase& grid = *parts.grids(i)[0];
  const std::string start = "part" + std::to_string(i + 1) +
                            ".vdb: is of another conversion than " + (i == 0 ? "part2" : "part1") +
                            ".vdb: it has ";
  const auto insertText = [&](const char* key) {
    grid.insertMeta(key, openvdb::StringMetadata("other"));
  };
  SECTION("input") {
    insertText("vox_input_hash");
    parts.write();
    CHECK(parts.error() == start + "another input");
  }
  SECTION("options") {
    insertText("vox_options");
    parts.write();
    CHECK(parts.error() == start + "other options");
  }
  SECTION("version") {
    insertText("vox_version");
    parts.write();
    CHECK(parts.error() == start + "another version of vox");
  }
  SECTION("transform") {
    grid.setTransform(openvdb::math::Transform::createLinearTransform(0.7));
    parts.write();
    CHECK(parts.error() == start + "another transform");
  }
  SECTION("grids") {
    grid.setName("surface");
    parts.write();
    CHECK(parts.error() == start + "other grids");
  }
  SECTION("one grid more") {
    parts.grids(i).push_back(grid.deepCopyGrid());
    parts.grids(i).back()->setName("more");
    parts.write();
    CHECK(parts.error() == start + "other grids");
  }
  SECTION("type") {
    grid.setSaveFloatAsHalf(true);
    parts.write();
    CHECK(parts.error() == start + "other types of grids");
  }
  SECTION("compression") {
    Files files = parts.files();
    files[i] =
        parts.folder().write(files[i].filename(), bytesOfFile(parts.grids(i), Compression::kZip));
    CHECK(parts.errorOf(files) == start + "another compression");
  }
}

TEST_CASE("a file that is no part of a conversion is refused among parts", "[merge][error]") {
  const MaskParts parts;
  Files files = parts.files();
  const std::string end = ": is not a part as vox convert --part writes it, but part1.vdb is";
  SECTION("the whole") {
    files.insert(files.begin(), parts.folder().write("whole.vdb", parts.whole()));
    CHECK(parts.errorOf(files) == "whole.vdb" + end);
  }
  SECTION("of another program") {
    std::string bytes = test::contentOf(files[3]);
    bytes[21 + 14] = '4';  // a random UUID
    files[3] = parts.folder().write("foreign.vdb", bytes);
    CHECK(parts.errorOf(files) == "foreign.vdb" + end);
  }
  SECTION("another kind of file") {
    files[2] = parts.folder().write("text.vdb", "no grids");
    CHECK(parts.errorOf(files) == "text.vdb: is not an OpenVDB file");
  }
  SECTION("no file") {
    files[2] = parts.folder() / "none.vdb";
    CHECK(parts.errorOf(files) == "none.vdb: no such file; check the path");
  }
}

TEST_CASE("a damaged or truncated part is refused", "[merge][error][property]") {
  const MaskParts parts;
  std::mt19937 random(5);
  for (int i = 0; i < 60; ++i) {
    Files files = parts.files();
    std::string bytes = test::contentOf(files[1]);
    const std::size_t at = random() % bytes.size();
    if (i % 2 == 0)
      bytes.resize(at);
    else
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
    files[1] = parts.folder().write("bad.vdb", bytes);
    CAPTURE(i, at);
    CHECK(parts.errorOf(files).starts_with("bad.vdb: "));
  }
}

TEST_CASE("parts whose voxels overlap or are out of order are refused", "[merge][error]") {
  MaskParts parts;
  SECTION("the same voxels") {
    std::swap(parts.grids(2)[0], parts.grids(1)[0]);
    parts.grids(2)[0] = parts.grids(1)[0]->deepCopyGrid();
    describePart(parts.grids(1), 2, 4, 1, 1);
    describePart(parts.grids(2), 3, 4, 1, 1);
    parts.write();
    CHECK(parts.error() == "part3.vdb: has voxels of the part part2.vdb in the grid mask");
  }
  SECTION("swapped") {
    describePart(parts.grids(0), 4, 4, 1, 1);
    describePart(parts.grids(3), 1, 4, 1, 1);
    parts.write();
    CHECK_THAT(parts.error(), Catch::Contains("has voxels of the part part"));
  }
}

TEST_CASE("metadata that differ between parts are refused", "[merge][error]") {
  MaskParts parts;
  parts.grids(2)[0]->insertMeta("vox_gain", openvdb::FloatMetadata(1));
  parts.grids(3)[0]->insertMeta("vox_gain", openvdb::FloatMetadata(2));
  parts.write();
  CHECK(parts.error() ==
        "part4.vdb: has another value of the metadata vox_gain than the parts before it");
}

TEST_CASE("parts of one grid with packed and plain values, or two backgrounds, are refused",
          "[merge][error]") {
  openvdb::initialize();
  auto density = gridNamed<openvdb::FloatGrid>("density", 0);
  density->setGridClass(openvdb::GRID_FOG_VOLUME);  // never zipped, but the file says so
  density->tree().setValueOn({0, 0, 0}, 1);
  density->tree().setValueOn({200, 0, 0}, 1);
  const MaskParts parts;  // for its folder
  const auto halves = partsOf(asConversion({density}), {{Coord(0), 1}});
  const auto& folder = parts.folder();
  CHECK(parts.errorOf({folder.write("a.vdb", bytesOfFile(halves[0], Compression::kZip)),
                       folder.write("b.vdb", bytesOfFile(halves[1], Compression::kPlain))}) ==
        "b.vdb: has another compression than the parts before it");
  for (const auto& grid : halves[1])
    openvdb::gridPtrCast<openvdb::FloatGrid>(grid)->tree().root().setBackground(2, true);
  CHECK(parts.errorOf({folder.write("a.vdb", bytesOfFile(halves[0], Compression::kZip)),
                       folder.write("b.vdb", bytesOfFile(halves[1], Compression::kZip))}) ==
        "b.vdb: has another background than the parts before it");
}

TEST_CASE("too little memory for the nodes is an error", "[merge][error]") {
  const MaskParts parts;
  CHECK_THROWS_AS(merged(parts.files(), {.partial = false, .maxMemory = 100000}), LimitError);
}

TEST_CASE("grids of other files are united by name", "[merge]") {
  openvdb::initialize();
  const test::TemporaryFolder folder;
  const auto gridsAt = [](int x) {
    auto mask = gridNamed<openvdb::MaskGrid>("mask", false);
    auto density = gridNamed<openvdb::FloatGrid>("density", 0);
    density->setGridClass(openvdb::GRID_FOG_VOLUME);
    for (int i = x; i < x + 10; ++i) {
      mask->tree().setValueOn({i, 0, 0});
      density->tree().setValueOn({i, 0, 0}, static_cast<float>(x + 1));
    }
    density->insertMeta("only", openvdb::Int32Metadata(x));
    density->insertMeta("same", openvdb::Int32Metadata(1));
    return Grids{mask, density};
  };
  auto extra = gridNamed<openvdb::DoubleGrid>("extra", 0);
  const Grids second = gridsAt(5);
  const Files files = {writeGrid(folder, "a.vdb", gridsAt(0)),
                       writeGrid(folder, "b.vdb", {extra, second[1], second[0]})};
  std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
  const MergeReport report = mergeVdb(stream, files);
  CHECK(report.partCount == 0);
  REQUIRE(report.grids.size() == 3);
  CHECK(report.grids[0].name == "mask");
  CHECK(report.grids[1].name == "density");
  CHECK(report.grids[2].name == "extra");
  CHECK(report.grids[0].activeVoxels == 15);
  const VdbFile all = readVdb(folder.write("all.vdb", stream.str()));
  REQUIRE(all.grids.at(0).name == "density");
  const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(all.grids[0].grid);
  CHECK(density->activeVoxelCount() == 15);
  CHECK(density->tree().getValue({4, 0, 0}) == 1);
  CHECK(density->tree().getValue({5, 0, 0}) == 6);  // the larger of two
  CHECK(density->tree().getValue({20, 0, 0}) == 0);
  CHECK((*density)["only"] == nullptr);
  CHECK((*density)["same"] != nullptr);
}

TEST_CASE("level sets of other files are united", "[merge]") {
  const test::TemporaryFolder folder;
  const auto levelSet = [](double x) {
    ConvertOptions options;
    options.voxelSize = 0.1;
    options.grids = {GridKind::kSurface};
    return convert(test::oneObject(test::moved(test::dodecahedron(), {x, 0, 0})), options).grids;
  };
  const Grids a = levelSet(0);
  const Grids b = levelSet(0.7);
  const VdbFile all =
      readMerged(folder, {writeGrid(folder, "a.vdb", a), writeGrid(folder, "b.vdb", b)});
  REQUIRE(all.grids.size() == 1);
  const auto valueOf = [](const openvdb::GridBase::Ptr& grid, const Coord& at) {
    return openvdb::gridPtrCast<openvdb::FloatGrid>(grid)->tree().getValue(at);
  };
  for (int x = -25; x < 35; ++x)
    for (int y = -25; y < 25; ++y) {
      const Coord at(x, y, 3);
      CHECK(valueOf(all.grids[0].grid, at) == std::min(valueOf(a[0], at), valueOf(b[0], at)));
    }
}

TEST_CASE("grids that cannot be united are refused", "[merge][error]") {
  openvdb::initialize();
  const MaskParts parts;  // for its folder
  const auto& folder = parts.folder();
  const auto error = [&](const openvdb::GridBase::Ptr& a, const openvdb::GridBase::Ptr& b) {
    return parts.errorOf({writeGrid(folder, "a.vdb", {a}), writeGrid(folder, "b.vdb", {b})});
  };
  const std::string start = "b.vdb: the grid x is also in a.vdb";
  auto a = gridNamed<openvdb::FloatGrid>("x", 0);
  auto b = gridNamed<openvdb::FloatGrid>("x", 0);
  CHECK(error(a, b).empty());
  SECTION("type") {
    CHECK_THAT(error(a, gridNamed<openvdb::MaskGrid>("x", false)),
               Catch::StartsWith(start + " and has another type"));
  }
  SECTION("class") {
    b->setGridClass(openvdb::GRID_LEVEL_SET);
    CHECK_THAT(error(a, b), Catch::StartsWith(start + " and has another class"));
  }
  SECTION("transform") {
    b->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    CHECK(error(a, b) ==
          start + " and has another transform; convert one with --like of the other");
  }
  SECTION("background") {
    CHECK_THAT(error(a, gridNamed<openvdb::FloatGrid>("x", 1)),
               Catch::StartsWith(start + ": only masks, and floats of one background"));
  }
  SECTION("vectors") {
    const auto vectors = gridNamed<openvdb::Vec3SGrid>("x", openvdb::Vec3s(0, 0, 0));
    CHECK_THAT(error(vectors, vectors), Catch::StartsWith(start + ": only masks"));
  }
  SECTION("no grids") {
    CHECK(parts.errorOf({writeGrid(folder, "none.vdb", {})}) == "none.vdb: has no grids");
  }
}

TEST_CASE("a single file that is no part keeps its grids", "[merge]") {
  const test::TemporaryFolder folder;
  const Conversion whole = maskOnly();
  const bool same =
      merged({folder.write("whole.vdb", test::bytesOf(whole))}) == test::bytesOf(whole);
  CHECK(same);
}
