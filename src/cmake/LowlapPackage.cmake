# `cpack -G DEB` writes two packages: lowlap, the program, and liblowlap-dev,
# the static libraries, headers and CMake package. What the program links is
# read from it; what the libraries still have to be linked with is listed here.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lowlap)
set(CPACK_PACKAGE_CONTACT "The lowlap authors <lowlap@example.invalid>")
set(CPACK_PACKAGE_VENDOR "The lowlap authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME lowlap)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liblowlap-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
list(JOIN LOWLAP_DEVELOPMENT_PACKAGES ", "
     CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
    "Calibrates photographs that hardly overlap: scales of relative poses from
coplanar lines, global structure from motion, bundle adjustment.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
    "Static libraries and headers of lowlap, for find_package(lowlap).")
include(CPack)
