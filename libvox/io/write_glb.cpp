// Binary glTF 2.0.

#include "libvox/io/write_glb.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/version.h"
#include "libvox/io/byte_order.h"
#include "libvox/io/mesh_buffer.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace vox {
namespace {

using GlbJson = nlohmann::json;

constexpr int kGlbFloat = 5126, kGlbUnsignedInt = 5125;
constexpr int kVertexTarget = 34962, kIndexTarget = 34963;
constexpr int kGlbClamp = 33071, kGlbRepeat = 10497;
constexpr std::uint64_t kGlbHeaderBytes = 12, kGlbChunkBytes = 8;

std::uint64_t padded(std::uint64_t bytes) {
  return (bytes + 3) / 4 * 4;
}

/// 32-bit numbers and bytes of a glTF file.
class BinaryWriter {
 public:
  explicit BinaryWriter(std::ostream& out) : buffer_(out) {}

  template <class T>
  void number(T value) {
    appendLittleEndian(buffer_.bytes(), value);
    buffer_.endItem();
  }
  /// @param filler  up to a multiple of four bytes
  void paddedBytes(std::string_view bytes, char filler) {
    buffer_.bytes() += bytes;
    buffer_.bytes().append(padded(bytes.size()) - bytes.size(), filler);
    buffer_.endItem();
  }
  void finish() { buffer_.finish(); }

 private:
  MeshBuffer buffer_;
};

/// The JSON of a scene, and what its buffer holds.
class GlbDocument {
 public:
  explicit GlbDocument(const ShadedScene& scene) {
    json_["asset"] = {{"version", "2.0"}, {"generator", std::string("vox ") + version()}};
    for (const ShadedObject& object : scene.objects) addObject(object);
    json_["scene"] = 0;
    GlbJson nodes = GlbJson::array();
    for (std::size_t i = 0; i < size("nodes"); ++i) nodes.push_back(i);
    json_["scenes"] = {{{"nodes", nodes}}};
    for (const Material& material : scene.materials) addMaterial(material);
    json_["buffers"] = {{{"byteLength", bytes_}}};
    text_ = json_.dump(-1, ' ', false, GlbJson::error_handler_t::replace);
  }

  std::uint64_t fileBytes() const {
    return kGlbHeaderBytes + 2 * kGlbChunkBytes + padded(text_.size()) + bytes_;
  }

  void write(std::ostream& out) const {
    if (fileBytes() > std::numeric_limits<std::uint32_t>::max())
      throw LimitError("a .glb file holds less than 4 GiB, but this mesh needs " +
                       formatBytes(fileBytes()) + "; use fewer levels, or write .ply");
    BinaryWriter writer(out);
    const auto number = [&](std::uint64_t value) {
      writer.number(static_cast<std::uint32_t>(value));
    };
    writer.paddedBytes("glTF", 0);
    number(2);
    number(fileBytes());
    number(padded(text_.size()));
    writer.paddedBytes("JSON", 0);
    writer.paddedBytes(text_, ' ');
    number(bytes_);
    writer.paddedBytes(std::string_view("BIN\0", 4), 0);
    for (const auto& content : contents_) content(writer);
    writer.finish();
  }

 private:
  std::size_t size(const char* what) const { return json_.contains(what) ? json_[what].size() : 0; }
  /// Appends an item to an array, and returns its number.
  std::size_t push(const char* what, GlbJson item) {
    json_[what].push_back(std::move(item));
    return json_[what].size() - 1;
  }

  /// Adds bytes to the buffer.
  std::size_t addView(std::uint64_t bytes, GlbJson view,
                      std::function<void(BinaryWriter&)> content) {
    view["buffer"] = 0;
    view["byteOffset"] = bytes_;
    view["byteLength"] = bytes;
    bytes_ += padded(bytes);
    contents_.push_back(std::move(content));
    return push("bufferViews", std::move(view));
  }

  /// Adds vectors of 32-bit numbers.
  /// @param numberAt  as numberAt(vector, component)
  template <class Vector, class NumberAt>
  std::size_t addAccessor(const std::vector<Vector>& all, int components, const char* type,
                          bool isIndex, NumberAt numberAt, GlbJson accessor = GlbJson::object()) {
    const auto write = [&all, components, numberAt](BinaryWriter& out) {
      for (const Vector& one : all)
        for (int i = 0; i < components; ++i) out.number(numberAt(one, i));
    };
    const auto count = static_cast<std::uint64_t>(components) * all.size();
    accessor["bufferView"] =
        addView(4 * count, {{"target", isIndex ? kIndexTarget : kVertexTarget}}, write);
    accessor["componentType"] = isIndex ? kGlbUnsignedInt : kGlbFloat;
    accessor["count"] = isIndex ? count : all.size();
    accessor["type"] = type;
    return push("accessors", std::move(accessor));
  }

