# The Debian packages vox and libvox-dev, and with VOX_BUILD_PYTHON python3-vox:
# `cpack --config build/release/CPackConfig.cmake` makes them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vox)
set(CPACK_PACKAGE_CONTACT "libvox <libvox@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL vox dev)
if(VOX_BUILD_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_VOX_PACKAGE_NAME vox)
set(CPACK_DEBIAN_VOX_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_VOX_PACKAGE_SHLIBDEPS ON)  # the libraries it is linked with
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libvox-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
  "libblosc-dev, libboost-iostreams-dev, libeigen3-dev, libhwy-dev, libjpeg62-turbo-dev, libopenmesh-dev, libopenvdb-dev, libpng-dev, libtbb-dev, libtomlplusplus-dev, libxxhash-dev, zlib1g-dev")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-vox)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
# The extension is for one version of Python.
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
  "python3 (>= ${VOX_PYTHON_SINCE}), python3 (<< ${VOX_PYTHON_BEFORE}), python3-numpy")
include(CPack)
