// glTF files: the container, buffers, buffer views and accessors.

#include "libvox/io/gltf_file.h"

#include "libvox/core/error.h"
#include "libvox/io/byte_order.h"
#include "libvox/io/companion_file.h"
#include "libvox/io/input_file.h"
#include "libvox/io/text_scanner.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

namespace vox {
namespace {

constexpr std::string_view kGlbMagic = "glTF";
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::string_view kJsonChunk = "JSON";
constexpr std::string_view kBinaryChunk{"BIN\0", 4};

constexpr std::uint64_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                        kUnsignedInt = 5125, kFloat = 5126;

/// Size in bytes of a component; 0 if there is no such type.
std::uint64_t sizeOfType(std::uint64_t type) {
  if (type == kByte || type == kUnsignedByte) return 1;
  if (type == kShort || type == kUnsignedShort) return 2;
  return type == kUnsignedInt || type == kFloat ? 4 : 0;
}

/// The sections of a .glb file.
struct Chunks {
  std::string_view json;
  std::string_view binary = {};
  std::size_t trailingBytes = 0;
};

Chunks chunksOf(std::string_view content, const std::string& name) {
  const auto fail = [&](const std::string& what) { throw InputError(name + ": " + what); };
  const auto wordAt = [&](std::size_t at) {
    return loadNumber<std::uint32_t>(content.data() + at, std::endian::little);
  };
  if (content.size() < kHeaderBytes) fail("truncated: ends within the header of 12 bytes");
  if (const std::uint32_t version = wordAt(4); version != 2)
    fail("is glTF of version " + std::to_string(version) + "; export it as glTF 2.0");
  const std::size_t length = wordAt(8);
  if (length > content.size())
    fail("truncated: the header says " + std::to_string(length) + " bytes, the file has " +
         std::to_string(content.size()));
  Chunks chunks{.json = {}, .trailingBytes = content.size() - length};
  std::size_t at = kHeaderBytes;
  for (int chunk = 0; at < length; ++chunk) {
    const std::size_t rest = length - at;
    if (rest < kChunkHeaderBytes || wordAt(at) > rest - kChunkHeaderBytes)
      fail("truncated: ends within chunk " + std::to_string(chunk));
    const std::string_view type = content.substr(at + 4, 4);
    const std::string_view bytes = content.substr(at + kChunkHeaderBytes, wordAt(at));
    if (chunk == 0 && type == kJsonChunk) chunks.json = bytes;
    if (chunk == 1 && type == kBinaryChunk) chunks.binary = bytes;
    at += kChunkHeaderBytes + bytes.size();
  }
  if (chunks.json.empty()) fail("damaged: its first chunk is no JSON");
  return chunks;
}

nlohmann::json parsedJson(std::string_view text, const std::string& name, bool isBinary) {
  std::string place = name + ": ";
  try {
    return nlohmann::json::parse(text.begin(), text.end());
  } catch (const nlohmann::json::parse_error& error) {
    const auto end = static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    const auto line = 1 + std::count(text.begin(), text.begin() + end, '\n');
    if (!isBinary) place = name + ":" + std::to_string(line) + ": ";
    throw InputError(place + "malformed JSON" +
                     (isBinary ? " at its byte " + std::to_string(error.byte) : ""));
  } catch (const nlohmann::json::exception&) {
    throw InputError(place + "malformed JSON: a number is too large");
  }
}

void checkVersion(const GltfValue& root) {
  const GltfValue asset = root.at("asset");
  const auto check = [](const GltfValue& version) {
    if (!version.text().starts_with("2.") ||
        (version.place() == "asset.minVersion" && version.text() != "2.0"))
      version.fail("is " + quote(version.text()) + "; export the model as glTF 2.0");
  };
  check(asset.at("version"));
  if (const auto least = asset.find("minVersion")) check(*least);
}

std::string percentDecoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    const char* const digits = text.data() + i + 1;
    const bool isCode = text[i] == '%' && i + 2 < text.size() &&
                        std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
    decoded += isCode ? static_cast<char>(code) : text[i];
    if (isCode) i += 2;
  }
  return decoded;
}

/// Nothing if the text is no Base64.
std::optional<std::string> base64Decoded(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<int, 256> valueOf;
  valueOf.fill(-1);
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    valueOf[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  unsigned bits = 0;
  int count = 0;  // of bits that wait
  for (const char digit : text) {
    const int value = valueOf[static_cast<unsigned char>(digit)];
    if (value < 0) return {};
    bits = (bits << 6U | static_cast<unsigned>(value)) & 0xFFFFU;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> static_cast<unsigned>(count) & 0xFFU);
  }
  return bytes;
}

int componentsOf(const GltfValue& type) {
  constexpr std::array<std::string_view, 4> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  const auto found = std::find(kTypes.begin(), kTypes.end(), type.text());
  if (found == kTypes.end())
    type.fail("is " + quote(type.text()) + "; expected SCALAR, VEC2, VEC3 or VEC4");
  return static_cast<int>(found - kTypes.begin()) + 1;
}

}  // namespace

double GltfNumbers::at(std::uint64_t element, int component) const {
  const char* const at =
      first + stride * element + sizeOfType(type) * static_cast<std::uint64_t>(component);
  const auto number = [&]<class T>(T) { return loadNumber<T>(at, std::endian::little); };
  const auto integer = [&]<class T>(T zero) {
    const double value = number(zero);
    constexpr double kLargest = std::numeric_limits<T>::max();
    return normalized ? std::max(value / kLargest, -1.0) : value;
  };
  if (type == kFloat) return static_cast<double>(number(float{}));
  if (type == kByte) return integer(std::int8_t{});
  if (type == kUnsignedByte) return integer(std::uint8_t{});
  if (type == kShort) return integer(std::int16_t{});
  if (type == kUnsignedShort) return integer(std::uint16_t{});
  return integer(std::uint32_t{});
}

