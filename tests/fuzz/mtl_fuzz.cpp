// Fuzz target: any bytes are read as materials, or are refused with an error.

#include "libvox/io/read_mtl.h"
#include "tests/fuzz/laws.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_set>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vox;
  try {
    std::unordered_set<std::string> names;
    for (const Material& material :
         parseMtl({reinterpret_cast<const char*>(data), size}, VOX_FUZZ_FILE)) {
      fuzz::require(names.insert(material.name).second, "a name comes once");
      fuzz::require(material.color.minCoeff() >= 0 && material.color.maxCoeff() <= 1,
                    "colours are 0 to 1");
      fuzz::require(material.opacity >= 0 && material.opacity <= 1, "opacities are 0 to 1");
      if (!material.image) continue;
      fuzz::require(!material.image->file.empty(), "an image has a path");
      fuzz::require(material.image->scale.allFinite() && material.image->offset.allFinite(),
                    "texture coordinates of finite numbers are finite");
    }
  } catch (const InputError& error) {
    fuzz::requireClearRefusal(error, VOX_FUZZ_FILE);
  }
  return 0;
}
