#include "libvox/core/markup.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/write_vdb.h"
#include "libvox/report/best_views.h"
#include "libvox/report/check_report.h"
#include "libvox/report/clusters.h"
#include "libvox/report/diff_report.h"
#include "libvox/report/difference_look.h"
#include "libvox/report/grid_pictures.h"
#include "libvox/report/histogram.h"
#include "libvox/report/html.h"
#include "libvox/report/page.h"
#include "libvox/report/point_cloud.h"
#include "libvox/report/sample_voxels.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

#include <array>
#include <fstream>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

using namespace vox;
using Catch::Contains;
using openvdb::Coord;
using openvdb::CoordBBox;

namespace {

/// A block of voxels with the value 1.
openvdb::FloatGrid::Ptr block(const CoordBBox& box) {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(0);
  grid->setName("density");
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
  grid->tree().fill(box, 1.0F, true);
  grid->tree().voxelizeActiveTiles();
  return grid;
}

const CoordBBox kBox(Coord(-10, -10, -10), Coord(9, 9, 9));

std::filesystem::path save(const test::TemporaryFolder& folder, const std::string& name,
                           const openvdb::GridBase::Ptr& grid) {
  std::fstream stream(folder / name,
                      std::ios::in | std::ios::out | std::ios::trunc | std::ios::binary);
  writeVdb(stream, {grid}, openvdb::MetaMap());
  return folder / name;
}

Comparison compared(const std::filesystem::path& a, const std::filesystem::path& b) {
  Comparison comparison;
  comparison.a = a.string();
  comparison.b = b.string();
  comparison.command = {"vox", "diff", "a.vdb", "b.vdb"};
  FilePairDiff files;
  files.name = comparison.a;
  files.inA = files.inB = true;
  files.diff = diffVdb(a, b, {});
  comparison.files = {files};
  return comparison;
}

std::string reportOf(const openvdb::GridBase::Ptr& a, const openvdb::GridBase::Ptr& b) {
  static const test::TemporaryFolder folder;  // its name is in the report
  const auto fileA = save(folder, "a.vdb", a);
  const auto fileB = save(folder, "b.vdb", b);
  return diffReport(compared(fileA, fileB));
}

/// Pixels by what stands out: red, blue, or yellow to green; else grey.
struct Hues {
  int red = 0, blue = 0, value = 0, grey = 0;
};

Hues huesOf(const Image& image) {
  Hues hues;
  for (const auto& [r, g, b, coverage] : image.pixels) {
    if (coverage == 0) continue;
    const int least = std::min({r, g, b});
    const int most = std::max({r, g, b});
    if (most - least < 30)
      ++hues.grey;
    else if (g > b + 30 && g > r - 30)
      ++hues.value;
    else if (r == most)
      ++hues.red;
    else if (b == most)
      ++hues.blue;
  }
  return hues;
}

std::vector<Picture> picturesOf(const openvdb::FloatGrid::Ptr& a,
                                const openvdb::FloatGrid::Ptr& b) {
  const DifferenceLook look(*a, *b, {});
  return differencePictures(a, b, look,
                            bestViews(look.differing(), look.all(), a->transform(), kReportUp));
}

/// Points as viewer.js reads them: a voxel, and the byte of its look.
std::map<Coord, unsigned> decoded(const PointCloud& cloud) {
  std::size_t next = 0;
  const auto byte = [&] { return static_cast<unsigned char>(cloud.bytes.at(next++)); };
  const auto number = [&] {
    std::int64_t value = 0;
    for (unsigned shift = 0;; shift += 7) {
      const unsigned digit = byte();
      value += static_cast<std::int64_t>(digit % 128) << shift;
      if (digit < 128) break;
    }
    return static_cast<std::int32_t>(value % 2 == 0 ? value / 2 : -(value + 1) / 2);
  };
  std::map<Coord, unsigned> points;
  Coord at = cloud.box.min();
  for (std::uint64_t i = 0; i < cloud.differing + cloud.common; ++i) {
    for (int axis = 0; axis < 3; ++axis) at[axis] += number();
    points[at] = byte();
  }
  CHECK(next == cloud.bytes.size());
  return points;
}

}  // namespace

