#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vox {

/// A value in the JSON of a glTF file, with its place for messages, such as "accessors[3].count".
/// Every access checks the type. Keeps references to the JSON and to the name of the file.
class GltfValue {
 public:
  GltfValue(const nlohmann::json& json, std::string place, const std::string& file)
      : json_(&json), place_(std::move(place)), file_(&file) {}

  const std::string& place() const { return place_; }

  /// @throws InputError  always: "FILE: PLACE WHAT"
  [[noreturn]] void fail(const std::string& what) const;

  /// A member of this object; nothing if it has none of this name.
  /// @throws InputError  this is no object
  std::optional<GltfValue> find(const char* key) const;

  /// A member of this object.
  /// @throws InputError  besides, it is missing
  GltfValue at(const char* key) const;

  /// The items of this list.
  std::vector<GltfValue> items() const;

  /// This list of `count` numbers.
  std::vector<double> numbers(std::size_t count) const;

  /// This whole number from 0 to 2^53.
  std::uint64_t whole() const;

  double number() const;
  bool flag() const;
  const std::string& text() const;

  /// A member that is a whole number or text; or what stands for a missing one.
  std::uint64_t wholeOr(const char* key, std::uint64_t missing) const;
  std::string textOr(const char* key, std::string_view missing) const;

  /// The member "name" in printable characters; or what stands for a missing or empty one.
  std::string nameOr(const std::string& missing) const;

  /// True if this object has an extension of this name.
  bool hasExtension(const char* name) const;

 private:
  const nlohmann::json* json_;
  std::string place_;
  const std::string* file_;

  friend class GltfFile;
};

}  // namespace vox
