# cmake -DROOT=<repository> -P check_public_headers.cmake
#
# A public header includes the standard library, Eigen, tl::expected and other
# public headers, and nothing else: whoever includes lowlap does not compile
# OpenCV, Ceres, FLANN, JSON or cereal.
file(GLOB_RECURSE headers RELATIVE "${ROOT}" "${ROOT}/src/lowlap/*.h"
     "${ROOT}/third_party_adapters/*.h")
list(FILTER headers EXCLUDE REGEX "/internal/")
list(LENGTH headers count)
if(count LESS 20)
  message(FATAL_ERROR "only ${count} headers below ${ROOT}")
endif()
set(failed FALSE)
foreach(header IN LISTS headers)
  file(STRINGS "${ROOT}/${header}" includes REGEX "^#[ ]*include")
  foreach(include IN LISTS includes)
    if(include MATCHES "<([a-z_0-9]+|Eigen/[A-Za-z]+|tl/expected\\.hpp)>"
       OR (include MATCHES "\"(lowlap|third_party_adapters)/"
           AND NOT include MATCHES "/internal/"))
      continue()
    endif()
    message("${header}: ${include}")
    set(failed TRUE)
  endforeach()
endforeach()
if(failed)
  message(FATAL_ERROR "public headers include what they should not")
endif()
message("${count} public headers checked")