TEST_CASE("text in a report is text", "[report]") {
  CHECK(escaped("a<b> & 'c' \"d\"") == "a&lt;b&gt; &amp; 'c' &quot;d&quot;");
  CHECK(escaped("Grün \u2192 \U0001F600\n") == "Grün \u2192 \U0001F600\n");
  const std::string unknown = "\uFFFD";
  CHECK(escaped(std::string("\x01\0\x7F", 3)) == unknown + unknown + unknown);
  CHECK(escaped("\xC0\xAF") == unknown + unknown);                // overlong
  CHECK(escaped("\xED\xA0\x80") == unknown + unknown + unknown);  // a surrogate
  CHECK(escaped("\xF5\x80\x80\x80") == unknown + unknown + unknown + unknown);
  CHECK(escaped("a\xE2\x82") == 'a' + unknown + unknown);  // cut off
}

TEST_CASE("the value of an attribute keeps its line ends", "[report]") {
  CHECK(escapedValue("a\n\"b\"\t<c>") == "\"a&#10;&quot;b&quot;&#9;&lt;c&gt;\"");
}

TEST_CASE("base64 is that of RFC 4648", "[report]") {
  CHECK(base64("").empty());
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foob") == "Zm9vYg==");
  CHECK(base64("fooba") == "Zm9vYmE=");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64("\xFF\xFE\xFD") == "//79");
}

TEST_CASE("the command of a report can be pasted into a shell", "[report]") {
  CHECK(shellLine({"vox", "diff", "a.vdb", "it's $b.vdb", "", "#x"}) ==
        R"(vox diff a.vdb 'it'\''s $b.vdb' '' '#x')");
}

TEST_CASE("samples of voxels are even, also within tiles", "[report]") {
  openvdb::MaskTree tree;
  tree.fill(CoordBBox(Coord(0, 0, 0), Coord(63, 7, 7)), true);  // tiles
  tree.setValueOn(Coord(100, 0, 0));
  CHECK(tree.activeTileCount() > 0);
  const auto all = sampleVoxels(tree, 1U << 20U);
  CHECK(all.size() == 64 * 8 * 8 + 1);
  CHECK(std::set<Coord>(all.begin(), all.end()).size() == all.size());
  const auto some = sampleVoxels(tree, 100);
  CHECK(some.size() <= 100);
  CHECK(some.size() > 90);
  for (const Coord& voxel : some) CHECK(tree.isValueOn(voxel));
  CHECK(sampleVoxels(openvdb::MaskTree(), 10).empty());
}

TEST_CASE("a histogram counts every value once", "[report]") {
  openvdb::FloatTree values;
  for (int i = 1; i <= 1000; ++i) values.setValueOn(Coord(i, 0, 0), static_cast<float>(i) / 1000);
  values.setValueOn(Coord(0, 0, 0), std::numeric_limits<float>::infinity());
  const Histogram wide = histogramOf(values);  // 0.001 to 1
  CHECK(std::accumulate(wide.counts.begin(), wide.counts.end(), std::uint64_t{0}) == 1000);
  CHECK(wide.notFinite == 1);
  CHECK(wide.bounds.front() == Approx(0.001));
  CHECK(wide.bounds.back() == 1);
  CHECK(wide.bounds[1] / wide.bounds[0] == Approx(wide.bounds[2] / wide.bounds[1]));
  for (int i = 1; i <= 1000; ++i)
    values.setValueOn(Coord(i, 0, 0), 0.5F + static_cast<float>(i) / 2000);
  const Histogram narrow = histogramOf(values);
  CHECK(narrow.bounds.front() == 0);
  CHECK(narrow.counts.front() == 0);
  CHECK(narrow.counts.back() == Approx(1000.0 / 12).margin(2));
  CHECK(histogramFigure(histogramOf(openvdb::FloatTree())).empty());
}

