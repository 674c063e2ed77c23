// Differences as text and tables of HTML.

#include "libvox/report/diff_tables.h"

#include "libvox/core/markup.h"
#include "libvox/report/html.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace vox {
namespace {

std::string at(const std::optional<VoxelIndex>& voxel) {
  if (!voxel) return {};
  const auto& [x, y, z] = *voxel;
  return " The first of them is voxel (" + std::to_string(x) + ' ' + std::to_string(y) + ' ' +
         std::to_string(z) + ").";
}

/// As much of a text as a table has room for.
std::string shortened(const std::string& text) {
  constexpr std::size_t kMost = 300;
  return text.size() <= kMost ? escaped(text) : escaped(text.substr(0, kMost)) + "&hellip;";
}

std::string verdict(bool same) {
  return same ? "<span class=\"good\">same</span>" : "<span class=\"bad\">differs</span>";
}

std::string number(const std::string& text) {
  return "<td class=\"number\">" + text + "</td>";
}

std::string rowOf(const GridDiff& grid) {
  std::string row = "<tr><td>" + shortened(grid.name) + "</td><td class=\"word\">";
  if (!grid.inA || !grid.inB)
    row += std::string("<span class=\"bad\">only in ") + (grid.inA ? 'A' : 'B') + "</span>";
  else
    row += grid.same() && isRemarkable(grid)
               ? "<span class=\"good\">same within " + shortNumber(grid.topology.allowed) +
                     (grid.topology.allowed == 1 ? " voxel" : " voxels") + "</span>"
               : verdict(grid.same());
  row += "</td>";
  const TopologyDiff& topology = grid.topology;
  row += number(grid.inA ? grouped(topology.active[0]) : "");
  row += number(grid.inB ? grouped(topology.active[1]) : "");
  if (!grid.inA || !grid.inB)
    return row + number("") + number("") + number("") + number("") + number("") + "</tr>\n";
  row += number(grouped(topology.onlyA)) + number(grouped(topology.onlyB)) +
         number(shortNumber(topology.distance));
  if (grid.values)
    row += number(grouped(grid.values->differing)) + number(shortNumber(grid.values->largest));
  else
    row += number("") + number("");
  return row + "</tr>\n";
}

std::string textTable(const std::vector<TextDiff>& texts, const std::string& what) {
  if (texts.empty()) return {};
  const auto cell = [](const std::string& text) {
    return "<td>" + (text.empty() ? "<span class=\"soft\">none</span>" : shortened(text)) + "</td>";
  };
  std::string html = "<div class=\"table\"><table><thead><tr><th scope=\"col\">" + what +
                     "</th><th scope=\"col\">A</th><th scope=\"col\">B</th></tr></thead><tbody>\n";
  for (const TextDiff& text : texts)
    html += "<tr><td>" + shortened(text.what) + "</td>" + cell(text.a) + cell(text.b) + "</tr>\n";
  return html + "</tbody></table></div>\n";
}

std::string topologyText(const TopologyDiff& topology) {
  if (topology.onlyA == 0 && topology.onlyB == 0) return {};
  const std::string apart = std::isfinite(topology.distance)
                                ? " They lie up to " + shortNumber(topology.distance) +
                                      (topology.distance == 1 ? " voxel" : " voxels") +
                                      " away from the other grid."
                                : " The other grid has no voxels.";
  const std::string allowed =
      topology.same() ? " Up to " + shortNumber(topology.allowed) + " are allowed." : "";
  return "<p>Topology: " + countOf(topology.onlyA, "voxel") + " only in A, " +
         countOf(topology.onlyB, "voxel") + " only in B." + apart + allowed + at(topology.first) +
         "</p>\n";
}

std::string valueText(const ValueDiff& values) {
  std::string html;
  if (values.differing > 0)
    html += "<p>Values: " + grouped(values.differing) + " of " + grouped(values.compared) +
            " differ, by up to " + shortNumber(values.largest) + ", root mean square " +
            shortNumber(values.rms) + '.' + at(values.first) + "</p>\n";
  if (values.inactiveDiffering > 0)
    html += "<p>Values: " + countOf(values.inactiveDiffering, "inactive voxel") + " differ.</p>\n";
  return html;
}

const char* stateOf(const FilePairDiff& file) {
  if (!file.inA) return "only in B";
  if (!file.inB) return "only in A";
  if (!file.error.empty()) return "not compared";
  if (!file.diff.same()) return "differs";
  return isRemarkable(file) ? "same within the tolerance" : "same";
}

/// How many files are in each state: "5 files: 3 same, 1 differs, 1 only in A".
std::string countsOf(const Comparison& comparison) {
  std::map<std::string, std::uint64_t> counts;
  for (const FilePairDiff& file : comparison.files) ++counts[stateOf(file)];
  std::string text = countOf(comparison.files.size(), "file") + ":";
  const char* separator = " ";
  for (const auto& [state, count] : counts) {
    text += separator + grouped(count) + ' ' + state;
    separator = ", ";
  }
  return text + '.';
}

std::uint64_t differingGrids(const FileDiff& diff) {
  return static_cast<std::uint64_t>(std::count_if(
      diff.grids.begin(), diff.grids.end(), [](const GridDiff& grid) { return !grid.same(); }));
}

}  // namespace

