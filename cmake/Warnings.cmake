# How our own code is compiled; kept out of the installed package (targets link it PRIVATE).
add_library(vox_warnings INTERFACE)
target_compile_options(vox_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor -Wold-style-cast
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # GCC 12 gives false alarms for std::string (its bug 105651)
  -ffp-contract=off  # the same bits on processors with and without fused multiply-add
)
if(NOT VOX_SANITIZE)  # sanitizers see into OpenVDB's trees only if these are compiled with ours
  target_compile_definitions(vox_warnings INTERFACE VOX_COMPILED_TREES)  # libvox/grid/openvdb.h
else()
  add_compile_options(-fsanitize=${VOX_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  # GCC 12 gives false alarms in the standard library when its code is instrumented.
  target_compile_options(vox_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_link_options(-fsanitize=${VOX_SANITIZE})
endif()
if(VOX_COVERAGE)
  add_compile_options(--coverage -fprofile-abs-path)
  add_link_options(--coverage)
endif()