TEST_CASE("the best view shows what differs", "[report]") {
  const auto solid = block(kBox);
  const openvdb::MaskTree all(solid->tree(), false, true, openvdb::TopologyCopy());
  const auto toVoxel = [&](const Coord& voxel) {
    openvdb::MaskTree one;
    one.setValueOn(voxel);
    const View view = bestViews(one, all, solid->transform(), UpAxis::kZ).front();
    return Vec3d(axesOf(view, UpAxis::kZ).forward);
  };
  CHECK(toVoxel(Coord(9, 0, 0)).x() < -0.1);  // seen from +x
  CHECK(toVoxel(Coord(-10, 0, 0)).x() > 0.1);
  CHECK(toVoxel(Coord(0, 9, 0)).y() < -0.1);
  CHECK(toVoxel(Coord(0, -10, 0)).y() > 0.1);
  CHECK(toVoxel(Coord(0, 0, 9)).z() < -0.1);
  CHECK(toVoxel(Coord(0, 0, -10)).z() > 0.1);
  openvdb::MaskTree hidden;
  hidden.setValueOn(Coord(0, 0, 0));
  CHECK(bestViews(hidden, all, solid->transform(), UpAxis::kZ).size() == 2);
}

TEST_CASE("one voxel is seen in the pictures, wherever it lies", "[report]") {
  const auto a = block(kBox);
  const Coord voxel = GENERATE(Coord(9, 9, 9), Coord(-10, 3, 2), Coord(0, 0, 0));
  auto b = block(kBox);
  b->tree().setValueOff(voxel, 0);
  for (const bool isInA : {true, false}) {
    const auto pictures = isInA ? picturesOf(a, b) : picturesOf(b, a);
    REQUIRE(pictures.size() == 5);  // A, B, twice the difference, a close-up
    CHECK(huesOf(pictures[0].image).red + huesOf(pictures[0].image).blue == 0);
    for (std::size_t i : {2, 4}) {
      const Hues hues = huesOf(pictures[i].image);
      CHECK((isInA ? hues.red : hues.blue) > 20);
      CHECK((isInA ? hues.blue : hues.red) == 0);
      CHECK(hues.value == 0);
    }
    REQUIRE(pictures[2].marks.size() == 1);
    const auto& [x, y] = pictures[2].marks.front();
    const Image& image = pictures[2].image;
    const Pixel& marked =
        image.at(static_cast<int>(x * image.width), static_cast<int>(y * image.height));
    CHECK(std::max({marked[0], marked[1], marked[2]}) -
              std::min({marked[0], marked[1], marked[2]}) >
          30);
  }
  b = block(kBox);
  b->tree().setValueOnly(voxel, 0.5F);
  CHECK(huesOf(picturesOf(a, b)[2].image).value > 20);
}

TEST_CASE("the points of the viewer are the voxels that differ", "[report]") {
  const auto a = block(kBox);
  const auto b = block(kBox);
  b->tree().setValueOff(Coord(3, 4, 5), 0);
  b->tree().setValueOn(Coord(-70, 200, 3), 1);
  b->tree().setValueOnly(Coord(0, 0, 0), 0.25F);
  b->tree().setValueOnly(Coord(0, 0, 1), -0.5F);
  const DifferenceLook look(*a, *b, {});
  const PointCloud cloud = pointsOf(look, 100000);
  CHECK(cloud.differing == 4);
  CHECK(cloud.common == kBox.volume() - 3);
  const auto points = decoded(cloud);
  CHECK(points.size() == kBox.volume() + 1);
  CHECK(points.at(Coord(3, 4, 5)) == 1U << 6U);
  CHECK(points.at(Coord(-70, 200, 3)) == 2U << 6U);
  CHECK(points.at(Coord(0, 0, 0)) == (3U << 6U | 32U));  // half of 1.5
  CHECK(points.at(Coord(0, 0, 1)) == (3U << 6U | 63U));
  CHECK(points.at(Coord(1, 1, 1)) == 0);

  const PointCloud few = pointsOf(look, 2);
  CHECK(few.differing == 2);
  CHECK(few.step == 2);
  CHECK(few.common == 0);
}

