# Reading deal.II's headers is most of the compile time: those that many files want are read once, and kept. With
# -DALLUVIUM_PRECOMPILED_HEADERS=OFF each file must include what it uses; contrib/sanitize builds so.
option(ALLUVIUM_PRECOMPILED_HEADERS "Read deal.II's headers once for all files" ON)

# use_precompiled_headers(TARGET HEADER...): the common ones, and these. use_precompiled_headers(TARGET FROM OTHER): those of another
# target with the same flags.
function(use_precompiled_headers _target)
  if(NOT ALLUVIUM_PRECOMPILED_HEADERS)
    return()
  endif()
  # the second for ccache, which also wants contrib/environment
  target_compile_options(${_target} PRIVATE -Winvalid-pch $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  if("${ARGV1}" STREQUAL "FROM")
    target_precompile_headers(${_target} REUSE_FROM ${ARGV2})
    return()
  endif()
  target_precompile_headers(${_target} PRIVATE
    <deal.II/base/data_out_base.h>
    <deal.II/base/function.h>
    <deal.II/base/mpi.h>
    <deal.II/base/parameter_handler.h>
    <deal.II/base/quadrature_lib.h>
    <deal.II/base/utilities.h>
    <deal.II/distributed/shared_tria.h>
    <deal.II/distributed/tria.h>
    <deal.II/dofs/dof_handler.h>
    <deal.II/dofs/dof_tools.h>
    <deal.II/fe/fe_system.h>
    <deal.II/fe/fe_values.h>
    <deal.II/grid/tria.h>
    <deal.II/lac/affine_constraints.h>
    <deal.II/lac/la_parallel_block_vector.h>
    <deal.II/lac/trilinos_block_sparse_matrix.h>
    <nlohmann/json.hpp>
    ${ARGN})
endfunction()
