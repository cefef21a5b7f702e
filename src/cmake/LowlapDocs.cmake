# `cmake --build BUILD --target docs`: reference pages of the installed headers
# in BUILD/docs/html. A warning is an error.
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  return()
endif()
set(DOXYGEN_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/docs")
set(DOXYGEN_EXCLUDE_PATTERNS */internal/*)
set(DOXYGEN_FILE_PATTERNS *.h *.md)
set(DOXYGEN_STRIP_FROM_PATH "${PROJECT_SOURCE_DIR}/src"
                            "${PROJECT_SOURCE_DIR}")
set(DOXYGEN_STRIP_FROM_INC_PATH ${DOXYGEN_STRIP_FROM_PATH})
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE
    "${PROJECT_SOURCE_DIR}/src/lowlap/README.md")
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
set(DOXYGEN_EXTRACT_ALL YES)
set(DOXYGEN_HIDE_FRIEND_COMPOUNDS YES)
set(DOXYGEN_GENERATE_LATEX NO)
set(DOXYGEN_QUIET YES)
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
doxygen_add_docs(docs "${PROJECT_SOURCE_DIR}/src/lowlap"
                 "${PROJECT_SOURCE_DIR}/third_party_adapters"
                 COMMENT "Reference pages of the installed headers")
