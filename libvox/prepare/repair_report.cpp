// Names and summaries of the changes that repair makes.

#include "libvox/prepare/repair.h"

#include <algorithm>

namespace vox {
namespace {

struct Phrase {
  const char* verb;
  const char* one;
  const char* many;
};
constexpr std::array<Phrase, kRepairKindCount> kPhrases = {{
    {"welded", "vertex", "vertices"},
    {"stitched", "T-junction", "T-junctions"},
    {"removed repeated corners from", "face", "faces"},
    {"split", "face that touches itself", "faces that touch themselves"},
    {"dropped", "degenerate face", "degenerate faces"},
    {"dropped", "duplicate face", "duplicate faces"},
    {"cut", "edge", "edges"},
    {"split", "vertex", "vertices"},
    {"chorded", "vertex", "vertices"},
    {"closed up", "face", "faces"},
    {"dropped", "flat component", "flat components"},
    {"removed", "unused vertex", "unused vertices"},
}};

}  // namespace

bool RepairReport::changed() const {
  return std::any_of(actions.begin(), actions.end(),
                     [](const RepairAction& action) { return action.count > 0; });
}

std::string repairName(RepairKind kind) {
  const Phrase& phrase = kPhrases[static_cast<std::size_t>(kind)];
  return std::string(phrase.verb) + " " + phrase.many;
}

std::string summary(const RepairReport& report) {
  std::string line;
  for (std::size_t k = 0; k < kRepairKindCount; ++k) {
    const std::size_t count = report.actions[k].count;
    if (count == 0) continue;
    if (!line.empty()) line += ", ";
    const Phrase& phrase = kPhrases[k];
    line += std::string(phrase.verb) + " " + std::to_string(count) + " " +
            (count == 1 ? phrase.one : phrase.many);
  }
  return line;
}

}  // namespace vox
