# -DLOWLAP_SANITIZE=address,undefined (or thread): everything is compiled and
# linked with these sanitizers, and a finding ends the program. Assertions are
# on, those of Eigen and of the standard library as well.
set(LOWLAP_SANITIZE "" CACHE STRING
    "Sanitizers to compile with, as -fsanitize takes them")
option(LOWLAP_BUILD_FUZZERS
       "Build the fuzzers (Clang, LOWLAP_SANITIZE=address,undefined)" OFF)

if(LOWLAP_BUILD_FUZZERS AND NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "LOWLAP_BUILD_FUZZERS needs Clang, whose libFuzzer they "
                      "are: -DCMAKE_CXX_COMPILER=clang++")
endif()
if(LOWLAP_BUILD_FUZZERS AND NOT LOWLAP_SANITIZE)
  message(FATAL_ERROR "LOWLAP_BUILD_FUZZERS without LOWLAP_SANITIZE would not "
                      "see most faults: -DLOWLAP_SANITIZE=address,undefined")
endif()

if(LOWLAP_SANITIZE)
  set(sanitizers ${LOWLAP_SANITIZE})
  if(LOWLAP_BUILD_FUZZERS)
    string(APPEND sanitizers ",fuzzer-no-link")
  endif()
  add_compile_options(-fsanitize=${sanitizers} -fno-sanitize-recover=all
                      -fno-omit-frame-pointer -UNDEBUG)
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
  add_link_options(-fsanitize=${sanitizers})
endif()
