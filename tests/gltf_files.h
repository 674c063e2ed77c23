#pragma once

#include "tests/mesh_files.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// glTF files by hand, for tests of the reader.
namespace vox::test {

inline std::string base64Of(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[bits >> (18U - 6U * k) & 63U] : '=';
  }
  return text;
}

inline std::string dataUri(std::string_view bytes) {
  return "data:application/octet-stream;base64," + base64Of(bytes);
}

/// The buffer of a glTF file, its views and accessors, numbered in the order in which they are
/// added.
class GltfBuffer {
 public:
  /// Adds an accessor with a view of its own.
  /// @param more  members of the accessor, each with a comma before it
  template <typename T>
  GltfBuffer& add(int componentType, int components, const std::vector<T>& values,
                  const std::string& more = "") {
    constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    std::string bytes;
    for (const T value : values) append(bytes, value);
    addBytes(bytes);
    return addAccessor("\"bufferView\":" + std::to_string(viewCount_ - 1) +
                       ",\"componentType\":" + std::to_string(componentType) + ",\"count\":" +
                       std::to_string(values.size() / static_cast<std::size_t>(components)) +
                       ",\"type\":\"" + kTypes[components] + "\"" + more);
  }

  GltfBuffer& addAccessor(const std::string& members) {
    accessors_ += (accessors_.empty() ? "{" : ",{") + members + "}";
    return *this;
  }

  /// Adds a buffer view.
  /// @param more  members of it, each with a comma before it
  GltfBuffer& addBytes(std::string_view bytes, const std::string& more = "") {
    views_ += (views_.empty() ? "{" : ",{") + std::string("\"buffer\":0,\"byteOffset\":") +
              std::to_string(bytes_.size()) + ",\"byteLength\":" + std::to_string(bytes.size()) +
              more + "}";
    bytes_ += bytes;
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    ++viewCount_;
    return *this;
  }

  const std::string& bytes() const { return bytes_; }

  /// A .gltf file.
  /// @param rest  members of the file besides the buffer, views and accessors
  /// @param uri   of the buffer
  std::string text(const std::string& rest, const std::string& uri) const {
    return json(rest, ",\"uri\":\"" + uri + "\"");
  }
  std::string text(const std::string& rest) const { return text(rest, dataUri(bytes_)); }

  /// A .glb file.
  std::string binary(const std::string& rest) const {
    std::string text = json(rest, "");
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string file = "glTF";
    append(file, std::uint32_t{2});
    append(file, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bytes_.size()));
    append(file, static_cast<std::uint32_t>(text.size()));
    file += "JSON" + text;
    append(file, static_cast<std::uint32_t>(bytes_.size()));
    file += std::string("BIN\0", 4) + bytes_;
    return file;
  }

 private:
  std::string json(const std::string& rest, const std::string& uri) const {
    return "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":" +
           std::to_string(bytes_.size()) + uri + "}],\"bufferViews\":[" + views_ +
           "],\"accessors\":[" + accessors_ + "]," + rest + "}";
  }

  std::string bytes_, views_, accessors_;
  int viewCount_ = 0;
};

/// One mesh of one set of triangles in one node.
/// @param primitive  its members
/// @param node       members of the node, each with a comma before it
inline std::string oneMesh(const std::string& primitive, const std::string& node = "") {
  return "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0" + node +
         "}],\"meshes\":[{\"primitives\":[{" + primitive + "}]}]";
}

}  // namespace vox::test
