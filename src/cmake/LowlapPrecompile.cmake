# lowlap_precompile(<target> HEADERS <headers>|REUSE_FROM <target>)
#
# Most of the time to compile a file goes into reading Eigen, the standard
# library, and one heavy library of the folder. Folders with the same compile
# options share one precompiled header; sources include what they use all the
# same, so that they compile with LOWLAP_PRECOMPILED_HEADERS off, too.
option(LOWLAP_PRECOMPILED_HEADERS "Precompile the headers of libraries" ON)
# Clang's hold the times of the headers, and ccache could keep nothing.
if(LOWLAP_PRECOMPILED_HEADERS AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  add_compile_options("SHELL:-Xclang -fno-pch-timestamp")
endif()

set(LOWLAP_COMMON_HEADERS
    <algorithm> <array> <cmath> <cstddef> <cstdint> <filesystem> <functional>
    <limits> <map> <memory> <numeric> <optional> <set> <string> <string_view>
    <tuple> <utility> <vector> <tl/expected.hpp>
    <Eigen/Core> <Eigen/Geometry> <Eigen/Cholesky> <Eigen/LU> <Eigen/QR>
    <Eigen/SVD> <Eigen/Eigenvalues>)

function(lowlap_precompile target)
  cmake_parse_arguments(ARG "" "REUSE_FROM" "HEADERS" ${ARGN})
  if(NOT LOWLAP_PRECOMPILED_HEADERS)
    return()
  endif()
  if(ARG_REUSE_FROM)
    target_precompile_headers(${target} REUSE_FROM ${ARG_REUSE_FROM})
  else()
    target_precompile_headers(${target} PRIVATE ${LOWLAP_COMMON_HEADERS}
                                                ${ARG_HEADERS})
  endif()
endfunction()
