# The installed CMake package: find_package(lowlap) gives one target per folder
# (lowlap::scene, ...) and lowlap::lowlap, which is all of them.
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY LOWLAP_LIBRARIES)
add_library(lowlap_all INTERFACE)
add_library(lowlap::lowlap ALIAS lowlap_all)
target_link_libraries(lowlap_all INTERFACE ${libraries})
set_target_properties(lowlap_all PROPERTIES EXPORT_NAME lowlap)

set(lowlap_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/lowlap")
install(TARGETS lowlap_all ${libraries} EXPORT lowlapTargets
        ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
install(EXPORT lowlapTargets NAMESPACE lowlap::
        DESTINATION "${lowlap_package_dir}" COMPONENT development)
configure_package_config_file(
  "${CMAKE_CURRENT_LIST_DIR}/lowlapConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/lowlapConfig.cmake"
  INSTALL_DESTINATION "${lowlap_package_dir}"
  NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/lowlapConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/lowlapConfig.cmake"
              "${PROJECT_BINARY_DIR}/lowlapConfigVersion.cmake"
        DESTINATION "${lowlap_package_dir}" COMPONENT development)
