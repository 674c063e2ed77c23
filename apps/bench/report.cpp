#include "apps/bench/report.h"

#include "apps/bench/statistics.h"

#include <fstream>
#include <iomanip>
#include <optional>
#include <sstream>
#include <thread>
#include <unistd.h>

namespace vox::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kNameWidth = 30;
constexpr int kNumberWidth = 10;

/// The number with four digits: 0.03612, 12.35, 1234.
std::string shortNumber(double value) {
  std::ostringstream out;
  if (value >= 1000)
    out << std::fixed << std::setprecision(0) << value;
  else
    out << std::setprecision(4) << value;
  return out.str();
}

std::string number(std::optional<double> value) {
  std::ostringstream out;
  out << std::setw(kNumberWidth) << (value ? shortNumber(*value) : "-");
  return out.str();
}

std::string name(const std::string& text) {
  std::ostringstream out;
  out << std::left << std::setw(kNameWidth) << text;
  return out.str();
}

/// Smallest, median and largest value in three columns.
std::string columns(const std::vector<double>& values, double unit = 1) {
  const std::string gap = "  ";
  if (values.empty()) return gap + number({}) + number({}) + number({});
  const Range range = rangeOf(values);
  return gap + number(range.min / unit) + number(range.median / unit) + number(range.max / unit);
}

std::string sideRow(const std::string& letter, const Side& side) {
  std::string row = "  " + name(letter + " " + side.program.name);
  row += columns(side.wallSeconds) + columns(side.cpuSeconds) + columns(side.peakBytes, kMiB);
  if (side.voxels) row += "  " + std::to_string(*side.voxels) + " voxels";
  if (!side.ok()) row += "  " + describe(side.last);
  return row + "\n";
}

Json rangeJson(const std::vector<double>& values) {
  if (values.empty()) return nullptr;
  const Range range = rangeOf(values);
  return {{"min", range.min}, {"median", range.median}, {"max", range.max}};
}

template <class Value>
Json optionalJson(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

std::string outcomeName(Outcome outcome) {
  switch (outcome) {
    case Outcome::kOk:
      return "ok";
    case Outcome::kAbsent:
      return "absent";
    case Outcome::kFailed:
      return "failed";
    case Outcome::kTimedOut:
      return "timed out";
    case Outcome::kOutOfMemory:
      return "out of memory";
  }
  return "";
}

Json exponentsJson(const Exponents& exponents) {
  return {{"wall", optionalJson(exponents.wall)},
          {"cpu", optionalJson(exponents.cpu)},
          {"peak", optionalJson(exponents.peak)}};
}

std::string exponentsRow(const std::string& what, const Exponents& exponents) {
  return "  " + name(what) + "wall" + number(exponents.wall) + "   CPU" + number(exponents.cpu) +
         "   peak" + number(exponents.peak) + "\n";
}

std::optional<double> medianOf(const std::vector<double>& values, double unit = 1) {
  if (values.empty()) return std::nullopt;
  return median(values) / unit;
}

}  // namespace

std::string tableOf(const Comparison& comparison) {
  const auto heading = [](const std::string& what) {
    std::ostringstream out;
    out << "  " << std::setw(3 * kNumberWidth) << what + ": min, median, max";
    return out.str();
  };
  std::string table = comparison.name + "\n  " + name("") + heading("wall s") + heading("CPU s") +
                      heading("peak MiB") + "\n";
  table += sideRow("A", comparison.a) + sideRow("B", comparison.b);
  table += "  " + name("B/A") + columns(comparison.wallRatios()) + columns(comparison.cpuRatios()) +
           columns(comparison.peakRatios()) + "\n";
  const std::vector<double> perVoxel = comparison.cpuPerVoxelRatios();
  if (!perVoxel.empty())
    table += "  " + name("B/A per voxel") + columns({}) + columns(perVoxel) + "\n";
  return table;
}

std::string tableOf(const Scaling& scaling) {
  std::ostringstream out;
  out << "vox convert of " << scaling.input << " on " << scaling.threads
      << " threads, medians of whole processes\n  " << name("") << std::setw(12) << "voxels"
      << std::setw(kNumberWidth) << "wall s" << std::setw(kNumberWidth) << "CPU s"
      << std::setw(kNumberWidth) << "peak MiB"
      << "  efficiency against 1 thread\n";
  const auto row = [&](const std::string& label, const Side& side,
                       const std::optional<double>& efficiency) {
    out << "  " << name(label) << std::setw(12)
        << (side.voxels ? std::to_string(*side.voxels) : "-") << number(medianOf(side.wallSeconds))
        << number(medianOf(side.cpuSeconds)) << number(medianOf(side.peakBytes, kMiB))
        << number(efficiency) << (side.ok() ? "" : "  " + describe(side.last)) << "\n";
  };
  row(scaling.floor.program.name, scaling.floor, std::nullopt);
  for (const ScalingPoint& point : scaling.points)
    row("dim " + std::to_string(point.dim), point.threads.b, point.efficiency(scaling.threads));
  out << "cost = c voxels^e; e is\n"
      << exponentsRow("whole process", scaling.whole)
      << exponentsRow("above loading OpenVDB", scaling.aboveFloor);
  return out.str();
}

Json jsonOf(const Side& side) {
  return {{"name", side.program.name},
          {"command", side.program.command},
          {"status", outcomeName(side.last.outcome)},
          {"detail", describe(side.last)},
          {"exit_code", side.last.exitCode},
          {"runs", side.wallSeconds.size()},
          {"wall_seconds", rangeJson(side.wallSeconds)},
          {"cpu_seconds", rangeJson(side.cpuSeconds)},
          {"peak_bytes", rangeJson(side.peakBytes)},
          {"active_voxels", optionalJson(side.voxels)}};
}

Json jsonOf(const Comparison& comparison) {
  return {{"name", comparison.name},
          {"a", jsonOf(comparison.a)},
          {"b", jsonOf(comparison.b)},
          {"ratio",
           {{"wall", rangeJson(comparison.wallRatios())},
            {"cpu", rangeJson(comparison.cpuRatios())},
            {"peak", rangeJson(comparison.peakRatios())},
            {"cpu_per_voxel", rangeJson(comparison.cpuPerVoxelRatios())}}}};
}

Json jsonOf(const Scaling& scaling) {
  Json points = Json::array();
  for (const ScalingPoint& point : scaling.points)
    points.push_back({{"dim", point.dim},
                      {"one_thread", jsonOf(point.threads.a)},
                      {"threads", jsonOf(point.threads.b)},
                      {"efficiency", optionalJson(point.efficiency(scaling.threads))}});
  return {{"input", scaling.input},
          {"threads", scaling.threads},
          {"floor", jsonOf(scaling.floor)},
          {"points", points},
          {"exponents", exponentsJson(scaling.whole)},
          {"exponents_above_floor", exponentsJson(scaling.aboveFloor)}};
}

Json machineJson() {
  std::string processor = "unknown";
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) {
      processor = line.substr(line.find(": ") + 2);
      break;
    }
  return {{"processor", processor},
          {"processors", std::thread::hardware_concurrency()},
          {"memory_bytes", ::sysconf(_SC_PHYS_PAGES) * ::sysconf(_SC_PAGESIZE)}};
}

}  // namespace vox::bench
