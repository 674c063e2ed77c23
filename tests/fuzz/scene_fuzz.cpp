// Fuzz target: any bytes are read as a scene and its objects made sound, or are refused with an
// error.

#include "libvox/io/scene_file.h"
#include "tests/fuzz/laws.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vox;
  try {
    const Scene scene = parseScene(VOX_FUZZ_FILE, {reinterpret_cast<const char*>(data), size});
    fuzz::require(!scene.objects.empty(), "a scene has at least one object");
    for (const SceneObject& object : scene.objects) fuzz::requireSoundMesh(object.mesh);
  } catch (const InputError& error) {
    fuzz::requireClearRefusal(error, VOX_FUZZ_FILE);
  }
  return 0;
}
