// Values in the JSON of a glTF file, checked.

#include "libvox/io/gltf_value.h"

#include "libvox/core/error.h"

#include <cmath>
#include <string>
#include <utility>

namespace vox {

void GltfValue::fail(const std::string& what) const {
  throw InputError(*file_ + ": " + (place_.empty() ? "the glTF" : place_) + " " + what);
}

std::optional<GltfValue> GltfValue::find(const char* key) const {
  if (!json_->is_object()) fail("is no object");
  const auto found = json_->find(key);
  if (found == json_->end()) return {};
  return GltfValue(*found, place_ + (place_.empty() ? "" : ".") + key, *file_);
}

GltfValue GltfValue::at(const char* key) const {
  std::optional<GltfValue> found = find(key);
  if (!found) fail(std::string("lacks ") + key);
  return *std::move(found);
}

std::vector<GltfValue> GltfValue::items() const {
  if (!json_->is_array()) fail("is no list");
  std::vector<GltfValue> items;
  items.reserve(json_->size());
  for (const nlohmann::json& item : *json_)
    items.emplace_back(item, place_ + "[" + std::to_string(items.size()) + "]", *file_);
  return items;
}

std::vector<double> GltfValue::numbers(std::size_t count) const {
  if (!json_->is_array() || json_->size() != count)
    fail("is no list of " + std::to_string(count) + " numbers");
  std::vector<double> numbers;
  for (const GltfValue& item : items()) numbers.push_back(item.number());
  return numbers;
}

std::uint64_t GltfValue::whole() const {
  const double value = json_->is_number() ? json_->get<double>() : -1;
  if (!(value >= 0 && value <= 0x1p53) || value != std::floor(value))
    fail("is no whole number from 0 to 2^53");
  return static_cast<std::uint64_t>(value);
}

double GltfValue::number() const {
  if (!json_->is_number()) fail("is no number");
  return json_->get<double>();
}

bool GltfValue::flag() const {
  if (!json_->is_boolean()) fail("is neither true nor false");
  return json_->get<bool>();
}

const std::string& GltfValue::text() const {
  if (!json_->is_string()) fail("is no text");
  return json_->get_ref<const std::string&>();
}

std::uint64_t GltfValue::wholeOr(const char* key, std::uint64_t missing) const {
  const std::optional<GltfValue> found = find(key);
  return found ? found->whole() : missing;
}

std::string GltfValue::textOr(const char* key, std::string_view missing) const {
  const std::optional<GltfValue> found = find(key);
  return found ? found->text() : std::string(missing);
}

std::string GltfValue::nameOr(const std::string& missing) const {
  std::string name = textOr("name", missing);
  for (char& c : name)
    if ((c >= 0 && c < ' ') || c == '\x7f') c = ' ';
  return name.empty() ? missing : name;
}

bool GltfValue::hasExtension(const char* name) const {
  const std::optional<GltfValue> extensions = find("extensions");
  return extensions && extensions->find(name);
}

}  // namespace vox
