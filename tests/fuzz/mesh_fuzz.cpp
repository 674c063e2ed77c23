// Fuzz target: any bytes are read as a mesh and made sound, or are refused with an error.
// VOX_FUZZ_FILE is a file name of the format.

#include "libvox/io/read_mesh.h"
#include "tests/fuzz/laws.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vox;
  try {
    ReadReport report;
    fuzz::requireSoundMesh(
        parseMesh(VOX_FUZZ_FILE, {reinterpret_cast<const char*>(data), size}, report));
    const std::string odd = firstOddity(report);
    fuzz::require(odd.empty() || odd.starts_with(VOX_FUZZ_FILE ":"), "an oddity names the file");
    fuzz::require(lossText(report).empty() || !odd.empty(), "what is lost is an oddity");
  } catch (const InputError& error) {
    fuzz::requireClearRefusal(error, VOX_FUZZ_FILE);
  }
  return 0;
}
