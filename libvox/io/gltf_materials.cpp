// Materials of glTF files.

#include "libvox/io/gltf_materials.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace vox {
namespace {

constexpr std::uint64_t kClamp = 33071, kRepeat = 10497;

/// Texture coordinates of an image in the v that goes up: glTF's goes down.
/// @param info  of the texture, which may have KHR_texture_transform
void setTransform(const GltfValue& info, ImageMap& map) {
  std::uint64_t set = info.wholeOr("texCoord", 0);
  std::vector<double> scale = {1, 1};
  std::vector<double> offset = {0, 0};
  if (info.hasExtension("KHR_texture_transform")) {
    const GltfValue transform = info.at("extensions").at("KHR_texture_transform");
    set = transform.wholeOr("texCoord", set);
    if (const auto found = transform.find("scale")) scale = found->numbers(2);
    if (const auto found = transform.find("offset")) offset = found->numbers(2);
    if (const auto rotation = transform.find("rotation"); rotation && rotation->number() != 0)
      rotation->fail("is not read; the image is not used");
  }
  if (set != 0)
    info.fail("uses TEXCOORD_" + std::to_string(set) +
              ", of which only TEXCOORD_0 is read; the image is not used");
  map.scale = {scale[0], scale[1]};
  map.offset = {offset[0], 1 - offset[1] - scale[1]};
}

}  // namespace

Index GltfMaterials::numberOf(const GltfValue& index) {
  const GltfValue material = file_.item("materials", index);
  const auto [known, isNew] =
      numbers_.try_emplace(material.place(), static_cast<Index>(looks_.size()));
  if (!isNew) return known->second;
  Material& look = looks_.emplace_back();
  look.name = "material " + std::to_string(index.whole());
  look.color.setOnes();
  look.multiplies = true;
  try {
    read(material, look);
  } catch (const InputError& error) {
    report_.materialProblems.emplace_back(error.what());
  }
  look.name = names_.given(look.name);
  return known->second;
}

void GltfMaterials::read(const GltfValue& material, Material& look) {
  look.name = material.nameOr(look.name);
  const bool isOpaque = material.textOr("alphaMode", "OPAQUE") == "OPAQUE";
  const auto model = material.find("pbrMetallicRoughness");
  if (!model && material.hasExtension("KHR_materials_pbrSpecularGlossiness"))
    material.fail("has its colour in KHR_materials_pbrSpecularGlossiness, which is not read");
  if (!model) return;
  if (const auto found = model->find("baseColorFactor")) {
    const std::vector<double> factor = found->numbers(4);
    const auto share = [&](std::size_t i) { return std::clamp(factor[i], 0.0, 1.0); };
    look.color = Vec3d(share(0), share(1), share(2)).cast<float>();
    if (!isOpaque) look.opacity = share(3);
  }
  if (const auto texture = model->find("baseColorTexture")) {
    look.image = mapOf(*texture);
    look.image->opaque = isOpaque;
  }
}

ImageMap GltfMaterials::mapOf(const GltfValue& info) {
  ImageMap map;
  setTransform(info, map);
  const GltfValue texture = file_.item("textures", info.at("index"));
  if (const auto sampler = texture.find("sampler")) {
    const GltfValue found = file_.item("samplers", *sampler);
    map.clamp =
        found.wholeOr("wrapS", kRepeat) == kClamp && found.wholeOr("wrapT", kRepeat) == kClamp;
  }
  const auto source = texture.find("source");
  if (!source) texture.fail("has no PNG or JPEG image");
  setImage(file_.item("images", *source), map);
  return map;
}

void GltfMaterials::setImage(const GltfValue& image, ImageMap& map) {
  const auto uri = image.find("uri");
  if (uri && !isDataUri(uri->text())) {
    map.file = fileOfUri(uri->text(), file_.folder()).string();
    return;
  }
  map.file = file_.name() + ": " + image.place();
  const std::string_view stored =
      uri ? std::string_view(uri->text())
          : file_.bytesOf(file_.item("bufferViews", image.at("bufferView")));
  std::shared_ptr<const std::string>& content = contents_[{stored.data(), stored.size()}];
  if (!content) {
    if (stored.size() > availableMemory())  // many views of one buffer may overlap
      throw LimitError(map.file + ": " + formatBytes(stored.size()) + " do not fit into memory");
    content = std::make_shared<const std::string>(uri ? dataOf(stored, *uri) : std::string(stored));
  }
  map.content = content;
}

}  // namespace vox