TEST_CASE("a picture of half the size has the means of its pixels", "[report]") {
  Image image(4, 2);
  image.at(0, 0) = {10, 20, 30, 255};
  image.at(1, 0) = {30, 20, 10, 255};
  image.at(2, 0) = {8, 8, 8, 255};  // beside pixels that are not covered
  const Image smaller = halved(image);
  REQUIRE((smaller.width == 2 && smaller.height == 1));
  CHECK(smaller.at(0, 0) == Pixel{20, 20, 20, 127});
  CHECK(smaller.at(1, 0) == Pixel{8, 8, 8, 63});
}

TEST_CASE("planted differences are named in the report", "[report]") {
  const auto a = block(kBox);
  auto b = block(kBox);
  SECTION("none") {
    const std::string report = reportOf(a, b);
    CHECK_THAT(report, Contains(">The same</h1>"));
    CHECK_THAT(report, !Contains("<figure>"));
  }
  SECTION("a voxel") {
    b->tree().setValueOff(Coord(-10, 3, 2), 0);
    const std::string report = reportOf(a, b);
    CHECK_THAT(report, Contains(">Different</h1>"));
    CHECK_THAT(report, Contains("1 voxel only in A, 0 voxels only in B"));
    CHECK_THAT(report, Contains("voxel (-10 3 2)"));
    CHECK_THAT(report, Contains("<pre>vox diff a.vdb b.vdb</pre>"));
    CHECK_THAT(report, Contains("class=\"viewer\""));
  }
  SECTION("a shifted part") {
    b = block(CoordBBox(kBox.min(), kBox.max().offsetBy(0, 0, 2)));
    const std::string report = reportOf(a, b);
    CHECK_THAT(report, Contains("0 voxels only in A, 800 voxels only in B"));
    CHECK_THAT(report, Contains("up to 2 voxels away"));
  }
  SECTION("a value") {
    b->tree().setValueOnly(Coord(1, 2, 3), 0.5F);
    const std::string one = reportOf(a, b);
    CHECK_THAT(one, Contains("Values: 1 of 8,000 differ, by up to 0.5"));
    CHECK_THAT(one, Contains("All values differ by 0.5."));
    b->tree().setValueOnly(Coord(1, 2, 4), 0.25F);
    const std::string two = reportOf(a, b);
    CHECK_THAT(two, Contains("Values: 2 of 8,000 differ, by up to 0.75"));
    CHECK_THAT(two, Contains("class=\"bars\""));
  }
  SECTION("another name") {
    b->setName("other");
    const std::string report = reportOf(a, b);
    CHECK_THAT(report, Contains("only in A"));
    CHECK_THAT(report, Contains("only in B"));
    CHECK_THAT(report, Contains("<figure>"));
  }
  SECTION("a transform") {
    b->setTransform(openvdb::math::Transform::createLinearTransform(0.11));
    const std::string report = reportOf(a, b);
    CHECK_THAT(report, Contains("voxel size 0.11 0.11 0.11"));
    CHECK_THAT(report, Contains("In world space"));
    const auto overlay = overlayPictures(*a, *b, *lookOf(a), *lookOf(b));
    REQUIRE(overlay.size() == 2);
    for (const Picture& picture : overlay) {
      CHECK(huesOf(picture.image).blue > 50);  // B is larger
      CHECK(huesOf(picture.image).grey > 50);
    }
  }
  SECTION("metadata") {
    b->insertMeta("author", openvdb::StringMetadata("<script>alert(1)</script>"));
    const std::string report = reportOf(a, b);
    CHECK_THAT(report, Contains("&lt;script&gt;alert(1)&lt;/script&gt;"));
    CHECK_THAT(report, !Contains("<script>alert"));
  }
  SECTION("a type") {
    auto doubles = openvdb::DoubleGrid::create(0);
    doubles->setName("density");
    doubles->setTransform(a->transform().copy());
    doubles->tree().fill(kBox, 1.0, true);
    CHECK_THAT(reportOf(a, doubles), Contains("Tree_double_5_4_3"));
  }
  SECTION("no voxels") {
    b = block(CoordBBox());
    b->tree().clear();
    CHECK_THAT(reportOf(a, b), Contains("The other grid has no voxels."));
  }
}

