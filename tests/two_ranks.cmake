# The rooms whose objects are spread over ranks run their unit tests on several of them as well, each set as one ctest.
find_program(ALLUVIUM_MPIEXEC NAMES mpiexec mpirun HINTS ${DEAL_II_MPIEXEC})
foreach(_set "mesh:*:2:two" "refinement:*:2:two" "fluid:*Checkpoint*:2:two_checkpoint" "fluid:FluidSpace*:2:two_space"
        "fluid:LinearSolver*:2:two" "fluid:LinearSolver*:3:three" "fluid:LinearSolver*:4:four"
        "grains:Grain*:2:two" "contacts:Ranks*:2:two_sharing" "contacts:Ranks*:3:three" "contacts:Ranks*:4:four")
  string(REPLACE ":" ";" _set ${_set})
  list(GET _set 0 _room)
  list(GET _set 1 _filter)
  list(GET _set 2 _n)
  list(GET _set 3 _name)
  if(TARGET test_${_room} AND ALLUVIUM_MPIEXEC)
    set(_labels unit mpi)
    if(_filter STREQUAL "Ranks*" AND _n GREATER 2)
      list(APPEND _labels slow)
    endif()
    add_test(NAME ${_room}.on_${_name}_ranks
             COMMAND ${ALLUVIUM_MPIEXEC} -np ${_n} $<TARGET_FILE:test_${_room}> --gtest_filter=${_filter})
    # for Open MPI, as root and on small machines
    set_tests_properties(${_room}.on_${_name}_ranks PROPERTIES TIMEOUT ${_time_limit} PROCESSORS 2 LABELS "${_labels}" ENVIRONMENT
      "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMPI_MCA_rmaps_base_oversubscribe=1;OMPI_MCA_mpi_yield_when_idle=1")
  endif()
endforeach()