GltfFile::GltfFile(std::string_view content, const std::string& name) : name_(name) {
  isBinary_ = content.starts_with(kGlbMagic);
  if (isBinary_) {
    const Chunks chunks = chunksOf(content, name_);
    content = chunks.json;
    binaryChunk_ = chunks.binary;
    trailingBytes_ = chunks.trailingBytes;
  }
  json_ = parsedJson(content, name_, isBinary_);
  checkVersion(root());
}

GltfValue GltfFile::item(const char* list, const GltfValue& index) const {
  const std::uint64_t number = index.whole();
  const std::size_t count = size(list);
  if (number >= count)
    index.fail("is " + std::to_string(number) + "; the file has " + std::to_string(count) + " " +
               list);
  return {json_[list][number], std::string(list) + "[" + std::to_string(number) + "]", name_};
}

std::size_t GltfFile::size(const char* list) const {
  const std::optional<GltfValue> found = root().find(list);
  if (!found) return 0;
  if (!found->json_->is_array()) found->fail("is no list");
  return found->json_->size();
}

std::string_view GltfFile::bufferOf(const GltfValue& buffer) {
  const std::uint64_t length = buffer.at("byteLength").whole();
  std::string_view bytes = binaryChunk_;
  if (const auto uri = buffer.find("uri")) {
    const bool isData = isDataUri(uri->text());
    const auto [known, isNew] =
        buffers_.try_emplace(isData ? "data:" + buffer.place() : uri->text());
    if (isNew && isData) {
      known->second = dataOf(uri->text(), *uri);
    } else if (isNew) {
      const std::filesystem::path file = fileOfUri(uri->text(), folder());
      try {
        known->second = std::string_view(contentsOf(file));
      } catch (const InputError& error) {
        buffer.fail(std::string("cannot be read: ") + error.what());
      }
      companions_.push_back(file.string());
    }
    bytes = known->second;
  } else if (!isBinary_ || buffer.place() != "buffers[0]") {
    buffer.fail("lacks uri");
  }
  if (length > bytes.size())
    buffer.fail("has " + std::to_string(bytes.size()) + " bytes; expected " +
                std::to_string(length));
  return bytes.substr(0, length);
}

std::string_view GltfFile::bytesOf(const GltfValue& bufferView) {
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    if (bufferView.hasExtension(name))
      bufferView.fail(std::string("is compressed (") + name +
                      "); export the model without compression");
  const std::string_view buffer = bufferOf(item("buffers", bufferView.at("buffer")));
  const std::uint64_t offset = bufferView.wholeOr("byteOffset", 0);
  const std::uint64_t length = bufferView.at("byteLength").whole();
  if (offset > buffer.size() || length > buffer.size() - offset)
    bufferView.fail("reaches beyond its buffer of " + std::to_string(buffer.size()) + " bytes");
  return buffer.substr(offset, length);
}

GltfNumbers GltfFile::numbersOf(const GltfValue& accessor) {
  if (accessor.find("sparse"))
    accessor.fail("is sparse; export the model without sparse accessors");
  if (!accessor.find("bufferView")) accessor.fail("lacks bufferView");
  const GltfValue view = item("bufferViews", accessor.at("bufferView"));
  const std::string_view bytes = bytesOf(view);
  GltfNumbers numbers{};
  numbers.count = accessor.at("count").whole();
  numbers.type = accessor.at("componentType").whole();
  numbers.components = componentsOf(accessor.at("type"));
  const auto normalized = accessor.find("normalized");
  numbers.normalized = normalized && normalized->flag();
  const std::uint64_t size =
      sizeOfType(numbers.type) * static_cast<std::uint64_t>(numbers.components);
  if (size == 0) accessor.at("componentType").fail("is none of glTF's types");
  numbers.stride = view.wholeOr("byteStride", size);
  if (numbers.stride < size)
    view.fail("has a byteStride of less than the " + std::to_string(size) + " bytes of " +
              accessor.place());
  const std::uint64_t offset = accessor.wholeOr("byteOffset", 0);
  const bool fits = offset <= bytes.size() &&
                    (numbers.count == 0 ||
                     (size <= bytes.size() - offset &&
                      numbers.count - 1 <= (bytes.size() - offset - size) / numbers.stride));
  if (!fits)
    accessor.fail("of " + std::to_string(numbers.count) + " elements reaches beyond " +
                  view.place() + " of " + std::to_string(bytes.size()) + " bytes");
  numbers.first = bytes.data() + offset;
  return numbers;
}

bool isDataUri(std::string_view uri) {
  return uri.starts_with("data:");
}

std::string dataOf(std::string_view uri, const GltfValue& place) {
  const std::size_t comma = uri.find(',');
  if (comma == uri.npos) place.fail("is a data URI without data");
  const std::string_view data = uri.substr(comma + 1);
  if (!uri.substr(0, comma).ends_with(";base64")) return percentDecoded(data);
  std::optional<std::string> bytes = base64Decoded(data);
  if (!bytes) place.fail("is a damaged data URI: it is no Base64");
  return *std::move(bytes);
}

std::filesystem::path fileOfUri(std::string_view uri, const std::filesystem::path& folder) {
  return foundCompanion(companionPath(percentDecoded(uri), folder), folder);
}

}  // namespace vox
