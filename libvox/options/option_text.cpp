// The options of a conversion as one line of text. Writing and reading share one list of fields.

#include "libvox/options/option_text.h"

#include "libvox/core/error.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <system_error>
#include <type_traits>

namespace vox {
namespace {

constexpr std::string_view kSeparating = "-separating";

/// Calls visit(key, field) for each option, in the order of the text; names of an enumeration
/// follow the field.
template <class Options, class Visit>
void forEachField(Options& options, Visit&& visit) {
  visit("scale", options.scale);
  visit("voxel-size", options.voxelSize);
  visit("dim", options.dim);
  visit("origin", options.origin);
  visit("bounds", options.bounds);
  visit("clip", options.clip);
  visit("boundary", options.smoothing.boundary, kBoundaryRuleNames);
  visit("interpolate", options.smoothing.interpolate, kInterpolateNames);
  visit("interpolated-vertices", options.smoothing.interpolatedVertices);
  visit("faces", options.smoothing.faces, kFaceRuleNames);
  visit("crease", options.smoothing.crease);
  visit("crease-edges", options.smoothing.creaseEdges);
  visit("corner-vertices", options.smoothing.cornerVertices);
  visit("weld", options.weldTolerance);
  visit("drop-components", options.dropComponents);
  visit("texture", options.texture);
  visit("part-by", options.partBy, kPartByNames);
  visit("split", options.split, kSplitNames);
  visit("fill", options.volume.fill, kFillNames);
  visit("edge", options.volume.edge, kEdgeNames);
  visit("alpha", options.volume.alpha, kAlphaNames);
  visit("gain", options.volume.gain);
  visit("open-mesh", options.volume.openMesh, kOpenMeshNames);
  visit("close", options.volume.close);
  visit("band", options.volume.band);
  visit("tolerance", options.volume.tolerance);
  visit("half", options.volume.half);
  visit("target", options.volume.target, kTargetNames);
  visit("up", options.volume.up, kUpAxisNames);
  visit("until", options.until);
  visit("voxelize", options.voxelize, kVoxelizeNames);
}

class Writer {
 public:
  Writer() { text_.precision(std::numeric_limits<double>::max_digits10); }

  template <class T, class... Names>
  void operator()(const char* key, const std::optional<T>& value, const Names&... names) {
    if (value) write(key, *value, names...);
  }

  std::string text() const { return text_.str(); }

 private:
  std::ostream& begin(const char* key) { return text_ << (text_.tellp() > 0 ? " " : "") << key; }
  template <class T>
  void write(const char* key, const T& value) {
    begin(key) << '=' << value;
  }
  void write(const char* key, bool value) {
    if (value) begin(key);
  }
  template <class T>
  void write(const char* key, const std::vector<T>& list) {
    write(key, list.size());
  }
  template <class Number, std::size_t N>
  void write(const char* key, const std::array<Number, N>& numbers) {
    write(key, numbers[0]);
    for (std::size_t i = 1; i < N; ++i) text_ << ',' << numbers[i];
  }
  void write(const char* key, const CreaseRule& rule) { write(key, creaseRuleName(rule)); }
  void write(const char* key, const BandWidths& band) {
    write(key, band.in);
    if (!band.isSymmetric()) text_ << ',' << band.out;
  }
  void write(const char* key, const TextureSpec& texture) { write(key, textureText(texture)); }
  void write(const char* key, const ComponentLimit& limit) {
    write(key, componentLimitText(limit));
  }
  void write(const char* key, const StopRule& rule) { write(key, stopRuleName(rule)); }
  template <class Enum, std::size_t N>
  void write(const char* key, Enum value, const NameTable<Enum, N>& names) {
    write(key, nameIn(names, value));
  }

