#pragma once

#include "libvox/io/gltf_value.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace vox {

/// The numbers of an accessor: `count` elements of 1 to 4 components. All are within the file.
struct GltfNumbers {
  const char* first;
  std::uint64_t stride;  ///< bytes from one element to the next
  std::uint64_t count;
  std::uint64_t type;  ///< of the components, by the number that glTF has for it
  int components;
  bool normalized;  ///< integers stand for 0 to 1, or -1 to 1 if they have a sign

  double at(std::uint64_t element, int component) const;
};

/// A glTF 2.0 file, text (.gltf) or binary (.glb), and the buffers that it refers to. Everything
/// that is asked for is checked against the sizes of what holds it.
///
/// Source: Khronos Group, "glTF 2.0 Specification", 2021.
class GltfFile {
 public:
  /// @param content  must outlive this object
  /// @param name     for messages; its folder is that of external buffers
  /// @throws InputError  no glTF 2.0, or truncated
  GltfFile(std::string_view content, const std::string& name);
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  const std::string& name() const { return name_; }
  std::filesystem::path folder() const { return std::filesystem::path(name_).parent_path(); }
  GltfValue root() const { return {json_, "", name_}; }

  /// Bytes of a binary file after its end.
  std::size_t trailingBytes() const { return trailingBytes_; }

  /// The item of a list of the file, such as "meshes".
  /// @param index  for messages, too
  GltfValue item(const char* list, const GltfValue& index) const;

  /// Number of items of a list of the file.
  std::size_t size(const char* list) const;

  /// The bytes of a buffer view. Reads external buffers.
  std::string_view bytesOf(const GltfValue& bufferView);

  /// @throws InputError  besides, the accessor is sparse or compressed
  GltfNumbers numbersOf(const GltfValue& accessor);

  /// The external files that were read.
  const std::vector<std::string>& companions() const { return companions_; }

 private:
  std::string_view bufferOf(const GltfValue& buffer);

  std::string name_;
  nlohmann::json json_;
  std::string_view binaryChunk_;
  bool isBinary_ = false;
  std::size_t trailingBytes_ = 0;
  std::map<std::string, std::string> buffers_;  // by URI; data URIs by place
  std::vector<std::string> companions_;
};

/// True for a URI that holds its data.
bool isDataUri(std::string_view uri);

/// The data of such a URI.
/// @param place  has the URI, for messages
std::string dataOf(std::string_view uri, const GltfValue& place);

/// The file that a URI names.
/// @param folder  of the file that has the URI
std::filesystem::path fileOfUri(std::string_view uri, const std::filesystem::path& folder);

}  // namespace vox
