# What libvox links against. Shared with the installed package (voxConfig.cmake.in).

# Debian ships FindOpenVDB beside the library, and it wants a C++ triplet to be found.
list(APPEND CMAKE_MODULE_PATH "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB")
find_package(OpenVDB REQUIRED COMPONENTS openvdb)
find_package(Blosc REQUIRED)  # by a module beside OpenVDB's
find_package(ZLIB REQUIRED)
find_path(NANOVDB_INCLUDE_DIR nanovdb/NanoVDB.h REQUIRED)  # Debian: libnanovdb-dev
mark_as_advanced(NANOVDB_INCLUDE_DIR)
find_package(TBB REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(OpenMesh REQUIRED)
find_package(JPEG REQUIRED)
find_package(PNG REQUIRED)
find_package(hwy CONFIG REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
