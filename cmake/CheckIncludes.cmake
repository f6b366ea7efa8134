# Stops the build where a source of a folder includes a header of a folder that it may not use.
#   cmake -DSOURCE=<project> -DRULES=<include_rules.cmake> -P CheckIncludes.cmake
include(${RULES})  # folders, seen_by_<folder>

set(errors)
foreach(folder IN LISTS folders)
  file(GLOB sources RELATIVE ${SOURCE} ${SOURCE}/${folder}/*.h ${SOURCE}/${folder}/*.cpp)
  string(REPLACE ";" "|" allowed "${seen_by_${folder}}")
  foreach(source IN LISTS sources)
    file(STRINGS ${SOURCE}/${source} includes REGEX "^#include \"(solvers|harness)/")
    foreach(include IN LISTS includes)
      if(NOT include MATCHES "\"(${allowed})/")
        string(REPLACE "|" ", " names "${allowed}")
        string(APPEND errors "${source}: ${include}\n  ${folder} may include headers of: ${names}\n")
      endif()
    endforeach()
  endforeach()
endforeach()
if(errors)
  message(FATAL_ERROR "include against the direction of the folders (cmake/Folder.cmake):\n${errors}")
endif()
