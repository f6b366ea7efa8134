# Imported targets SuiteSparse::<COMPONENT>, for instance SuiteSparse::CHOLMOD. The libraries are shared ones that pull in what
# they need themselves (AMD, COLAMD, ...). SuiteSparse 5 ships no CMake configuration of its own.
set(SuiteSparse_header_CHOLMOD cholmod.h)
set(SuiteSparse_header_UMFPACK umfpack.h)
set(SuiteSparse_header_SPQR SuiteSparseQR.hpp)
set(SuiteSparse_header_KLU klu.h)

find_path(SuiteSparse_INCLUDE_DIR SuiteSparse_config.h PATH_SUFFIXES suitesparse)
mark_as_advanced(SuiteSparse_INCLUDE_DIR)

foreach(component IN LISTS SuiteSparse_FIND_COMPONENTS)
  string(TOLOWER ${component} library)
  find_library(SuiteSparse_${component}_LIBRARY ${library})
  mark_as_advanced(SuiteSparse_${component}_LIBRARY)
  if(SuiteSparse_${component}_LIBRARY AND EXISTS "${SuiteSparse_INCLUDE_DIR}/${SuiteSparse_header_${component}}")
    set(SuiteSparse_${component}_FOUND TRUE)
  endif()
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SuiteSparse REQUIRED_VARS SuiteSparse_INCLUDE_DIR HANDLE_COMPONENTS)

foreach(component IN LISTS SuiteSparse_FIND_COMPONENTS)
  if(SuiteSparse_${component}_FOUND AND NOT TARGET SuiteSparse::${component})
    add_library(SuiteSparse::${component} UNKNOWN IMPORTED)
    set_target_properties(SuiteSparse::${component} PROPERTIES
      IMPORTED_LOCATION "${SuiteSparse_${component}_LIBRARY}"
      INTERFACE_INCLUDE_DIRECTORIES "${SuiteSparse_INCLUDE_DIR}")
  endif()
endforeach()
if(TARGET SuiteSparse::SPQR AND TARGET SuiteSparse::CHOLMOD)  # SPQR's interface is made of CHOLMOD's types
  target_link_libraries(SuiteSparse::SPQR INTERFACE SuiteSparse::CHOLMOD)
endif()
