// Fuzz target: any bytes are read as a mesh and made sound, or are refused with an error.
// VOX_FUZZ_FILE is a file name of the format.

#include "libvox/io/read_mesh.h"
#include "tests/fuzz/laws.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vox;
  try {
    fuzz::requireSoundMesh(parseMesh(VOX_FUZZ_FILE, {reinterpret_cast<const char*>(data), size}));
  } catch (const InputError& error) {
    fuzz::requireClearRefusal(error, VOX_FUZZ_FILE);
  }
  return 0;
}