  std::size_t addPositions(const std::vector<Vec3f>& positions) {
    Vec3f low = positions[0];
    Vec3f high = positions[0];
    for (const Vec3f& position : positions) {
      low = low.cwiseMin(position);
      high = high.cwiseMax(position);
    }
    return addAccessor(positions, 3, "VEC3", false, componentOf<Vec3f>,
                       {{"min", {low[0], low[1], low[2]}}, {"max", {high[0], high[1], high[2]}}});
  }

  template <class Vector>
  static float componentOf(const Vector& vector, int i) {
    return vector[i];
  }

  GlbJson primitiveOf(const ShadedPart& part) {
    GlbJson attributes;
    attributes["POSITION"] = addPositions(part.positions);
    attributes["NORMAL"] = addAccessor(part.normals, 3, "VEC3", false, componentOf<Vec3f>);
    if (!part.texcoords.empty())  // v goes down in glTF
      attributes["TEXCOORD_0"] =
          addAccessor(part.texcoords, 2, "VEC2", false,
                      [](const Vec2f& uv, int i) { return i == 0 ? uv[0] : 1 - uv[1]; });
    if (!part.colors.empty())
      attributes["COLOR_0"] = addAccessor(part.colors, 3, "VEC3", false, componentOf<Vec3f>);
    const std::size_t indices = addAccessor(
        part.triangles, 3, "SCALAR", true,
        [](const std::array<Index, 3>& triangle, int i) { return triangle[std::size_t(i)]; });
    return {{"attributes", attributes}, {"indices", indices}, {"material", part.material}};
  }

  void addObject(const ShadedObject& object) {
    if (object.parts.empty()) return;
    GlbJson primitives = GlbJson::array();
    for (const ShadedPart& part : object.parts) primitives.push_back(primitiveOf(part));
    GlbJson node = {{"name", object.name}};
    node["mesh"] = push("meshes", {{"name", object.name}, {"primitives", primitives}});
    if (!object.origin.isZero(0))
      node["translation"] = {object.origin[0], object.origin[1], object.origin[2]};
    push("nodes", std::move(node));
  }

  void addMaterial(const Material& material) {
    GlbJson model = {{"baseColorFactor",
                      {material.color[0], material.color[1], material.color[2], material.opacity}},
                     {"metallicFactor", 0}};
    if (material.image) model["baseColorTexture"] = {{"index", textureOf(*material.image)}};
    GlbJson one = {{"name", material.name}, {"pbrMetallicRoughness", std::move(model)}};
    if (material.opacity < 1 || (material.image && !material.image->opaque))
      one["alphaMode"] = "BLEND";
    push("materials", std::move(one));
  }

  std::size_t textureOf(const ImageMap& map) {
    const auto [image, isNewImage] = images_.try_emplace(map.content.get(), 0);
    if (isNewImage) {
      const std::string& bytes = *map.content;
      const std::size_t view = addView(bytes.size(), GlbJson::object(),
                                       [&bytes](BinaryWriter& out) { out.paddedBytes(bytes, 0); });
      const bool isPng = bytes.starts_with("\x89PNG");
      image->second =
          push("images", {{"bufferView", view}, {"mimeType", isPng ? "image/png" : "image/jpeg"}});
    }
    const auto [texture, isNew] = textures_.try_emplace({image->second, map.clamp}, 0);
    if (!isNew) return texture->second;
    const int wrap = map.clamp ? kGlbClamp : kGlbRepeat;
    const std::size_t sampler = push("samplers", {{"wrapS", wrap}, {"wrapT", wrap}});
    texture->second = push("textures", {{"source", image->second}, {"sampler", sampler}});
    return texture->second;
  }

  GlbJson json_;
  std::string text_;
  std::uint64_t bytes_ = 0;
  std::vector<std::function<void(BinaryWriter&)>> contents_;  // of the views, in order
  std::map<const std::string*, std::size_t> images_;
  std::map<std::pair<std::size_t, bool>, std::size_t> textures_;
};

}  // namespace

std::uint64_t glbBytes(const ShadedScene& scene) {
  return GlbDocument(scene).fileBytes();
}

void writeGlb(std::ostream& out, const ShadedScene& scene) {
  GlbDocument(scene).write(out);
}

}  // namespace vox
