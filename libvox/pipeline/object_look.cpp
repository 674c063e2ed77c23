// From the materials of an object to what its faces look like.

#include "libvox/pipeline/object_look.h"

#include "libvox/core/error.h"
#include "libvox/io/input_file.h"
#include "libvox/io/read_image.h"

#include <algorithm>
#include <set>
#include <utility>

namespace vox {
namespace {

bool isImage(const std::optional<TextureSpec>& texture) {
  return texture && texture->kind == TextureKind::kImage;
}

Look lookOf(const ImageMap& map, ImageReader& images) {
  return {Vec4f::Ones(), ImageTexture(images.read(map), map)};
}

/// " (and 2 more images)"; empty if there is only one.
std::string andMore(std::size_t count, const std::string& thing) {
  if (count < 2) return {};
  return " (and " + std::to_string(count - 1) + " more " + thing + (count > 2 ? "s)" : ")");
}

/// The looks of materials. A warning tells of images that cannot be read.
std::vector<Look> looksOf(const SceneObject& object, ImageReader& images,
                          std::vector<std::string>& warnings) {
  std::vector<Look> looks;
  std::string firstError;
  std::set<std::string> failed;  // files
  for (const Material& material : object.mesh.attributes.looks) {
    Look& look = looks.emplace_back();
    look.color << material.color, static_cast<float>(material.opacity);
    look.multiplies = material.multiplies;
    if (!material.image) continue;
    try {
      look.image = lookOf(*material.image, images).image;
    } catch (const InputError& error) {
      if (failed.empty()) firstError = error.what();
      failed.insert(material.image->file);
    }
  }
  if (!failed.empty())
    warnings.push_back(object.name + ": " + firstError + andMore(failed.size(), "image") +
                       "; the plain colour of the material is used");
  return looks;
}

}  // namespace

std::shared_ptr<const Image> ImageReader::read(const ImageMap& map) {
  const auto [known, isNew] = images_.try_emplace({map.content.get(), map.content ? "" : map.file});
  Known& image = known->second;
  if (!isNew && image.pixels == nullptr) throw InputError(image.error);
  if (!isNew) return image.pixels;
  try {
    image.pixels = std::make_shared<const Image>(map.content ? parseImage(*map.content, map.file)
                                                             : imageOfFile(map.file));
  } catch (const InputError& error) {
    image.error = error.what();
    throw;
  }
  budget_.take(image.pixels->pixels.size() * sizeof(Pixel), map.file + ": the image",
               "scale it down or raise --max-memory");
  return image.pixels;
}

Image ImageReader::imageOfFile(const std::string& file) {
  const FileContent content = contentsOf(file);
  Image image = parseImage(content, file);
  ContentHash hash;
  hash.addFile(content);
  hashes_ += hash.hex();
  return image;
}

std::string ImageReader::hashWith(const std::string& inputHash) const {
  if (hashes_.empty()) return inputHash;
  ContentHash hash;
  hash.addFile(inputHash);
  hash.addFile(hashes_);
  return hash.hex();
}

SurfaceLook lookOf(const SceneObject& object, const std::optional<TextureSpec>& texture,
                   const Origins& faceOrigin, std::vector<Vec2f> texcoords, ImageReader& images,
                   std::vector<std::string>& warnings) {
  SurfaceLook look;
  look.texcoords = std::move(texcoords);
  const std::vector<std::string>& problems = object.reading.materialProblems;
  if (!problems.empty())
    warnings.push_back(object.name + ": " + problems[0] + andMore(problems.size(), "problem"));
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
  for (Index f = 0; f < faceOrigin.size(); ++f)
    look.lookOfFace.push_back(attributes.materials.ofFaces[faceOrigin[f]]);
  const bool hasImages = std::any_of(look.looks.begin(), look.looks.end(),
                                     [](const Look& one) { return one.image.has_value(); });
  if (hasImages && look.texcoords.empty())
    warnings.push_back(object.name +
                       ": has images but no texture coordinates; the plain colours are used");
  return look;
}

}  // namespace vox
