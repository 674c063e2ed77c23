// Numbered files.

#include "apps/vox/sequence.h"

#include "libvox/core/error.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>

namespace vox::app {
namespace {

namespace fs = std::filesystem;

/// A file name with a place for a number.
struct Pattern {
  std::string before;  // folder included
  std::size_t digits;  // at least
  std::string after;

  std::string with(std::uint64_t number) const {
    std::string text = std::to_string(number);
    if (text.size() < digits) text.insert(0, digits - text.size(), '0');
    return before + text + after;
  }
};

struct Place {
  std::size_t begin;
  std::size_t end;
  std::size_t digits;
};

/// The first ####, %d or %04d from `begin` on.
std::optional<Place> placeAfter(const std::string& name, std::size_t begin) {
  for (std::size_t i = begin; i < name.size(); ++i) {
    if (name[i] == '#') {
      const std::size_t end = std::min(name.find_first_not_of('#', i), name.size());
      return Place{i, end, end - i};
    }
    if (name[i] != '%') continue;
    std::size_t end = i + 1;
    while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end])) != 0) ++end;
    if (end >= name.size() || name[end] != 'd' || end - i > 3) continue;
    std::size_t digits = 1;
    std::from_chars(name.data() + i + 1, name.data() + end, digits);
    return Place{i, end + 1, std::max<std::size_t>(digits, 1)};
  }
  return std::nullopt;
}

/// @throws UsageError  the name has two places for a number
std::optional<Pattern> patternOf(const std::string& file) {
  const std::size_t name = file.find_last_of('/') + 1;  // 0 if there is no folder
  const auto place = placeAfter(file, name);
  if (!place) return std::nullopt;
  if (placeAfter(file, place->end))
    throw UsageError(file + ": has more than one place for a number; keep one, such as ####");
  return Pattern{file.substr(0, place->begin), place->digits, file.substr(place->end)};
}

/// The number of a file; empty if it does not fit the pattern.
std::optional<std::uint64_t> numberIn(const std::string& file, const Pattern& pattern) {
  const std::size_t around = pattern.before.size() + pattern.after.size();
  if (file.size() <= around || !file.starts_with(pattern.before) || !file.ends_with(pattern.after))
    return std::nullopt;
  const std::string_view text =
      std::string_view(file).substr(pattern.before.size(), file.size() - around);
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (!whole || pattern.with(number) != file) return std::nullopt;
  return number;
}

std::map<std::uint64_t, std::string> filesOf(const Pattern& pattern) {
  const std::size_t slash = pattern.before.find_last_of('/');
  const std::string folder =
      slash == std::string::npos ? std::string() : pattern.before.substr(0, slash + 1);
  std::map<std::uint64_t, std::string> files;
  std::error_code error;
  fs::directory_iterator entries(folder.empty() ? "." : folder, error);
  for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
    const std::string file = folder + entries->path().filename().string();
    if (const auto number = numberIn(file, pattern)) files[*number] = file;
  }
  return files;
}

}  // namespace

std::vector<Frame> framesOf(const std::vector<std::string>& inputs, const std::string& output) {
  std::map<std::uint64_t, std::string> files;
  for (const std::string& input : inputs) files[files.size() + 1] = input;
  if (inputs.size() == 1) {
    const auto pattern = patternOf(inputs[0]);
    std::error_code error;
    if (!pattern || fs::exists(inputs[0], error)) return {{inputs[0], output}};
    files = filesOf(*pattern);
    if (files.empty()) throw InputError(inputs[0] + ": no file has such a name");
  }
  const auto numbered = patternOf(output);
  if (!numbered && !output.empty())
    throw UsageError(output +
                     ": the output of several inputs needs a place for a number, such as "
                     "out.####.vdb; to put them into one file, list them as objects of a scene "
                     "(.toml)");
  std::vector<Frame> frames;
  for (const auto& [number, input] : files)
    frames.push_back({input, numbered ? numbered->with(number) : ""});
  return frames;
}

}  // namespace vox::app
