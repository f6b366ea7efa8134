# find_package(inextensible): targets
#   inextensible::solvers  the library: methods, problem, steppers (linked statically)
#   inextensible::plugin   headers alone, for a backend that bench loads (plugin.h); link it to a MODULE library
include(CMakeFindDependencyMacro)

list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})
find_dependency(Eigen3 3.4)
find_dependency(SuiteSparse COMPONENTS CHOLMOD UMFPACK)
find_dependency(OpenBLAS)
list(REMOVE_ITEM CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})

include(${CMAKE_CURRENT_LIST_DIR}/inextensible-targets.cmake)
