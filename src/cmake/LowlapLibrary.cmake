option(LOWLAP_UNITY_BUILD
       "Compile the sources of a folder some at a time: much faster from nothing, slower after an edit"
       ON)

# lowlap_library(<name> SOURCES <files> [DEPENDS <targets>] [PRIVATE_DEPENDS <targets>])
#
# One static library per folder: target lowlap_<name>, alias lowlap::<name>.
# A folder without sources becomes an interface library. Headers are included
# as "lowlap/<name>/<header>.h" and are installed with that path.
function(lowlap_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  set(target lowlap_${name})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    set(scope PUBLIC)
    foreach(dependency IN LISTS ARG_PRIVATE_DEPENDS)
      # Header-only and private: nobody who links the library needs them.
      if(dependency MATCHES "^(nlohmann_json|cereal)::")
        set(dependency $<BUILD_INTERFACE:${dependency}>)
      endif()
      target_link_libraries(${target} PRIVATE ${dependency})
    endforeach()
    lowlap_compile_options(${target})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(lowlap::${name} ALIAS ${target})
  target_compile_features(${target} ${scope} cxx_std_17)
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} ${scope} ${ARG_DEPENDS})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name}
                        POSITION_INDEPENDENT_CODE ON
                        UNITY_BUILD ${LOWLAP_UNITY_BUILD}
                        UNITY_BUILD_BATCH_SIZE 10)
  set_property(GLOBAL APPEND PROPERTY LOWLAP_LIBRARIES ${target})

  file(RELATIVE_PATH folder "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  string(REGEX REPLACE "^src/" "" folder "${folder}")
  install(DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}/"
          DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/${folder}"
          COMPONENT development
          FILES_MATCHING PATTERN "*.h" PATTERN "internal" EXCLUDE)
endfunction()

# Warnings for our own code; errors only where the project's CI asks for it.
function(lowlap_compile_options target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
    $<$<BOOL:${LOWLAP_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()
