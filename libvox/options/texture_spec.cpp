// The parameters of solid textures as text: one table with the name, the parser and the writer of
// each.

#include "libvox/options/texture_spec.h"

#include "libvox/core/color.h"
#include "libvox/core/error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace vox {
namespace {

/// Larger than any scene.
constexpr double kMostLength = 1e30;
constexpr double kLeastScale = 1e-30;
constexpr double kMostTurbulence = 100;
constexpr int kMostOctaves = 16;

// Values as text

[[noreturn]] void refuse(std::string_view must, std::string_view value) {
  throw UsageError("must be " + std::string(must) + ", not '" + std::string(value) + "'");
}

double parseNumber(std::string_view text, double low, double high, std::string_view must) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (!whole || !(value >= low && value <= high)) refuse(must, text);
  return value;
}

std::string numberText(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t end = 0; end != std::string_view::npos;) {
    end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end != std::string_view::npos) text.remove_prefix(end + 1);
  }
  return parts;
}

std::string vectorText(const Vec3d& v) {
  return numberText(v[0]) + ":" + numberText(v[1]) + ":" + numberText(v[2]);
}

Vec3d parseAxis(std::string_view text) {
  constexpr std::string_view kMust = "x, y, z or three numbers X:Y:Z, not all 0";
  if (text == "x") return Vec3d::UnitX();
  if (text == "y") return Vec3d::UnitY();
  if (text == "z") return Vec3d::UnitZ();
  const auto parts = split(text, ':');
  if (parts.size() != 3) refuse(kMust, text);
  Vec3d axis;
  constexpr double kMost = 1e6;
  for (int i = 0; i < 3; ++i)
    axis[i] = parseNumber(parts[static_cast<std::size_t>(i)], -kMost, kMost, kMust);
  if (axis.cwiseAbs().maxCoeff() < 1 / kMost) refuse(kMust, text);
  return axis;
}

constexpr std::string_view kColorMust = "colours R:G:B from 0 to 1, or #rrggbb";

Vec3d parseScreenColor(std::string_view text) {
  unsigned digits = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), digits, 16);
  if (text.size() != 7 || error != std::errc() || end != text.data() + text.size())
    refuse(kColorMust, text);
  constexpr double kMost = 255;
  return {linearFromScreen((digits >> 16U & 255U) / kMost),
          linearFromScreen((digits >> 8U & 255U) / kMost),
          linearFromScreen((digits & 255U) / kMost)};
}

Vec3d parseColor(std::string_view text) {
  if (text.starts_with('#')) return parseScreenColor(text);
  const auto parts = split(text, ':');
  if (parts.size() != 3) refuse(kColorMust, text);
  Vec3d color;
  for (int i = 0; i < 3; ++i)
    color[i] = parseNumber(parts[static_cast<std::size_t>(i)], 0, 1, kColorMust);
  return color;
}

std::vector<Vec3d> parseColors(std::string_view text) {
  std::vector<Vec3d> colors;
  for (const std::string_view part : split(text, '/')) colors.push_back(parseColor(part));
  if (colors.size() < kLeastColors || colors.size() > kMostColors)
    refuse(std::to_string(kLeastColors) + " to " + std::to_string(kMostColors) + " colours", text);
  return colors;
}

std::string colorsText(const std::vector<Vec3d>& colors) {
  std::string text;
  for (const Vec3d& color : colors) text += (text.empty() ? "" : "/") + vectorText(color);
  return text;
}

// The table of parameters

struct Parameter {
  std::string_view name;
  void (*set)(TextureSpec&, std::string_view);
  std::string (*text)(const TextureSpec&);  ///< empty: not set
};

