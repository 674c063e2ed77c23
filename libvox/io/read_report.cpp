// Words for the oddities of mesh files.

#include "libvox/io/read_report.h"

#include <limits>

namespace vox {
namespace {

struct Words {
  const char* done;  // nullptr: nothing is lost
  const char* one;
  const char* many;
  const char* more;
};

constexpr std::array<Words, kOddityCount> kWords = {{
    {"dropped", "face", "faces", " of fewer than 3 corners"},
    {"dropped", "vertex", "vertices", " at NaN or infinity that no face uses"},
    {"dropped", "facet", "facets", " at NaN or infinity"},
    {"ignored", "free-form curve or surface", "free-form curves and surfaces", ""},
    {"ignored", "byte", "bytes", " after the last face"},
    {"clamped", "colour value", "colour values", " above full brightness"},
    {"ignored", "line", "lines", " of #MRGB colours that are not 8 hexadecimal digits each"},
    {"ignored", "set", "sets", " of points or lines"},
    {"ignored", "skin or set of morph targets", "skins or sets of morph targets", ""},
    {"ignored", "texture coordinate", "texture coordinates", " not finite or missing in the file"},
    {nullptr, "colour", "colours", " that only some programs write in this way"},
    {nullptr, "keyword", "keywords", " without a blank before its number"},
    {nullptr, "face", "faces", " over several lines"},
    {nullptr, "comment", "comments", " without a blank before its #"},
    {nullptr, "name", "names", " that ends with a backslash"},
}};

}  // namespace

void ReadReport::add(Oddity kind, std::size_t line, std::uint64_t element, std::uint64_t count) {
  Count& all = counts[static_cast<std::size_t>(kind)];
  if (all.count == 0) {
    all.line = line;
    all.element = element;
  }
  all.count += count;
}

void ReadReport::append(const ReadReport& part, std::size_t linesBefore) {
  materialFiles.insert(materialFiles.end(), part.materialFiles.begin(), part.materialFiles.end());
  for (std::size_t k = 0; k < kOddityCount; ++k)
    if (const auto& [count, line, element] = part.counts[k]; count > 0)
      add(static_cast<Oddity>(k), line == 0 ? 0 : line + linesBefore, element, count);
}

std::string lossText(const ReadReport& report) {
  std::string text;
  for (std::size_t k = 0; k < kOddityCount; ++k) {
    const auto& [count, line, element] = report.counts[k];
    const Words& words = kWords[k];
    if (words.done == nullptr || count == 0) continue;
    text += (text.empty() ? "" : ", ") + std::string(words.done) + " " + std::to_string(count) +
            " " + (count == 1 ? words.one : words.many) + words.more;
    if (line > 0)
      text += (count == 1 ? " (on line " : " (the first on line ") + std::to_string(line) + ")";
  }
  return text;
}

std::string firstOddity(const ReadReport& report) {
  constexpr auto kNowhere = std::numeric_limits<std::size_t>::max();
  std::size_t first = kNowhere;
  for (std::size_t k = 0; k < kOddityCount; ++k) {
    if (report.counts[k].count == 0) continue;
    if (first == kNowhere || report.counts[k].line < report.counts[first].line) first = k;
  }
  if (first == kNowhere) return {};
  const auto& [count, line, element] = report.counts[first];
  const Words& words = kWords[first];
  const std::string what = std::string(words.one) + words.more;
  if (line > 0) return report.file + ":" + std::to_string(line) + ": " + what;
  return report.file + ": " + what +
         (element == ReadReport::kNoElement ? "" : " (number " + std::to_string(element) + ")");
}

}  // namespace vox
