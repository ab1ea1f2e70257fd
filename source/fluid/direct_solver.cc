#include <alluvium/fluid/direct_solver.h>

#include <deal.II/base/mpi.h>

#include <Amesos.h>
#include <Amesos_BaseSolver.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_LinearProblem.h>
#include <Epetra_Map.h>
#include <Epetra_Vector.h>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    using Index = TrilinosWrappers::types::int_type;

    /** The owned rows of both blocks in one map: a pressure's number follows those of all velocities. */
    Epetra_Map make_map(const TrilinosWrappers::BlockSparseMatrix &matrix)
    {
      std::vector<Index> rows;
      Index              offset = 0;
      for (unsigned int b = 0; b < matrix.n_block_rows(); ++b)
        {
          const Epetra_Map &map = matrix.block(b, b).trilinos_matrix().RowMap();
          for (int i = 0; i < map.NumMyElements(); ++i)
            rows.push_back(offset + static_cast<Index>(map.GID64(i)));
          offset += static_cast<Index>(map.NumGlobalElements64());
        }
      return {offset, static_cast<int>(rows.size()), rows.data(), 0, matrix.block(0, 0).trilinos_matrix().Comm()};
    }

    Epetra_CrsMatrix make_matrix(const TrilinosWrappers::BlockSparseMatrix &matrix, const Epetra_Map &map)
    {
      Epetra_CrsMatrix    result(Copy, map, 0);
      std::vector<Index>  columns;
      std::vector<double> values;
      int                 row = 0;
      for (unsigned int b = 0; b < matrix.n_block_rows(); ++b)
        for (int i = 0; i < matrix.block(b, b).trilinos_matrix().NumMyRows(); ++i, ++row)
          {
            columns.clear();
            values.clear();
            Index offset = 0;
            for (unsigned int c = 0; c < matrix.n_block_cols(); ++c)
              {
                const Epetra_CrsMatrix &block = matrix.block(b, c).trilinos_matrix();
                int                     n     = 0;
                double                 *value = nullptr;
                int                    *index = nullptr;
                block.ExtractMyRowView(i, n, value, index);
                for (int k = 0; k < n; ++k)
                  {
                    columns.push_back(offset + static_cast<Index>(block.GCID64(index[k])));
                    values.push_back(value[k]);
                  }
                offset += static_cast<Index>(block.NumGlobalCols64());
              }
            result.InsertGlobalValues(
              static_cast<Index>(map.GID64(row)), static_cast<int>(values.size()), values.data(), columns.data());
          }
      result.FillComplete();
      return result;
    }
  } // namespace


  struct DirectSolver::Factors
  {
    Factors(const TrilinosWrappers::BlockSparseMatrix &blocks, const types::global_dof_index many)
      : map(make_map(blocks))
      , matrix(make_matrix(blocks, map))
      , lhs(map)
      , rhs(map)
      , problem(&matrix, &lhs, &rhs)
    {
      const std::string mumps = "Amesos_Mumps";
      Amesos            amesos;
      const bool        with_mumps = blocks.m() > many && amesos.Query(mumps);
      solver.reset(amesos.Create(with_mumps ? mumps : "Amesos_Klu", problem));
      AssertThrow(solver, ExcMessage("This Trilinos has no direct solver."));
    }

    Epetra_Map                         map;
    Epetra_CrsMatrix                   matrix;
    Epetra_Vector                      lhs, rhs;
    Epetra_LinearProblem               problem;
    std::unique_ptr<Amesos_BaseSolver> solver;
  };


  DirectSolver::DirectSolver(const TrilinosWrappers::BlockSparseMatrix &matrix, const types::global_dof_index many)
    : factors(std::make_unique<Factors>(matrix, many))
  {
    const MPI_Comm comm = matrix.block(0, 0).get_mpi_communicator();
    for (const auto phase : {&Amesos_BaseSolver::SymbolicFactorization, &Amesos_BaseSolver::NumericFactorization})
      if (!singular)
        singular = Utilities::MPI::max(static_cast<int>(((*factors->solver).*phase)() != 0), comm) != 0;
  }


  DirectSolver::~DirectSolver() = default;


  void DirectSolver::vmult(BlockVector &dst, const BlockVector &src, const double scale) const
  {
    Assert(!singular, ExcMessage("There are no factors."));
    const unsigned int n_u = src.block(0).locally_owned_size(), n_p = src.block(1).locally_owned_size();
    Assert(n_u + n_p == static_cast<unsigned int>(factors->map.NumMyElements()),
           ExcDimensionMismatch(n_u + n_p, factors->map.NumMyElements()));
    for (unsigned int i = 0; i < n_u; ++i)
      factors->rhs[i] = src.block(0).local_element(i);
    for (unsigned int i = 0; i < n_p; ++i)
      factors->rhs[n_u + i] = src.block(1).local_element(i) / scale;
    factors->lhs.PutScalar(0.);
    // all ranks throw, or none
    const int error = Utilities::MPI::max(std::abs(factors->solver->Solve()), src.block(0).get_mpi_communicator());
    AssertThrow(error == 0, ExcMessage("The direct solver failed: " + std::to_string(error) + "."));
    for (unsigned int i = 0; i < n_u; ++i)
      dst.block(0).local_element(i) = factors->lhs[i];
    for (unsigned int i = 0; i < n_p; ++i)
      dst.block(1).local_element(i) = factors->lhs[n_u + i];
  }
} // namespace alluvium::fluid