void setMortar(TextureSpec& t, std::string_view v) {
  t.mortar = parseNumber(v, 0, 1, "a number from 0 to 1");
}
void setSeed(TextureSpec& t, std::string_view v) {
  constexpr std::string_view kMust = "a whole number from 0 to 4294967295";
  const double seed = parseNumber(v, 0, std::numeric_limits<std::uint32_t>::max(), kMust);
  if (seed != std::floor(seed)) refuse(kMust, v);
  t.seed = static_cast<std::uint32_t>(seed);
}
void setOctaves(TextureSpec& t, std::string_view v) {
  constexpr std::string_view kMust = "a whole number from 1 to 16";
  const double octaves = parseNumber(v, 1, kMostOctaves, kMust);
  if (octaves != std::floor(octaves)) refuse(kMust, v);
  t.octaves = static_cast<int>(octaves);
}
void setSpace(TextureSpec& t, std::string_view v) {
  if (v != "object" && v != "world") refuse("object or world", v);
  t.inWorld = v == "world";
}
void setWrap(TextureSpec& t, std::string_view v) {
  if (v != "repeat" && v != "clamp") refuse("repeat or clamp", v);
  t.clamp = v == "clamp";
}
std::string optionalText(const std::optional<double>& value) {
  return value ? numberText(*value) : "";
}

constexpr std::string_view kAnyNumber = "a number";
constexpr std::array<Parameter, 12> kParameters = {{
    {"scale",
     [](TextureSpec& t, std::string_view v) {
       t.scale = parseNumber(v, kLeastScale, kMostLength, "a number above 0");
     },
     [](const TextureSpec& t) { return optionalText(t.scale); }},
    {"space", setSpace, [](const TextureSpec& t) { return std::string(t.inWorld ? "world" : ""); }},
    {"axis", [](TextureSpec& t, std::string_view v) { t.axis = parseAxis(v); },
     [](const TextureSpec& t) { return vectorText(t.axis); }},
    {"turbulence",
     [](TextureSpec& t, std::string_view v) {
       t.turbulence = parseNumber(v, 0, kMostTurbulence, "a number from 0 to 100");
     },
     [](const TextureSpec& t) { return numberText(t.turbulence); }},
    {"octaves", setOctaves, [](const TextureSpec& t) { return std::to_string(t.octaves); }},
    {"seed", setSeed, [](const TextureSpec& t) { return std::to_string(t.seed); }},
    {"from",
     [](TextureSpec& t, std::string_view v) {
       t.from = parseNumber(v, -kMostLength, kMostLength, kAnyNumber);
     },
     [](const TextureSpec& t) { return optionalText(t.from); }},
    {"to",
     [](TextureSpec& t, std::string_view v) {
       t.to = parseNumber(v, -kMostLength, kMostLength, kAnyNumber);
     },
     [](const TextureSpec& t) { return optionalText(t.to); }},
    {"mortar", setMortar, [](const TextureSpec& t) { return numberText(t.mortar); }},
    {"colors", [](TextureSpec& t, std::string_view v) { t.colors = parseColors(v); },
     [](const TextureSpec& t) { return colorsText(t.colors); }},
    {"file", [](TextureSpec& t, std::string_view v) { t.file = v; },
     [](const TextureSpec& t) { return t.file; }},
    {"wrap", setWrap, [](const TextureSpec& t) { return std::string(t.clamp ? "clamp" : ""); }},
}};

const Parameter& parameterNamed(std::string_view name) {
  return *std::find_if(kParameters.begin(), kParameters.end(),
                       [&](const Parameter& p) { return p.name == name; });
}

// The table of kinds

struct Kind {
  std::string_view name;
  TextureKind kind;
  std::string_view parameters;  ///< names with blanks between them
  // Defaults:
  std::string_view colors;
  double turbulence;
  int octaves;
};

