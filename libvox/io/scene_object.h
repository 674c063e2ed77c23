#pragma once

#include "libvox/core/hash.h"
#include "libvox/io/scene_file.h"
#include "libvox/io/scene_text.h"

#include <filesystem>

namespace vox {

/// Reads a mesh and adds the content of its file to a hash.
/// @throws InputError  as readMesh
PolygonMesh readMeshInto(ContentHash& hash, const std::filesystem::path& file);

/// An [[object]] of a scene, with its mesh; names the mesh file among those of the scene.
/// @throws InputError
SceneObject readObject(SceneText& text, const toml::table& table, Scene& scene);

}  // namespace vox
