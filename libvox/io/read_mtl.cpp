// Wavefront MTL: the colour and the image of each material.

#include "libvox/io/read_mtl.h"

#include "libvox/io/companion_file.h"
#include "libvox/io/input_file.h"
#include "libvox/io/text_scanner.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <string>
#include <system_error>
#include <unordered_map>
#include <utility>

namespace vox {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBlanks = " \t\v\f";

/// Options of images that are skipped, and the number of words that follow each.
constexpr std::pair<std::string_view, int> kSkippedOptions[] = {
    {"-blendu", 1}, {"-blendv", 1},  {"-bm", 1}, {"-boost", 1},  {"-cc", 1},
    {"-clamp", 1},  {"-imfchan", 1}, {"-mm", 2}, {"-texres", 1}, {"-type", 1},
};

std::string lower(std::string_view word) {
  std::string result(word);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');  // the same in every locale
  return result;
}

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::string_view firstWord(std::string_view line) {
  line = trimmed(line);
  return line.substr(0, line.find_first_of(kBlanks));
}

std::string_view takeWord(std::string_view& line) {
  const std::string_view word = firstWord(line);
  line = trimmed(line);
  line.remove_prefix(word.size());
  return word;
}

bool isNumber(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && stop == word.data() + word.size();
}

class MtlParser {
 public:
  MtlParser(std::string_view text, const fs::path& file)
      : scan_(text, file.string(), {.hashComments = true}), folder_(file.parent_path()) {}

  std::vector<Material> parse() {
    do readLine();
    while (scan_.nextLine());
    return std::move(materials_);
  }

 private:
  void readLine();
  void readName();
  void readColor(Material& material);
  double readOpacity();
  void readImage(Material& material);
  Vec2d readPair(std::string_view& line, double otherwise) const;

  TextScanner scan_;
  fs::path folder_;
  std::vector<Material> materials_;
  std::unordered_map<std::string, std::size_t> places_;  // of the names in materials_
  std::size_t current_ = 0;
};

void MtlParser::readLine() {
  const std::string keyword = lower(scan_.token());
  if (keyword == "newmtl") return readName();
  if (materials_.empty()) return;
  Material& material = materials_[current_];
  if (keyword == "kd") readColor(material);
  if (keyword == "d") material.opacity = readOpacity();
  if (keyword == "tr") material.opacity = 1 - readOpacity();
  if (keyword == "map_kd") readImage(material);
}

void MtlParser::readName() {
  const std::string name(materialName(scan_.restOfLine()));
  const auto [place, isNew] = places_.try_emplace(name, materials_.size());
  if (isNew) materials_.emplace_back().name = name;
  current_ = place->second;
}

// Line "Kd r g b", or "Kd r" for grey. "Kd spectral FILE" and "Kd xyz x y z" are skipped.
void MtlParser::readColor(Material& material) {
  Vec3d color;
  int count = 0;
  for (auto token = scan_.token(); !token.empty() && count < 3; token = scan_.token()) {
    const std::string word = lower(token);
    if (count == 0 && (word == "spectral" || word == "xyz")) return;
    color[count++] = std::clamp(scan_.number(token), 0.0, 1.0);
  }
  if (count == 1) color.setConstant(color[0]);
  if (count != 1 && count != 3)
    scan_.fail("Kd with " + std::to_string(count) + " numbers; expected red, green and blue");
  material.color = color.cast<float>();
}

double MtlParser::readOpacity() {
  std::string_view token = scan_.token();
  if (lower(token) == "-halo") token = scan_.token();
  return std::clamp(scan_.number(token), 0.0, 1.0);
}

// Line "map_Kd options file". What is no known option begins the file name.
void MtlParser::readImage(Material& material) {
  std::string_view line = scan_.restOfLine();
  ImageMap image;
  for (std::string option = lower(firstWord(line)); option.starts_with('-');
       option = lower(firstWord(line))) {
    const auto* const skipped =
        std::find_if(std::begin(kSkippedOptions), std::end(kSkippedOptions),
                     [&](const auto& known) { return known.first == option; });
    const bool isSkipped = skipped != std::end(kSkippedOptions);
    if (!isSkipped && option != "-s" && option != "-o" && option != "-t") break;
    takeWord(line);
    if (option == "-s") image.scale = readPair(line, 1);
    if (option == "-o") image.offset = readPair(line, 0);
    if (option == "-t") readPair(line, 0);
    if (option == "-clamp") image.clamp = lower(firstWord(line)) == "on";
    for (int n = 0; isSkipped && n < skipped->second; ++n) takeWord(line);
  }
  const std::string_view name = materialName(line);
  if (name.empty()) return;
  image.file = companionPath(name, folder_).string();
  material.image = std::move(image);
}

/// One to three numbers: for u, v and w, which is not used.
Vec2d MtlParser::readPair(std::string_view& line, double otherwise) const {
  Vec2d pair(scan_.number(takeWord(line)), otherwise);
  if (isNumber(firstWord(line))) pair[1] = scan_.number(takeWord(line));
  if (isNumber(firstWord(line))) takeWord(line);
  return pair;
}

}  // namespace

std::string_view materialName(std::string_view restOfLine) {
  std::string_view name = restOfLine;
  for (std::size_t at = name.find('#'); at != name.npos; at = name.find('#', at + 1))
    if (at == 0 || kBlanks.find(name[at - 1]) != kBlanks.npos) name = name.substr(0, at);
  name = trimmed(name);
  if (name.size() > 1 && name.front() == '"' && name.back() == '"')
    name = name.substr(1, name.size() - 2);
  return name;
}

std::vector<Material> parseMtl(std::string_view text, const fs::path& file) {
  return MtlParser(text, file).parse();
}

std::vector<Material> readMtl(const fs::path& file) {
  std::vector<Material> materials = parseMtl(contentsOf(file), file);
  for (Material& material : materials) {
    if (!material.image) continue;
    material.image->file = foundCompanion(material.image->file, file.parent_path()).string();
  }
  return materials;
}

}  // namespace vox
