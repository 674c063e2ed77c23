#include "apps/bench/contest_report.h"

#include "apps/bench/report.h"
#include "apps/bench/statistics.h"

#include <functional>
#include <iomanip>
#include <sstream>

namespace vox::bench {
namespace {

/// The number with three digits: 0.0361, 12.4, 1234.
std::string text(double value) {
  std::ostringstream out;
  if (value >= 100)
    out << std::fixed << std::setprecision(0) << value;
  else
    out << std::setprecision(3) << value;
  return out.str();
}

const Side* sideOf(const Contest& contest, const std::string& name, std::size_t dim) {
  for (const Contender& contender : contest.contenders)
    if (contender.name == name && contender.sides[dim] && contender.sides[dim]->ok())
      return &*contender.sides[dim];
  return nullptr;
}

/// Two cells of a table: the median, and its ratio to the median of vox.
std::string cells(const std::vector<double>& values, double unit,
                  const std::vector<double>* ofVox) {
  std::string row = " " + text(median(values) / unit) + " |";
  return row + (ofVox != nullptr ? " " + text(median(values) / median(*ofVox)) : "") + " |";
}

std::string rowOf(const Contest& contest, const Contender& contender, std::size_t dim) {
  std::string row = "| " + contender.name + " | ";
  const auto& side = contender.sides[dim];
  if (!side) return row + "not run: see above | | | | | | | |\n";
  if (!side->ok()) return row + describe(side->last) + " | | | | | | | |\n";
  const Side* vox = sideOf(contest, contender.against, dim);
  const auto of = [&](std::vector<double> Side::*values) {
    return vox != nullptr ? &(vox->*values) : nullptr;
  };
  const Output& output = contender.outputs[dim];
  row += output.voxels ? std::to_string(*output.voxels) : "";
  row += " | " + (output.fileBytes > 0 ? text(output.fileBytes / kMiB) : "");
  row += " |" + cells(side->wallSeconds, 1, of(&Side::wallSeconds));
  row += cells(side->cpuSeconds, 1, of(&Side::cpuSeconds));
  return row + cells(side->peakBytes, kMiB, of(&Side::peakBytes)) + "\n";
}

Plot plotOf(const Contest& contest, const std::string& title,
            const std::function<double(const Side&)>& value) {
  Plot plot{title + ": " + contest.input, "voxels along the longest side", {}};
  for (const Contender& contender : contest.contenders) {
    Curve curve{contender.name, {}};
    for (std::size_t i = 0; i < contest.dims.size(); ++i)
      if (const Side* side = sideOf(contest, contender.name, i))
        curve.points.push_back({static_cast<double>(contest.dims[i]), value(*side)});
    if (!curve.points.empty()) plot.curves.push_back(curve);
  }
  return plot;
}

}  // namespace

std::string markdownOf(const Contest& contest) {
  std::string table;
  for (std::size_t i = 0; i < contest.dims.size(); ++i) {
    table += "\n### " + contest.input + " at " + std::to_string(contest.dims[i]) + "\n\n";
    table += "| | active voxels | file MiB | wall s | / vox | CPU s | / vox | peak MiB | / vox |\n";
    table += "|---|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for (const Contender& contender : contest.contenders) table += rowOf(contest, contender, i);
  }
  return table;
}

nlohmann::ordered_json jsonOf(const Contest& contest) {
  auto contenders = nlohmann::ordered_json::array();
  for (const Contender& contender : contest.contenders) {
    auto sides = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < contender.sides.size(); ++i) {
      const auto& side = contender.sides[i];
      sides.push_back(side ? jsonOf(*side) : nlohmann::ordered_json(nullptr));
      if (!side) continue;
      const Output& output = contender.outputs[i];
      sides.back()["file_bytes"] = output.fileBytes;
      if (output.voxels) sides.back()["active_voxels"] = *output.voxels;
    }
    contenders.push_back(
        {{"name", contender.name}, {"against", contender.against}, {"at_dims", sides}});
  }
  return {{"input", contest.input}, {"dims", contest.dims}, {"contenders", contenders}};
}

Plot timePlot(const Contest& contest) {
  return plotOf(contest, "Wall time, s", [](const Side& side) { return median(side.wallSeconds); });
}

Plot memoryPlot(const Contest& contest) {
  return plotOf(contest, "Peak memory, MiB",
                [](const Side& side) { return median(side.peakBytes) / kMiB; });
}

}  // namespace vox::bench
