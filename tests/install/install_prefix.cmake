# cmake -DBUILD_DIR= -DPREFIX= -P install_prefix.cmake
#
# Installs to an empty prefix: what an older build installed must not pass for
# what this one does.
file(REMOVE_RECURSE "${PREFIX}")
execute_process(COMMAND ${CMAKE_COMMAND} --install "${BUILD_DIR}"
                        --prefix "${PREFIX}"
                RESULT_VARIABLE result OUTPUT_QUIET)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "the installation failed (${result})")
endif()
