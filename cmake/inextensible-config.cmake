# find_package(inextensible): the target inextensible::solvers, the library of methods, problem and steppers (linked statically).
# find_package(inextensible COMPONENTS core): inextensible::core, those of them that need Eigen alone.
include(CMakeFindDependencyMacro)

list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})
find_dependency(Eigen3 3.4)
if(NOT inextensible_FIND_COMPONENTS STREQUAL "core")
  find_dependency(SuiteSparse COMPONENTS CHOLMOD UMFPACK)
  find_dependency(OpenBLAS)
endif()
list(REMOVE_ITEM CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})

include(${CMAKE_CURRENT_LIST_DIR}/inextensible-targets.cmake)
