# A folder of sources is a target of its own and sees only the folders that it names: an include of any other does not compile.
#
#   add_folder(linear SOURCES spd_solver.cpp tridiagonal.cpp USES problem LINKS SuiteSparse::CHOLMOD)
#
# SOURCES  of the folder that lies beside the calling CMakeLists.txt
# USES     folders added before, with all that they use
# LINKS    libraries, for this folder's sources alone
# LIGHT    sources in which nothing is timed and nothing computes for long: compiled with less optimization, in two thirds of the time
# `folder_common_headers` of the caller are parsed once for all folders.
# Headers are included as <prefix>/<folder>/<file>, where `folder_prefix` is the caller's ("inextensible" or "harness"); that is
# how they are installed too. In the build folder a link for each target shows its headers alone under that name.
function(add_folder folder)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LIGHT;USES;LINKS")
  set(target ${folder_prefix}_${folder})
  list(TRANSFORM arg_SOURCES PREPEND ${folder}/)
  list(TRANSFORM arg_LIGHT PREPEND ${folder}/)
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
  folder_headers("${parts}" ${folder})
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

# The include path, for some targets, of a folder's headers, or of some that lie beside the calling CMakeLists.txt.
function(folder_headers targets)
  list(GET targets 0 target)
  set(root ${PROJECT_BINARY_DIR}/include/${target})
  file(MAKE_DIRECTORY ${root}/${folder_prefix})
  foreach(name IN LISTS ARGN)
    file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/${name} ${root}/${folder_prefix}/${name} SYMBOLIC)
  endforeach()
  foreach(target IN LISTS targets)
    target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${root}>)
  endforeach()
endfunction()
