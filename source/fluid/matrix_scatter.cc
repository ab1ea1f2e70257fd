#include <alluvium/fluid/matrix_scatter.h>

#include <Epetra_CrsMatrix.h>

#include <algorithm>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    /** The compressed rows of one block: offsets, local column indices, values. */
    struct Rows
    {
      int    *begin = nullptr, *column = nullptr;
      double *value = nullptr;
    };

    Rows rows_of(const Epetra_CrsMatrix &matrix)
    {
      Rows rows;
      // fails for a matrix whose rows are not one after the other in memory
      AssertThrow(matrix.NumMyRows() == 0 || matrix.ExtractCrsDataPointers(rows.begin, rows.column, rows.value) == 0,
                  ExcInternalError());
      return rows;
    }
  } // namespace


  template <int dim>
  void MatrixScatter<dim>::reinit(const FluidSpace<dim> &space, const TrilinosWrappers::BlockSparseMatrix &matrix)
  {
    const unsigned int            n              = space.n_nodes_per_cell() * (dim + 1);
    const types::global_dof_index first_pressure = matrix.block(0, 0).m();
    place_of_cell.assign(space.cells().size(), none);
    places.clear();

    std::array<std::array<Rows, 2>, 2> rows;
    for (unsigned int a = 0; a < 2; ++a)
      for (unsigned int b = 0; b < 2; ++b)
        rows[a][b] = rows_of(matrix.block(a, b).trilinos_matrix());

    // a cell's unknowns among a block's local rows and columns
    std::vector<std::array<int, 2>> row(n), column(n); // [unknown][block of columns], [unknown][block of rows]
    std::vector<std::uint32_t>      of_cell(n * n);
    for (std::size_t i = 0; i < space.cells().size(); ++i)
      {
        const CellData<dim> &cell = space.cells()[i];
        bool                 good = !cell.constrained;
        for (unsigned int r = 0; r < n && good; ++r)
          {
            const unsigned int a     = r % (dim + 1) == dim;
            const auto         index = static_cast<int>(cell.dofs[r] - a * first_pressure);
            for (unsigned int b = 0; b < 2; ++b)
              {
                row[r][b]    = matrix.block(a, b).trilinos_matrix().LRID(index);
                column[r][b] = matrix.block(b, a).trilinos_matrix().LCID(index);
                good         = good && row[r][b] >= 0 && column[r][b] >= 0;
              }
          }
        for (unsigned int r = 0; r < n && good; ++r)
          for (unsigned int c = 0; c < n && good; ++c)
            {
              const unsigned int a = r % (dim + 1) == dim, b = c % (dim + 1) == dim;
              const Rows        &in    = rows[a][b];
              const int         *first = in.column + in.begin[row[r][b]], *last = in.column + in.begin[row[r][b] + 1];
              const int         *found = std::find(first, last, column[c][a]);
              good                     = found != last;
              of_cell[r * n + c]       = static_cast<std::uint32_t>(found - in.column);
            }
        if (good)
          {
            place_of_cell[i] = places.size();
            places.insert(places.end(), of_cell.begin(), of_cell.end());
          }
      }
  }


  template <int dim>
  void MatrixScatter<dim>::find_values(const TrilinosWrappers::BlockSparseMatrix &matrix)
  {
    for (unsigned int a = 0; a < 2; ++a)
      for (unsigned int b = 0; b < 2; ++b)
        values[a][b] = rows_of(matrix.block(a, b).trilinos_matrix()).value;
  }


  template class MatrixScatter<2>;
} // namespace alluvium::fluid
