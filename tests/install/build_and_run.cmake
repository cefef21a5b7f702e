# cmake -DSOURCE_DIR= -DPREFIX= -DWORK_DIR= -DPROGRAM= -DGENERATOR=
#       -DCXX_COMPILER= [-DCXX_COMPILER_LAUNCHER=] -P build_and_run.cmake
#
# Builds a project that knows nothing but the prefix that lowlap is installed
# to, and runs its program.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result
                  OUTPUT_VARIABLE output ERROR_VARIABLE output)
  message("${output}")
  if(NOT result EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "failed (${result}): ${command}")
  endif()
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
run(${CMAKE_COMMAND} -S "${SOURCE_DIR}" -B "${WORK_DIR}" -G "${GENERATOR}"
    "-DCMAKE_PREFIX_PATH=${PREFIX}" -DCMAKE_BUILD_TYPE=Release
    "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}"
    "-DCMAKE_CXX_COMPILER_LAUNCHER=${CXX_COMPILER_LAUNCHER}")
run(${CMAKE_COMMAND} --build "${WORK_DIR}" --parallel 2)
run("${WORK_DIR}/${PROGRAM}")
