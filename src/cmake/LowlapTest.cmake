# lowlap_test(<name> SOURCES <files> DEPENDS <targets> [LABELS <labels>])
#
# One test program per tested folder. Tests that need photographs go into a
# program of their own with LABELS slow; they find the photographs under
# LOWLAP_DATA and say so when they are absent.
function(lowlap_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;LABELS" ${ARGN})
  set(target lowlap_${name}_test)
  add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE ${ARG_DEPENDS} lowlap_test_support)
  lowlap_compile_options(${target})
  lowlap_precompile(${target} REUSE_FROM lowlap_test_support)
  if(ARG_LABELS)
    set(properties PROPERTIES LABELS "${ARG_LABELS}")
  endif()
  gtest_discover_tests(${target} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
                       ${properties})
endfunction()
