// The report of a check.

#include "libvox/report/check_report.h"

#include "libvox/core/markup.h"
#include "libvox/inspect/topology.h"
#include "libvox/report/grid_pictures.h"
#include "libvox/report/html.h"
#include "libvox/report/page.h"
#include "libvox/report/point_cloud.h"

#include <algorithm>

namespace vox {
namespace {

std::uint64_t faultsOf(const CheckedFile& checked) {
  return static_cast<std::uint64_t>(
      std::count_if(checked.findings.begin(), checked.findings.end(),
                    [](const LintFinding& finding) { return finding.isFault; }));
}

std::string findingsTable(const CheckedFile& checked) {
  if (checked.findings.empty()) return {};
  std::string html =
      "<h2>Findings</h2>\n<div class=\"table\"><table><thead><tr><th scope=\"col\">finding</th>"
      "<th scope=\"col\">grid</th><th scope=\"col\">what it means</th></tr></thead><tbody>\n";
  for (const LintFinding& finding : checked.findings)
    html += std::string("<tr><td class=\"word\"><span class=\"") +
            (finding.isFault ? "bad\">fault " : "soft\">warning ") + escaped(finding.code) +
            "</span></td><td>" + escaped(finding.grid) + "</td><td>" + escaped(finding.message) +
            "</td></tr>\n";
  return html + "</tbody></table></div>\n";
}

/// A table of the largest components.
std::string componentTable(std::vector<Component> components, const std::string& title) {
  constexpr std::size_t kMost = 20;
  if (components.empty()) return {};
  std::stable_sort(components.begin(), components.end(),
                   [](const Component& a, const Component& b) { return a.voxels > b.voxels; });
  std::string html = "<h3>" + title + ": " + grouped(components.size()) + "</h3>\n" +
                     "<div class=\"table\"><table><thead><tr><th scope=\"col\" class=\"number\">"
                     "voxels</th><th scope=\"col\">first voxel</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < std::min(kMost, components.size()); ++i) {
    const auto& [x, y, z] = components[i].first;
    html += "<tr><td class=\"number\">" + grouped(components[i].voxels) + "</td><td>(" +
            std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(z) + ")</td></tr>\n";
  }
  html += "</tbody></table></div>\n";
  if (components.size() > kMost)
    html += "<p class=\"soft\">And " + grouped(components.size() - kMost) + " smaller ones.</p>\n";
  return html;
}

std::string picturesOf(const CheckedFile& checked) {
  constexpr std::uint64_t kMostPoints = 200000;
  const auto visible = lookOf(checked.grid);
  if (!visible) return {};
  std::vector<openvdb::Coord> marked;
  for (const auto& [x, y, z] : checked.places) marked.emplace_back(x, y, z);
  std::string html = "<div class=\"pictures\">\n";
  for (const Picture& picture : markedPictures(*visible, marked)) html += figureOf(picture);
  return html + "</div>\n<h3 class=\"viewer-title\">Turn it</h3>\n" +
         viewerOf(pointsOf(*topologyOf(*checked.grid), kMostPoints), checked.grid->transform(),
                  *viewNamed("iso"), "viewer");
}

}  // namespace

std::string checkReport(const CheckedFile& checked) {
  const std::uint64_t faults = faultsOf(checked);
  const std::string verdict = faults == 0 ? "No faults" : countOf(faults, "fault");
  std::string body = std::string("<h1 class=\"") + (faults == 0 ? "good" : "bad") + "\">" +
                     verdict + "</h1>\n<p><code>" + escaped(checked.file) +
                     "</code></p>\n<p>The command that checks it:</p>\n<pre>" +
                     escaped(shellLine(checked.command)) + "</pre>\n" + findingsTable(checked);
  if (checked.grid) {
    body += "<h2>Grid " + escaped(checked.grid->getName()) + "</h2>\n<p>" +
            countOf(checked.grid->activeVoxelCount(), "active voxel") + ".</p>\n";
    for (const std::string& note : checked.notes) body += "<p>" + escaped(note) + "</p>\n";
    body += picturesOf(checked) + componentTable(checked.components, "Components") +
            componentTable(checked.enclosed, "Enclosed spaces");
  }
  return page(verdict + ": " + checked.file, body);
}

}  // namespace vox
