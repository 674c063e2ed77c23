#pragma once

#include "libvox/core/hash.h"
#include "libvox/io/scene_file.h"
#include "libvox/io/scene_text.h"

#include <filesystem>

namespace vox {

/// Reads a mesh and the files that belong to it, and adds their contents to a hash.
/// @throws InputError  as readMesh
PolygonMesh readMeshInto(ContentHash& hash, const std::filesystem::path& file, ReadReport& report);

/// Reads an [[object]] of a scene, with its mesh. If that is in a file, appends the file to
/// scene.files and adds its content to text.hash.
/// @throws InputError  a key or value is wrong, or the mesh cannot be read
SceneObject readObject(SceneText& text, const toml::table& table, Scene& scene);

/// Scales an object about the origin of the world.
/// @throws InputError  a coordinate gets larger than kMaxCoordinate; the message names the file
void scaleObject(SceneObject& object, double scale, const std::filesystem::path& file);

}  // namespace vox
