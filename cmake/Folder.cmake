# A folder of sources is a target of its own. It may include headers of the folders that it names, and of those that they name; an
# include of any other folder of the project stops the build (CheckIncludes.cmake).
#
#   add_folder(linear SOURCES spd_solver.cpp tridiagonal.cpp USES problem LINKS SuiteSparse::CHOLMOD)
#
# SOURCES  of the folder that lies beside the calling CMakeLists.txt
# USES     folders added before, with all that they use
# LINKS    libraries, for this folder's sources alone
# LIGHT    sources in which nothing is timed and nothing computes for long: compiled with less optimization, in two thirds of the time
# `folder_common_headers` of the caller are parsed once for all folders.
# Headers are included by their path from the top of the project: "solvers/linear/spd_solver.h".
function(add_folder folder)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LIGHT;USES;LINKS")
  set(target ${folder_prefix}_${folder})
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME top)
  list(TRANSFORM arg_SOURCES PREPEND ${folder}/)
  list(TRANSFORM arg_LIGHT PREPEND ${folder}/)
  folder_uses(${target} ${top}/${folder} ${arg_USES})
  list(TRANSFORM arg_USES PREPEND ${folder_prefix}_)
  set(parts ${target})
  set(group)
  if(NOT arg_LIGHT)
    add_library(${target} ${folder_library_type} ${arg_SOURCES})
  elseif(NOT CMAKE_UNITY_BUILD)
    add_library(${target} ${folder_library_type} ${arg_SOURCES} ${arg_LIGHT})
    set_property(SOURCE ${arg_LIGHT} APPEND PROPERTY COMPILE_OPTIONS ${light_option})
  elseif(NOT arg_SOURCES)
    add_library(${target} ${folder_library_type} ${arg_LIGHT})
    target_compile_options(${target} PRIVATE ${light_option})
    set(group _light)
  else()  # a source with an option of its own is not joined with others: these get a target of their own
    list(APPEND parts ${target}_light)
    add_library(${target}_light OBJECT ${arg_LIGHT})
    share_headers(${target}_light ${folder_prefix}_light ${folder_common_headers})
    target_compile_options(${target}_light PRIVATE ${light_option})
    add_library(${target} ${folder_library_type} ${arg_SOURCES} $<TARGET_OBJECTS:${target}_light>)
  endif()
  share_headers(${target} ${folder_prefix}${group} ${folder_common_headers})
  foreach(part IN LISTS parts)
    target_link_libraries(${part} PUBLIC ${folder_base} ${arg_USES} PRIVATE ${arg_LINKS} project_warnings)
  endforeach()
endfunction()

set(light_option $<$<CONFIG:Release>:-O1>)

# Headers of other projects and of the language, parsed once for all targets of a group: by its first target, whose result the
# others take. Targets of one group have the same compile options.
function(share_headers target group)
  get_property(first GLOBAL PROPERTY headers_shared_by_${group})
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    set_property(GLOBAL PROPERTY headers_shared_by_${group} ${target})
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# The sources of a target lie in `folder`, and may include headers of it, of those folders beside it that are named, of what these
# may include, and, in the harness, of all solvers.
function(folder_uses target folder)
  cmake_path(GET folder PARENT_PATH parent)
  set(seen ${folder})
  if(parent STREQUAL "harness")
    list(APPEND seen solvers)
  endif()
  foreach(other IN LISTS ARGN)
    get_property(through GLOBAL PROPERTY folders_seen_by_${parent}/${other})
    if(NOT through)
      message(FATAL_ERROR "${folder} uses ${parent}/${other}, which is not declared before it")
    endif()
    list(APPEND seen ${through})
  endforeach()
  list(REMOVE_DUPLICATES seen)
  set_property(GLOBAL PROPERTY folders_seen_by_${folder} ${seen})
  set_property(GLOBAL APPEND PROPERTY folders ${folder})
  set_property(GLOBAL APPEND PROPERTY folder_targets ${target})
endfunction()

# A target that checks the includes of all folders declared so far; every target of theirs depends on it.
function(check_includes)
  get_property(folders GLOBAL PROPERTY folders)
  set(rules)
  foreach(folder IN LISTS folders)
    get_property(seen GLOBAL PROPERTY folders_seen_by_${folder})
    string(APPEND rules "set(seen_by_${folder} ${seen})\n")
  endforeach()
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/include_rules.cmake CONTENT "set(folders ${folders})\n${rules}" @ONLY)
  add_custom_target(check_includes ALL COMMENT "Checking the direction of includes"
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DRULES=${PROJECT_BINARY_DIR}/include_rules.cmake
      -P ${PROJECT_SOURCE_DIR}/cmake/CheckIncludes.cmake)
  get_property(targets GLOBAL PROPERTY folder_targets)
  foreach(target IN LISTS targets)
    add_dependencies(${target} check_includes)
  endforeach()
endfunction()
