// Differences as text and as JSON.

#include "apps/vox/diff_text.h"

#include "apps/vox/counted.h"
#include "libvox/core/error.h"

#include <algorithm>
#include <optional>
#include <ostream>
#include <sstream>
#include <utility>
#include <vector>

namespace vox::app {
namespace {

Json toJson(const std::vector<TextDiff>& texts) {
  Json json = Json::array();
  for (const TextDiff& text : texts)
    json.push_back({{"what", text.what}, {"a", text.a}, {"b", text.b}});
  return json;
}

Json toJson(const TopologyDiff& topology) {
  return {{"active", topology.active},     {"only_a", topology.onlyA},
          {"only_b", topology.onlyB},      {"first", orNull(topology.first)},
          {"distance", topology.distance},  // infinity is null in JSON
          {"allowed", topology.allowed}};
}

Json toJson(const ValueDiff& values) {
  return {{"compared", values.compared},
          {"differing", values.differing},
          {"first", orNull(values.first)},
          {"largest", values.largest},
          {"rms", values.rms},
          {"inactive_differing", values.inactiveDiffering}};
}

Json toJson(const GridDiff& grid) {
  return {{"name", grid.name},
          {"same", grid.same()},
          {"in_a", grid.inA},
          {"in_b", grid.inB},
          {"properties", toJson(grid.properties)},
          {"metadata", toJson(grid.metadata)},
          {"topology", toJson(grid.topology)},
          {"values", grid.values ? toJson(*grid.values) : Json()}};
}

Json gridsOf(const FileDiff& diff) {
  Json grids = Json::array();
  for (const GridDiff& grid : diff.grids) grids.push_back(toJson(grid));
  return grids;
}

std::string at(const std::optional<VoxelIndex>& voxel) {
  if (!voxel) return {};
  const auto& [x, y, z] = *voxel;
  return ", first (" + std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(z) + ')';
}

void print(std::ostream& out, const std::vector<TextDiff>& texts, const std::string& prefix) {
  const auto quoted = [](const std::string& text) {
    return text.empty() ? std::string("nothing") : "'" + onOneLine(text) + "'";
  };
  for (const TextDiff& text : texts)
    out << "  " << prefix << onOneLine(text.what) << ": " << quoted(text.a) << " in A, "
        << quoted(text.b) << " in B\n";
}

void print(std::ostream& out, const TopologyDiff& topology) {
  if (topology.onlyA == 0 && topology.onlyB == 0) return;
  out << "  topology: " << counted(topology.onlyA, "voxel") << " only in A, " << topology.onlyB
      << " only in B" << at(topology.first) << "; up to " << topology.distance << " voxels apart";
  if (topology.allowed > 0)
    out << ", where " << topology.allowed << (topology.same() ? " are" : " would be") << " allowed";
  out << '\n';
}

void print(std::ostream& out, const ValueDiff& values) {
  if (values.differing > 0)
    out << "  values: " << values.differing << " of " << values.compared << " differ"
        << at(values.first) << "; by up to " << values.largest << ", rms " << values.rms << '\n';
  if (values.inactiveDiffering > 0)
    out << "  values: " << counted(values.inactiveDiffering, "inactive voxel")
        << " have another value\n";
}

void print(std::ostream& out, const GridDiff& grid) {
  out << onOneLine(grid.name) << ": ";
  if (!grid.inA || !grid.inB) {
    out << "only in " << (grid.inA ? 'A' : 'B') << '\n';
    return;
  }
  if (!grid.same()) {
    out << "differs\n";
    print(out, grid.properties, "");
    print(out, grid.topology);
    if (grid.values) print(out, *grid.values);
    print(out, grid.metadata, "metadata ");
    return;
  }
  out << "same, " << counted(grid.topology.active[0], "active voxel");
  if (grid.values && grid.values->largest > 0)
    out << "; values within the tolerance, by up to " << grid.values->largest << ", rms "
        << grid.values->rms;
  out << '\n';
  print(out, grid.topology);
}

std::string indented(const std::string& text) {
  std::istringstream lines(text);
  std::string all;
  for (std::string line; std::getline(lines, line);) all += "  " + line + '\n';
  return all;
}

/// How many files there are of each kind: "3 files: 2 same, 1 only in A".
std::string summaryOf(const FolderDiff& diff) {
  const auto count = [&](auto&& is) {
    return static_cast<std::uint64_t>(std::count_if(diff.files.begin(), diff.files.end(), is));
  };
  const std::pair<std::uint64_t, const char*> kinds[] = {
      {count([](const FilePairDiff& file) { return file.same(); }), " same"},
      {count([](const FilePairDiff& file) { return file.inA && file.inB && !file.diff.same(); }),
       " different"},
      {count([](const FilePairDiff& file) { return !file.inB; }), " only in A"},
      {count([](const FilePairDiff& file) { return !file.inA; }), " only in B"},
      {count([](const FilePairDiff& file) { return !file.error.empty(); }), " not compared"}};
  std::string text = counted(diff.files.size(), "file");
  const char* separator = ": ";
  for (const auto& [number, kind] : kinds) {
    if (number == 0) continue;
    text += separator + std::to_string(number) + kind;
    separator = ", ";
  }
  return text;
}

}  // namespace

std::string textOf(const GridDiff& grid) {
  std::ostringstream out;
  print(out, grid);
  return out.str();
}

std::string textOfMetadata(const FileDiff& diff) {
  if (diff.metadata.empty()) return {};
  std::ostringstream out;
  out << "file: differs\n";
  print(out, diff.metadata, "metadata ");
  return out.str();
}

std::string textOf(const FileDiff& diff) {
  std::string text;
  for (const GridDiff& grid : diff.grids) text += textOf(grid);
  return text + textOfMetadata(diff);
}

std::string textOf(const FilePairDiff& file) {
  const std::string name = onOneLine(file.name) + ": ";
  if (!file.inA || !file.inB) return name + "only in " + (file.inA ? "A" : "B") + '\n';
  if (!file.error.empty()) return name + "not compared: " + file.error + '\n';
  return name + (file.same() ? "same" : "differs") + '\n' + indented(textOf(file.diff));
}

std::string textOf(const FolderDiff& diff) {
  std::string text;
  for (const FilePairDiff& file : diff.files) text += textOf(file);
  return text + summaryOf(diff) + '\n';
}

Json jsonOf(const FileDiff& diff, const std::string& a, const std::string& b) {
  return {{"a", a},
          {"b", b},
          {"same", diff.same()},
          {"metadata", toJson(diff.metadata)},
          {"grids", gridsOf(diff)}};
}

Json jsonOf(const FolderDiff& diff, const std::string& a, const std::string& b) {
  Json json = {{"a", a}, {"b", b}, {"same", diff.same()}, {"files", Json::array()}};
  for (const FilePairDiff& file : diff.files)
    json["files"].push_back({{"name", file.name},
                             {"same", file.same()},
                             {"in_a", file.inA},
                             {"in_b", file.inB},
                             {"error", file.error.empty() ? Json() : Json(file.error)},
                             {"metadata", toJson(file.diff.metadata)},
                             {"grids", gridsOf(file.diff)}});
  return json;
}

}  // namespace vox::app