constexpr double kMortar = 0.15;
constexpr std::array<Kind, 8> kKinds = {{
    {"checker", TextureKind::kChecker, "scale space colors", "#f2f2f2/#c03a2b", 0, 1},
    {"stripes", TextureKind::kStripes, "scale axis turbulence octaves seed space colors",
     "#f2f2f2/#2f6db3", 0, 1},
    {"rings", TextureKind::kRings, "scale axis turbulence octaves seed space colors",
     "#d9a566/#b97a3d/#7a4420", 0.4, 2},
    {"marble", TextureKind::kMarble, "scale axis turbulence octaves seed space colors",
     "#3f434f/#c9c8c6/#f4f2ec", 1.2, 5},
    {"noise", TextureKind::kNoise, "scale octaves seed space colors", "#1f3a5f/#f0e6d2", 0, 4},
    {"gradient", TextureKind::kGradient, "axis from to space colors", "#203080/#f0c040", 0, 1},
    {"brick", TextureKind::kBrick, "scale mortar seed space colors", "#9c4a34/#b3593d/#d8d2c4", 0,
     1},
    {"image", TextureKind::kImage, "file wrap", "", 0, 1},
}};

const Kind& tableOf(TextureKind kind) {
  return *std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return k.kind == kind; });
}

std::string withCommas(std::string_view words) {
  std::string list;
  for (const std::string_view word : split(words, ' '))
    list += (list.empty() ? "" : ", ") + std::string(word);
  return list;
}

}  // namespace

std::string allTextureNames() {
  std::string names;
  for (const Kind& kind : kKinds) names += (names.empty() ? "" : ", ") + std::string(kind.name);
  return names;
}

TextureSpec textureNamed(std::string_view name) {
  const auto kind =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return k.name == name; });
  if (kind == kKinds.end())
    throw UsageError("unknown texture '" + std::string(name) + "'; known are " + allTextureNames());
  TextureSpec texture;
  texture.kind = kind->kind;
  texture.turbulence = kind->turbulence;
  texture.octaves = kind->octaves;
  texture.mortar = texture.kind == TextureKind::kBrick ? kMortar : 0;
  if (!kind->colors.empty()) texture.colors = parseColors(kind->colors);
  return texture;
}

void setTexture(TextureSpec& texture, std::string_view key, std::string_view value) {
  const Kind& kind = tableOf(texture.kind);
  const auto known = split(kind.parameters, ' ');
  if (std::find(known.begin(), known.end(), key) == known.end())
    throw UsageError("texture " + std::string(kind.name) + " has no '" + std::string(key) +
                     "'; it has " + withCommas(kind.parameters));
  try {
    parameterNamed(key).set(texture, value);
  } catch (const UsageError& error) {
    throw UsageError("texture " + std::string(kind.name) + ": " + std::string(key) + " " +
                     error.what());
  }
}

void requireComplete(const TextureSpec& texture) {
  if (texture.kind == TextureKind::kImage && texture.file.empty())
    throw UsageError("texture image needs a file: image:file=wood.png");
}

TextureSpec parseTexture(std::string_view text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  TextureSpec texture = textureNamed(text.substr(0, colon));
  std::vector<std::string_view> said;
  const bool plain = colon == text.size();
  for (const std::string_view setting :
       plain ? std::vector<std::string_view>{} : split(text.substr(colon + 1), ',')) {
    const std::size_t equals = std::min(setting.find('='), setting.size());
    const std::string_view key = setting.substr(0, equals);
    if (std::find(said.begin(), said.end(), key) != said.end())
      throw UsageError("texture '" + std::string(text) + "' says " + std::string(key) + " twice");
    said.push_back(key);
    setTexture(texture, key, setting.substr(std::min(equals + 1, setting.size())));
  }
  requireComplete(texture);
  return texture;
}

std::string textureText(const TextureSpec& texture) {
  const Kind& kind = tableOf(texture.kind);
  std::string settings;
  for (const std::string_view name : split(kind.parameters, ' ')) {
    const std::string value = parameterNamed(name).text(texture);
    if (!value.empty()) settings += (settings.empty() ? "" : ",") + std::string(name) + "=" + value;
  }
  return std::string(kind.name) + ":" + settings;
}

}  // namespace vox
