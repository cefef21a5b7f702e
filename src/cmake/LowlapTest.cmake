# lowlap_test(<name> SOURCES <files> DEPENDS <targets> [LABELS <labels>]
#             [ONE_PROCESS])
#
# One test program per tested folder. Tests that need photographs go into a
# program of their own with LABELS slow; they find the photographs under
# LOWLAP_DATA and say so when they are absent. Those that count over many
# simulated scenes or random moments, or adjust for minutes, have LABELS long.
# CTest starts a process for each test, or with ONE_PROCESS one for all, which
# then prepare once what they share.
#
# As in libraries, names in anonymous namespaces differ within a folder
# (LOWLAP_UNITY_BUILD).
function(lowlap_test name)
  cmake_parse_arguments(ARG "ONE_PROCESS" "" "SOURCES;DEPENDS;LABELS" ${ARGN})
  set(target lowlap_${name}_test)
  add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE ${ARG_DEPENDS} lowlap_test_support)
  lowlap_compile_options(${target})
  lowlap_precompile(${target} REUSE_FROM lowlap_test_support)
  set_target_properties(${target} PROPERTIES
                        UNITY_BUILD ${LOWLAP_UNITY_BUILD}
                        UNITY_BUILD_BATCH_SIZE 8)
  if(ARG_LABELS)
    set(properties PROPERTIES LABELS "${ARG_LABELS}")
  endif()
  if(ARG_ONE_PROCESS)
    add_test(NAME ${name} COMMAND ${target})
    if(ARG_LABELS)
      set_tests_properties(${name} ${properties})
    endif()
    return()
  endif()
  gtest_discover_tests(${target} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
                       ${properties})
endfunction()
