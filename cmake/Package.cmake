# Two Debian packages: `cpack --config build/release/CPackConfig.cmake` makes vox and libvox-dev.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vox)
set(CPACK_PACKAGE_CONTACT "libvox <libvox@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL vox dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_VOX_PACKAGE_NAME vox)
set(CPACK_DEBIAN_VOX_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_VOX_PACKAGE_SHLIBDEPS ON)  # the libraries it is linked with
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libvox-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
  "libblosc-dev, libboost-iostreams-dev, libeigen3-dev, libhwy-dev, libjpeg62-turbo-dev, libopenmesh-dev, libopenvdb-dev, libpng-dev, libtbb-dev, libtomlplusplus-dev, libxxhash-dev, zlib1g-dev")
include(CPack)