  std::ostringstream text_;
};

template <class Number>
std::optional<Number> anyNumberIn(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>)
    if (!std::isfinite(number)) return std::nullopt;
  return number;
}

/// A number of 0 or more, as most options have.
template <class Number>
std::optional<Number> numberIn(std::string_view text) {
  const std::optional<Number> number = anyNumberIn<Number>(text);
  if constexpr (std::is_signed_v<Number>)
    if (number && *number < 0) return std::nullopt;
  return number;
}

/// N numbers with commas between them.
template <class Number, std::size_t N>
std::optional<std::array<Number, N>> numbersIn(std::string_view text) {
  std::array<Number, N> numbers{};
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t comma = text.find(',');
    const auto number = anyNumberIn<Number>(text.substr(0, comma));
    if (!number || (comma == std::string_view::npos) != (i + 1 == N)) return std::nullopt;
    numbers[i] = *number;
    if (i + 1 < N) text.remove_prefix(comma + 1);
  }
  return numbers;
}

/// Reads one word into the field that has its key.
class Reader {
 public:
  Reader(std::string_view word, RecordedOptions& recorded)
      : key_(word.substr(0, word.find('='))), recorded_(recorded) {
    if (key_.size() < word.size()) value_ = word.substr(key_.size() + 1);
  }

  /// False: no field has the key, or the field cannot have the value.
  bool done() const { return done_; }

  template <class T, class... Names>
  void operator()(const char* key, std::optional<T>& field, const Names&... names) {
    if (key_ == key) done_ = read(field, names...);
  }

 private:
  template <class T>
  static bool take(const std::optional<T>& value, std::optional<T>& field) {
    if (value) field = value;
    return value.has_value();
  }

  template <class Number>
  bool read(std::optional<Number>& field) const {
    return value_ && take(numberIn<Number>(*value_), field);
  }
  bool read(std::optional<bool>& field) const {
    field = true;
    return !value_;
  }
  template <class T>
  bool read(std::optional<std::vector<T>>&) const {
    if (!value_ || !numberIn<std::uint64_t>(*value_)) return false;
    recorded_.lists.emplace_back(key_);
    return true;
  }
  template <class Number, std::size_t N>
  bool read(std::optional<std::array<Number, N>>& field) const {
    return value_ && take(numbersIn<Number, N>(*value_), field);
  }
  bool read(std::optional<CreaseRule>& field) const {
    return value_ && take(creaseRuleNamed(*value_), field);
  }
  bool read(std::optional<StopRule>& field) const {
    return value_ && take(stopRuleNamed(*value_), field);
  }
  bool read(std::optional<ComponentLimit>& field) const {
    return value_ && take(componentLimitIn(*value_), field);
  }
  bool read(std::optional<BandWidths>& field) const {
    return value_ && take(bandWidthsIn(*value_), field);
  }
  bool read(std::optional<TextureSpec>& field) const {
    if (!value_) return false;
    try {
      field = parseTexture(*value_);
      return true;
    } catch (const UsageError&) {
      return false;
    }
  }
  template <class Enum, std::size_t N>
  bool read(std::optional<Enum>& field, const NameTable<Enum, N>& names) const {
    return value_ && take(namedIn(names, *value_), field);
  }

  std::string_view key_;
  std::optional<std::string_view> value_;
  RecordedOptions& recorded_;
  bool done_ = false;
};

}  // namespace

std::string optionText(const ConvertOptions& options) {
  Writer writer;
  forEachField(options, writer);
  return writer.text();
}

RecordedOptions parseOptionText(std::string_view text) {
  RecordedOptions recorded;
  std::istringstream words{std::string(text)};
  for (std::string word; words >> word;) {
    Reader reader(word, recorded);
    forEachField(recorded.options, reader);
    if (!reader.done())
      throw InputError(std::string(kOptionsMetadata) + " has '" + word +
                       "', which is no option of vox or no value of that option");
  }
  return recorded;
}

std::string guaranteeText(Separation separation) {
  return nameIn(kSeparationNames, separation) + std::string(kSeparating);
}

Separation parseGuarantee(std::string_view text) {
  if (text.ends_with(kSeparating))
    if (const auto known =
            namedIn(kSeparationNames, text.substr(0, text.size() - kSeparating.size())))
      return *known;
  throw InputError(std::string(kGuaranteeMetadata) + " is '" + std::string(text) +
                   "', which is no guarantee that vox gives");
}

}  // namespace vox
