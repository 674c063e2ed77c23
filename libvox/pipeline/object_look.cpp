// From the materials of an object to what its faces look like.

#include "libvox/pipeline/object_look.h"

#include "libvox/core/error.h"
#include "libvox/io/input_file.h"
#include "libvox/io/read_image.h"

#include <algorithm>
#include <utility>

namespace vox {
namespace {

bool isImage(const std::optional<TextureSpec>& texture) {
  return texture && texture->kind == TextureKind::kImage;
}

Look lookOf(const ImageMap& map, ImageReader& images) {
  return {Vec4f::Ones(), ImageTexture(images.read(map), map)};
}

/// The looks of materials. A warning tells of images that cannot be read.
std::vector<Look> looksOf(const SceneObject& object, ImageReader& images,
                          std::vector<std::string>& warnings) {
  std::vector<Look> looks;
  std::string firstError;
  std::size_t errors = 0;
  for (const Material& material : object.mesh.attributes.looks) {
    Look& look = looks.emplace_back();
    look.color << material.color, static_cast<float>(material.opacity);
    look.multiplies = material.multiplies;
    if (!material.image) continue;
    try {
      look.image = lookOf(*material.image, images).image;
    } catch (const InputError& error) {
      if (errors++ == 0) firstError = error.what();
    }
  }
  if (errors > 0)
    warnings.push_back(object.name + ": " + firstError +
                       (errors > 1 ? " (and " + std::to_string(errors - 1) + " more images)" : "") +
                       "; the plain colour of the material is used");
  return looks;
}

}  // namespace

std::shared_ptr<const Image> ImageReader::read(const ImageMap& map) {
  const auto known = images_.find(map.file);
  if (known != images_.end()) return known->second;
  if (map.content)
    return images_[map.file] = std::make_shared<const Image>(parseImage(*map.content, map.file));
  const FileContent content = contentsOf(map.file);
  auto image = std::make_shared<const Image>(parseImage(content, map.file));
  ContentHash hash;
  hash.addFile(content);
  hashes_ += hash.hex();
  return images_[map.file] = std::move(image);
}

std::string ImageReader::hashWith(const std::string& inputHash) const {
  if (hashes_.empty()) return inputHash;
  ContentHash hash;
  hash.addFile(inputHash);
  hash.addFile(hashes_);
  return hash.hex();
}

SurfaceLook lookOf(const SceneObject& object, const std::optional<TextureSpec>& texture,
                   const std::vector<Index>& faceOrigin, std::vector<Vec2f> texcoords,
                   ImageReader& images, std::vector<std::string>& warnings) {
  SurfaceLook look;
  look.texcoords = std::move(texcoords);
  for (const std::string& problem : object.reading.materialProblems)
    warnings.push_back(object.name + ": " + problem);
  if (isImage(texture)) {
    ImageMap map;
    map.file = texture->file;
    map.clamp = texture->clamp;
    look.looks.push_back(lookOf(map, images));
    if (!look.texcoords.empty()) return look;
    warnings.push_back(object.name +
                       ": has no texture coordinates, so its image cannot be laid on");
    look.looks.clear();
  }
  const MeshAttributes& attributes = object.mesh.attributes;
  if (attributes.looks.empty() || attributes.materials.empty()) return look;
  look.looks = looksOf(object, images, warnings);
  for (const Index f : faceOrigin) look.lookOfFace.push_back(attributes.materials.ofFaces[f]);
  const bool hasImages = std::any_of(look.looks.begin(), look.looks.end(),
                                     [](const Look& one) { return one.image.has_value(); });
  if (hasImages && look.texcoords.empty())
    warnings.push_back(object.name +
                       ": has images but no texture coordinates; the plain colours are used");
  return look;
}

}  // namespace vox
