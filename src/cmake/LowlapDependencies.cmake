# Every outside package, found once. The installed package config repeats the
# public ones (lowlapConfig.cmake.in).
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED)
find_package(Ceres 2.1 REQUIRED)
find_package(OpenMP REQUIRED)
find_package(OpenCV 4.6 REQUIRED
             COMPONENTS core imgproc imgcodecs features2d line_descriptor)
# FLANN's headers want lz4, which has no CMake package.
find_package(flann 1.9 REQUIRED)
find_library(LZ4_LIBRARY lz4 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(cereal REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tl-expected REQUIRED)
find_package(ZLIB 1.2.9 REQUIRED)
find_package(SQLite3 3.40 REQUIRED)
# xxHash is compiled into core from its header.
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
# libexif and Clp have no CMake package; they are linked by their names, as
# -lexif and -lClp, and so is libjpeg, whose target the installed package would
# have to find again.
find_library(LIBEXIF_LIBRARY exif REQUIRED)
find_library(LIBJPEG_LIBRARY jpeg REQUIRED)
find_library(CLP_LIBRARY Clp REQUIRED)
find_library(COINUTILS_LIBRARY CoinUtils REQUIRED)
# Neither has SuiteSparse: -lcholmod.
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)

# three.js draws the space of report.html (Debian: libjs-three); its text becomes
# part of the library. Versions after r147 have no OrbitControls for pages
# without modules.
find_file(LOWLAP_THREE_JS three.min.js
          PATHS /usr/share/javascript/three /usr/share/nodejs/three/build)
find_file(LOWLAP_ORBIT_CONTROLS_JS OrbitControls.js
          PATHS /usr/share/javascript/three /usr/share/nodejs/three
          PATH_SUFFIXES examples/js/controls)
if(NOT LOWLAP_THREE_JS OR NOT LOWLAP_ORBIT_CONTROLS_JS)
  message(STATUS "three.js (libjs-three) was not found: report.html will show "
                 "no space, only the rest")
endif()

# Debian's packages of what the static libraries are linked with.
set(LOWLAP_DEVELOPMENT_PACKAGES
    libeigen3-dev libceres-dev libsuitesparse-dev coinor-libclp-dev
    libopencv-dev libopencv-contrib-dev libflann-dev libexif-dev libexpected-dev
    libjpeg-dev zlib1g-dev libsqlite3-dev)
