// The report of a comparison.

#include "libvox/report/diff_report.h"

#include "libvox/core/error.h"
#include "libvox/core/markup.h"
#include "libvox/inspect/compared.h"
#include "libvox/io/read_vdb.h"
#include "libvox/report/best_views.h"
#include "libvox/report/diff_tables.h"
#include "libvox/report/grid_pictures.h"
#include "libvox/report/histogram.h"
#include "libvox/report/html.h"
#include "libvox/report/page.h"
#include "libvox/report/palette.h"
#include "libvox/report/point_cloud.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace vox {
namespace {

using openvdb::GridBase;

constexpr std::size_t kMostBytes = 1950000;
/// WebGL views of a page: browsers drop the oldest of more than 16.
constexpr int kMostViewers = 8;

/// The body of a page, with what there is room for.
class Body {
 public:
  void add(std::string_view html) { html_ += html; }

  bool hasRoom(std::size_t bytes) const { return html_.size() + bytes <= kMostBytes; }

  /// Adds something that the page can do without.
  /// @return  false: there is no room for it
  bool addIfItFits(std::string_view html, std::size_t reserved) {
    if (!hasRoom(html.size() + reserved)) return false;
    html_ += html;
    return true;
  }

  const std::string& html() const { return html_; }

  int viewers = 0;

 private:
  std::string html_;
};

std::string legendOf(const DifferenceLook& look) {
  const auto entry = [](const std::string& style, const std::string& text,
                        const std::string& classes) {
    return "<span><span class=\"chip" + classes + "\" style=\"background:" + style +
           "\">&nbsp;</span>" + text + "</span>\n";
  };
  std::string html = "<p class=\"legend\">\n" + entry(cssColor(kOnlyAColor), "only in A", "") +
                     entry(cssColor(kOnlyBColor), "only in B", "");
  if (look.values() != nullptr && look.values()->activeVoxelCount() > 0)
    html +=
        entry("linear-gradient(90deg," + cssColor(kSmallColor) + ',' + cssColor(kLargeColor) + ')',
              look.largest() > 0 ? "in both, values differ by 0 to " + shortNumber(look.largest())
                                 : "in both, values differ",
              " scale");
  const std::string partial =
      look.isPartial() ? " Of this level set, voxels within one voxel of the surface are shown."
                       : "";
  return html + entry(cssColor(kCommonColor), "no difference", "") +
         "</p>\n<p class=\"note\">In the pictures z is up, and the front is what is seen along +y. "
         "Voxels are "
         "compared by their indices." +
         partial + "</p>\n";
}

std::string figures(const std::vector<Picture>& pictures, const std::string& more = {}) {
  std::string html = "<div class=\"pictures\">\n";
  for (const Picture& picture : pictures) html += figureOf(picture);
  return html + more + "</div>\n";
}

/// Pictures of two grids with different transforms.
std::string overlay(const GridBase::Ptr& a, const GridBase::Ptr& b) {
  const auto visibleA = lookOf(a);
  const auto visibleB = lookOf(b);
  if (!visibleA || !visibleB) return {};
  return figures(overlayPictures(*a, *b, *visibleA, *visibleB));
}

/// A grid whose difference has been shown.
struct Shown {
  std::string name;
  std::unique_ptr<const DifferenceLook> look;
};

/// What differs between two grids of a name, voxel by voxel.
void addDifference(const GridBase::Ptr& a, const GridBase::Ptr& b, const DiffOptions& options,
                   const std::string& id, std::size_t reserved, Shown& shown, Body& body) {
  constexpr std::size_t kLeastRoom = 150000;
  const char* const noRoom =
      "<p class=\"soft\">There was no room for the pictures of this grid.</p>\n";
  if (!body.hasRoom(kLeastRoom + reserved)) return body.add(noRoom);
  auto look = std::make_unique<const DifferenceLook>(*a, *b, options);
  if (shown.look && shown.look->looksLike(*look)) {
    body.add("<p>The same voxels differ as in the grid " + escaped(shown.name) + ".</p>\n");
    return;
  }
  std::string histogram;
  if (look->values() != nullptr) histogram = histogramFigure(histogramOf(*look->values()));
  const std::vector<View> views =
      bestViews(look->differing(), look->all(), a->transform(), kReportUp);
  std::vector<Picture> pictures = differencePictures(a, b, *look, views);
  const std::string legend = legendOf(*look);
  shown = {a->getName(), std::move(look)};
  constexpr std::array<std::uint64_t, 3> kMostPoints = {200000, 100000, 50000};
  for (const std::uint64_t most : kMostPoints) {
    std::string html = legend + figures(pictures, histogram);
    const bool hasViewer = body.viewers < kMostViewers;
    if (hasViewer)
      html += "<h3 class=\"viewer-title\">Turn it</h3>\n" +
              viewerOf(pointsOf(*shown.look, most), a->transform(), views[0], "viewer-" + id);
    if (body.addIfItFits(html, reserved)) {
      if (hasViewer) ++body.viewers;
      return;
    }
    for (Picture& picture : pictures) picture.image = halved(picture.image);
  }
  body.add(noRoom);
}

void addPictures(const GridDiff& diff, const GridBase::Ptr& a, const GridBase::Ptr& b,
                 const DiffOptions& options, const std::string& id, std::size_t reserved,
                 Shown& shown, Body& body) {
  if (!a || !b) {
    if (const auto visible = lookOf(a ? a : b))
      body.addIfItFits(figures({pictureOf(*visible, a ? "A" : "B")}), reserved);
    return;
  }
  const auto isLinear = [](const GridBase& grid) { return grid.transform().isLinear(); };
  if (!isLinear(*a) || !isLinear(*b)) {
    body.add("<p class=\"soft\">There are no pictures of grids in a frustum.</p>\n");
    return;
  }
  const bool moved = std::any_of(diff.properties.begin(), diff.properties.end(),
                                 [](const TextDiff& text) { return text.what == "transform"; });
  if (moved) body.addIfItFits(overlay(a, b), reserved);
  const bool valuesDiffer = diff.values && diff.values->differing > 0;
  if (diff.topology.onlyA > 0 || diff.topology.onlyB > 0 || valuesDiffer)
    addDifference(a, b, options, id, reserved, shown, body);
}

void addFile(const Comparison& comparison, const FilePairDiff& file, const std::string& id,
             std::size_t reserved, Body& body) {
  const auto pathIn = [&](const std::filesystem::path& place) {
    return comparison.areFolders ? place / file.name : place;
  };
  const DiffOptions& options = comparison.options;
  const VdbFile a = readVdb(pathIn(comparison.a));
  const VdbFile b = readVdb(pathIn(comparison.b));
  auto diff = file.diff.grids.begin();
  Shown shown;
  forEachPair(a, b, options,
              [&](const std::string& name, const GridBase::Ptr& gridA, const GridBase::Ptr& gridB) {
                if (diff == file.diff.grids.end() || diff->name != name)
                  throw InputError(file.name + ": has changed while it was compared");
                if (isRemarkable(*diff)) {
                  body.add("<h3>Grid " + escaped(name) + "</h3>\n" + factsOf(*diff));
                  addPictures(*diff, gridA, gridB, options,
                              id + '-' + std::to_string(diff - file.diff.grids.begin()), reserved,
                              shown, body);
                }
                ++diff;
              });
}

std::string headOf(const Comparison& comparison) {
  return std::string("<h1 class=\"") + (comparison.same() ? "good" : "bad") + "\">" +
         headingOf(comparison) + "</h1>\n<p>" + escaped(verdictOf(comparison)) +
         "</p>\n<p><b>A</b> <code>" + escaped(comparison.a) + "</code><br>\n<b>B</b> <code>" +
         escaped(comparison.b) + "</code></p>\n<p>The command that compares them:</p>\n<pre>" +
         escaped(shellLine(comparison.command)) + "</pre>\n";
}

}  // namespace

