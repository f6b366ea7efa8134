# Compiles through ccache if it is there and works: with a cache folder that cannot be written, every compilation would fail.
find_program(CCACHE_PROGRAM ccache)
mark_as_advanced(CCACHE_PROGRAM)
if(CCACHE_PROGRAM AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  set(probe ${PROJECT_BINARY_DIR}/CMakeFiles/ccache_probe.cpp)
  file(WRITE ${probe} "int main() {}\n")
  execute_process(
    COMMAND ${CCACHE_PROGRAM} ${CMAKE_CXX_COMPILER} -c ${probe} -o ${probe}.o
    RESULT_VARIABLE ccache_result OUTPUT_QUIET ERROR_QUIET)
  if(ccache_result EQUAL 0)
    set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  endif()
endif()
