# Reading deal.II's headers is most of the compile time: those that many files want are read once, and kept. With
# -DALLUVIUM_PRECOMPILED_HEADERS=OFF each file must include what it uses; contrib/sanitize builds so.
option(ALLUVIUM_PRECOMPILED_HEADERS "Read deal.II's headers once for all files" ON)

# use_precompiled_headers(TARGET HEADER...): the common ones, and these.
function(use_precompiled_headers _target)
  if(ALLUVIUM_PRECOMPILED_HEADERS)
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
    target_compile_options(${_target} PRIVATE -Winvalid-pch)
  endif()
endfunction()