TEST_CASE("a report tells of voxels that moved within the tolerance", "[report]") {
  const test::TemporaryFolder folder;
  const auto fileA = save(folder, "a.vdb", block(kBox));
  const auto fileB =
      save(folder, "b.vdb", block(CoordBBox(kBox.min(), kBox.max().offsetBy(0, 0, 2))));
  Comparison comparison = compared(fileA, fileB);
  comparison.options.voxelTolerance = 2;
  comparison.files[0].diff = diffVdb(fileA, fileB, comparison.options);
  const std::string report = diffReport(comparison);
  CHECK_THAT(report, Contains(">The same</h1>"));
  CHECK_THAT(report, Contains("same within 2 voxels"));
  CHECK_THAT(report, Contains("800 voxels only in B"));
  CHECK_THAT(report, Contains("Up to 2 are allowed."));
  CHECK_THAT(report, Contains("<figure>"));
}

TEST_CASE("a report of many files has less than 2 MB", "[report]") {
  Comparison comparison;
  comparison.areFolders = true;
  for (int i = 0; i < 20000; ++i) {
    FilePairDiff file;
    file.name = std::to_string(i) + ".vdb";
    file.inA = file.inB = true;
    if (i % 2 == 0) file.error = file.name + ": " + std::string(100, 'x');
    comparison.files.push_back(file);
  }
  const std::string report = diffReport(comparison);
  CHECK(report.size() < 2000000);
  CHECK_THAT(report, Contains("20,000 files: 10,000 not compared, 10,000 same."));
  CHECK_THAT(report, Contains("There was no room for the files from here on."));
}

TEST_CASE("a report is no verdict on files that cannot be read", "[report]") {
  Comparison comparison;
  comparison.areFolders = true;
  comparison.files.emplace_back();
  comparison.files[0].inA = comparison.files[0].inB = true;
  comparison.files[0].error = "damaged.vdb: <b>";
  const std::string report = diffReport(comparison);
  CHECK_THAT(report, Contains(">Not all could be compared</h1>"));
  CHECK_THAT(report, Contains("damaged.vdb: &lt;b&gt;"));
}

TEST_CASE("a report of huge tiles needs no memory for their voxels", "[report]") {
  openvdb::initialize();
  const auto a = openvdb::FloatGrid::create(0);
  a->setName("density");
  a->tree().addTile(3, Coord(0, 0, 0), 1.0F, true);  // 4096^3 voxels
  const auto b = openvdb::FloatGrid::create(0);
  b->setName("density");
  b->tree().setValueOn(Coord(0, 0, 0), 1.0F);
  const std::string report = reportOf(a, b);
  CHECK(report.size() < 2000000);
  CHECK_THAT(report, Contains("68,719,476,735 voxels only in A"));
  CHECK(huesOf(picturesOf(a, b)[2].image).red > 1000);

  const auto moved = a->deepCopy();
  moved->setTransform(openvdb::math::Transform::createLinearTransform(1.1));
  const std::string far = overlayPictures(*a, *moved, *lookOf(a), *lookOf(moved))[0].description;
  CHECK_THAT(far, Contains("up to 709.275 world units apart"));  // sqrt(3) 4095 / 10
}

