# The CMake package that `cmake --install` leaves: find_package(inextensible), with our Find modules for what it needs.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/inextensible)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/inextensible-config-version.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT inextensible NAMESPACE inextensible:: FILE inextensible-targets.cmake DESTINATION ${package_dir})
install(FILES
  ${PROJECT_BINARY_DIR}/inextensible-config-version.cmake
  ${PROJECT_SOURCE_DIR}/cmake/inextensible-config.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindOpenBLAS.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindSuiteSparse.cmake
  DESTINATION ${package_dir})