bool Comparison::same() const {
  return std::all_of(files.begin(), files.end(),
                     [](const FilePairDiff& file) { return file.same(); });
}

std::string diffReport(const Comparison& comparison) {
  const bool isOne = !comparison.areFolders;
  Body body;
  body.add(headOf(comparison));
  if (!isOne) body.add(indexOf(comparison));
  // Text comes first where there is not room for all.
  std::size_t reserved = kReportStyle.size() + kViewerScript.size();
  const std::size_t frame = reserved;
  for (const FilePairDiff& file : comparison.files)
    if (isOne || isRemarkable(file)) reserved += tablesOf(file).size();
  for (std::size_t i = 0; i < comparison.files.size(); ++i) {
    const FilePairDiff& file = comparison.files[i];
    if (!isOne && !isRemarkable(file)) continue;
    const std::string tables = tablesOf(file);
    reserved -= tables.size();
    if (!isOne && !body.hasRoom(tables.size() + frame)) {
      body.add("<p>There was no room for the files from here on.</p>\n");
      break;
    }
    const std::string id = "file-" + std::to_string(i);
    body.add(isOne ? "<h2>Grids</h2>\n"
                   : "<h2 id=\"" + id + "\">" + escaped(file.name) + "</h2>\n");
    body.add(tables);
    if (file.inA && file.inB && file.error.empty()) addFile(comparison, file, id, reserved, body);
  }
  return page(headingOf(comparison) + ": " + comparison.a + " and " + comparison.b, body.html());
}

}  // namespace vox
