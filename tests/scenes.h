#pragma once

#include "libvox/io/scene_file.h"

#include <string>
#include <utility>
#include <vector>

namespace vox::test {

/// A scene with an object for each mesh, named "object 1", "object 2" ...
inline Scene sceneOf(std::vector<PolygonMesh> meshes) {
  Scene scene;
  for (PolygonMesh& mesh : meshes) {
    const std::string name = "object " + std::to_string(scene.objects.size() + 1);
    scene.objects.push_back({name, std::move(mesh)});
  }
  return scene;
}

/// A scene of one mesh: "object".
inline Scene oneObject(PolygonMesh mesh) {
  Scene scene;
  scene.objects.push_back({"object", std::move(mesh)});
  return scene;
}

}  // namespace vox::test