bool isRemarkable(const GridDiff& grid) {
  return !grid.same() || grid.topology.onlyA > 0 || grid.topology.onlyB > 0;
}

bool isRemarkable(const FilePairDiff& file) {
  return !file.same() || std::any_of(file.diff.grids.begin(), file.diff.grids.end(),
                                     [](const GridDiff& grid) { return isRemarkable(grid); });
}

std::string headingOf(const Comparison& comparison) {
  if (comparison.same()) return "The same";
  const bool onlyErrors =
      std::all_of(comparison.files.begin(), comparison.files.end(),
                  [](const FilePairDiff& file) { return file.same() || !file.error.empty(); });
  return onlyErrors ? "Not all could be compared" : "Different";
}

std::string verdictOf(const Comparison& comparison) {
  if (comparison.areFolders) return countsOf(comparison);
  const FileDiff& diff = comparison.files.front().diff;
  const std::uint64_t differing = differingGrids(diff);
  if (diff.same())
    return countOf(diff.grids.size(), "grid") + (isRemarkable(comparison.files.front())
                                                     ? " compared; voxels moved, but not too far."
                                                     : " compared.");
  std::string text = grouped(differing) + " of " + countOf(diff.grids.size(), "grid") +
                     (differing == 1 ? " differs" : " differ");
  if (!diff.metadata.empty())
    text += differing > 0 ? ", and the metadata of the file" : ", but the metadata of the file";
  return text + '.';
}

std::string indexOf(const Comparison& comparison) {
  constexpr std::size_t kMostSame = 1000;  // files that are listed though they are the same
  constexpr std::size_t kMostBytes = 1000000;
  const bool onlyRemarkable = comparison.files.size() > kMostSame;
  std::string html =
      "<div class=\"table\"><table><thead><tr><th scope=\"col\">file</th>"
      "<th scope=\"col\">verdict</th><th scope=\"col\">grids that "
      "differ</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < comparison.files.size(); ++i) {
    const FilePairDiff& file = comparison.files[i];
    if (onlyRemarkable && !isRemarkable(file)) continue;
    if (html.size() > kMostBytes) {
      html += "<tr><td>and others</td><td></td><td></td></tr>\n";
      break;
    }
    const std::string name = shortened(file.name);
    html += "<tr><td>" +
            (!isRemarkable(file) ? name
                                 : "<a href=\"#file-" + std::to_string(i) + "\">" + name + "</a>") +
            "</td><td class=\"word\"><span class=\"" + (file.same() ? "good" : "bad") + "\">" +
            stateOf(file) + "</span></td>" +
            number(file.inA && file.inB && file.error.empty() ? grouped(differingGrids(file.diff))
                                                              : "") +
            "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string tablesOf(const FilePairDiff& file) {
  if (!file.inA || !file.inB)
    return std::string("<p class=\"bad\">This file is only in ") + (file.inA ? 'A' : 'B') +
           ".</p>\n";
  if (!file.error.empty()) return "<p class=\"bad\">" + escaped(file.error) + "</p>\n";
  std::string html =
      "<div class=\"table\"><table><thead><tr><th scope=\"col\">grid</th>"
      "<th scope=\"col\">verdict</th>";
  for (const char* head : {"voxels in A", "voxels in B", "only in A", "only in B",
                           "farthest from the other, voxels", "values that differ", "by up to"})
    html += std::string("<th scope=\"col\" class=\"number\">") + head + "</th>";
  html += "</tr></thead><tbody>\n";
  for (const GridDiff& grid : file.diff.grids) html += rowOf(grid);
  return html + "</tbody></table></div>\n" + textTable(file.diff.metadata, "metadata of the file");
}

std::string factsOf(const GridDiff& grid) {
  if (!grid.inA || !grid.inB)
    return std::string("<p class=\"bad\">This grid is only in ") + (grid.inA ? 'A' : 'B') +
           ".</p>\n";
  return topologyText(grid.topology) + (grid.values ? valueText(*grid.values) : "") +
         textTable(grid.properties, "property") + textTable(grid.metadata, "metadata");
}

}  // namespace vox
