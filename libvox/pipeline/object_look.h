#pragma once

#include "libvox/core/hash.h"
#include "libvox/core/memory.h"
#include "libvox/io/scene_file.h"
#include "libvox/pipeline/surface_look.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vox {

/// Reads the images of materials and textures, each of them once.
class ImageReader {
 public:
  /// @param budget  for the pixels
  explicit ImageReader(MemoryBudget& budget) : budget_(budget) {}

  /// @throws InputError  as readImage
  /// @throws LimitError  the pixels do not fit into the budget
  std::shared_ptr<const Image> read(const ImageMap& map);

  /// Hash of a scene and of the files of the images that were read.
  /// @param inputHash  of the scene
  std::string hashWith(const std::string& inputHash) const;

 private:
  struct Known {
    std::shared_ptr<const Image> pixels = nullptr;  // null: it cannot be read
    std::string error = {};
  };
  Image imageOfFile(const std::string& file);

  MemoryBudget& budget_;
  std::map<std::pair<const void*, std::string>, Known> images_;  // by content, or else by file
  std::string hashes_;                                           // of files, one after the other
};

/// What the faces of a prepared object look like.
/// @param texture     replaces all materials if it is an image
/// @param faceOrigin  per prepared face: the face of the object's mesh
/// @param texcoords   per prepared corner; or empty
/// @param warnings    one line if images of materials cannot be read, or are of no use
/// @throws InputError  the image of the texture cannot be read
SurfaceLook lookOf(const SceneObject& object, const std::optional<TextureSpec>& texture,
                   const Origins& faceOrigin, std::vector<Vec2f> texcoords, ImageReader& images,
                   std::vector<std::string>& warnings);

}  // namespace vox
