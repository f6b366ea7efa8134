# bench_with_faults: the program with faults put into copies of two solver files, for gate_test. No hook in the solvers
# themselves: if the text that a fault replaces is gone, configuring says so.

# with_fault(FILE FROM TO): a copy of solvers/FILE with FROM replaced, appended to fault_sources.
function(with_fault file from to)
  set(copy ${CMAKE_CURRENT_BINARY_DIR}/faults/${file})
  if(copy IN_LIST fault_sources)  # another fault in the same file
    file(READ ${copy} text)
  else()
    file(READ ${PROJECT_SOURCE_DIR}/solvers/methods/${file} text)
  endif()
  string(FIND "${text}" "${from}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "tests/harness/cli/faults.cmake: solvers/methods/${file} no longer holds '${from}'")
  endif()
  string(REPLACE "${from}" "${to}" text "${text}")
  file(CONFIGURE OUTPUT ${copy} CONTENT "${text}" @ONLY)  # touched only if it changes
  list(APPEND fault_sources ${copy})
  list(REMOVE_DUPLICATES fault_sources)
  set(fault_sources ${fault_sources} PARENT_SCOPE)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/solvers/methods/${file})
  # Joined with others, it could not be replaced alone.
  set_source_files_properties(${PROJECT_SOURCE_DIR}/solvers/methods/${file} TARGET_DIRECTORY inextensible_methods
    PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

set(fault_sources)
# Fast projection: one iteration more than is needed.
with_fault(fast_projection.cpp "  for (int j = 0, best_j = 0;; ++j) {" "  int extra = 0;\n  for (int j = 0, best_j = 0;; ++j) {")
with_fault(fast_projection.cpp "j >= min_iterations_)" "j >= min_iterations_ && extra++ > 0)")
# Jacobi: gives up after three sweeps.
with_fault(strain_limiting.cpp "order_(order)," "order_(order == StrainPasses::Order::at_once ? (max_iterations_ = 3, order) : order),")

# The copies come first, so that the archive's members of that name are not taken.
add_executable(bench_with_faults ${fault_sources} $<TARGET_OBJECTS:bench>)
target_link_libraries(bench_with_faults PRIVATE harness)