TEST_CASE("differences of values that cannot be drawn are told", "[report]") {
  openvdb::FloatTree values;
  values.setValueOn(Coord(0, 0, 0), std::numeric_limits<float>::infinity());
  CHECK_THAT(histogramFigure(histogramOf(values)), Contains("Not finite: 1."));
  values.clear();
  values.setValueOn(Coord(0, 0, 0), 2);
  values.setValueOn(Coord(9, 0, 0), 2);
  CHECK_THAT(histogramFigure(histogramOf(values)), Contains("All values differ by 2."));
}

TEST_CASE("a report of many differences has less than 2 MB", "[report]") {
  const auto a = block(CoordBBox::createCube(Coord(0), 150));
  const auto b = block(CoordBBox::createCube(Coord(0), 150));
  std::uint32_t random = 1;
  for (auto value = b->tree().beginValueOn(); value; ++value) {
    random = random * 1664525 + 1013904223;
    if (random >> 30U == 0) value.setValueOff();
    if (random >> 30U == 1) value.setValue(static_cast<float>(random >> 8U & 0xFFU));
  }
  const std::string report = onThreads(1, [&] { return reportOf(a, b); });
  CHECK(report.size() < 2000000);
  CHECK_THAT(report, Contains("class=\"viewer\""));
  CHECK(onThreads(2, [&] { return reportOf(a, b); }) == report);
}

TEST_CASE("a report names the files that only one folder has, and links to the others",
          "[report]") {
  const test::TemporaryFolder folder;
  const auto a = block(kBox);
  const auto b = block(CoordBBox(kBox.min(), kBox.max().offsetBy(0, 0, 2)));
  for (const char* name : {"old", "new"}) std::filesystem::create_directory(folder / name);
  for (const char* file : {"old/same.vdb", "new/same.vdb", "old/<b>.vdb", "old/gone.vdb"})
    save(folder, file, a);
  save(folder, "new/<b>.vdb", b);
  folder.write("old/damaged.vdb", "nonsense");
  folder.write("new/damaged.vdb", "nonsense");
  Comparison comparison;
  comparison.a = folder / "old";
  comparison.b = folder / "new";
  comparison.areFolders = true;
  comparison.files = diffFolders(comparison.a, comparison.b, {}).files;
  const std::string report = diffReport(comparison);
  CHECK_THAT(report, Contains("4 files: 1 differs, 1 not compared, 1 only in A, 1 same."));
  CHECK_THAT(report, Contains("<a href=\"#file-0\">&lt;b&gt;.vdb</a>"));
  CHECK_THAT(report, Contains("<h2 id=\"file-0\">&lt;b&gt;.vdb</h2>"));
  CHECK_THAT(report, Contains("800 voxels only in B"));
  CHECK_THAT(report, Contains("This file is only in A."));
  CHECK_THAT(report, Contains(">not compared<"));
  CHECK_THAT(report, !Contains("id=\"file-3\""));  // the same
}

TEST_CASE("the report of a check marks the places", "[report]") {
  const auto grid = block(kBox);
  CheckedFile checked;
  checked.file = "a<b>.vdb";
  checked.command = {"vox", "check", "a<b>.vdb"};
  checked.grid = grid;
  checked.components = {{8000, {-10, -10, -10}}};
  const std::string sound = checkReport(checked);
  CHECK_THAT(sound, Contains(">No faults</h1>"));
  CHECK_THAT(sound, Contains("a&lt;b&gt;.vdb"));
  CHECK_THAT(sound, !Contains("<circle"));
  checked.findings = {{"leak", "density", "a hole", true}, {"eevee", "density", "large", false}};
  checked.places = {{9, 0, 0}};
  const std::string faulty = checkReport(checked);
  CHECK_THAT(faulty, Contains(">1 fault</h1>"));
  CHECK_THAT(faulty, Contains("warning eevee"));
  CHECK_THAT(faulty, Contains("<circle"));
  checked.grid = nullptr;
  CHECK_THAT(checkReport(checked), !Contains("<figure>"));
}
