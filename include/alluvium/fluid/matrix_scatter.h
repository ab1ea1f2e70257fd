#pragma once

#include <alluvium/fluid/fluid_space.h>

#include <deal.II/lac/trilinos_block_sparse_matrix.h>

#include <cstdint>

namespace alluvium::fluid
{
  /**
   * Where each entry of a cell's matrix goes in the values of the global one, found once a mesh: adding to it is then a
   * sum over addresses, several times faster than searching for columns. It serves the cells without constraints whose
   * rows are all owned, which are nearly all; the others go through the constraints.
   */
  template <int dim>
  class MatrixScatter
  {
  public:
    /** Find the places of @p matrix, whose pattern must hold all of them. */
    void reinit(const FluidSpace<dim> &space, const dealii::TrilinosWrappers::BlockSparseMatrix &matrix);

    /** Addresses are of the matrix's present memory: call before a round of add(). */
    void find_values(const dealii::TrilinosWrappers::BlockSparseMatrix &matrix);

    bool serves(const unsigned int cell) const { return place_of_cell[cell] != none; }

    /** Add a cell's matrix; local unknowns are ordered node * (dim+1) + component, component dim the pressure. */
    template <typename LocalMatrix>
    void add(const unsigned int cell, const LocalMatrix &local)
    {
      constexpr unsigned int n     = std::tuple_size<LocalMatrix>::value;
      const std::uint32_t   *place = &places[place_of_cell[cell]];
      for (unsigned int r = 0; r < n; ++r)
        for (unsigned int c = 0; c < n; ++c, ++place)
          values[r % (dim + 1) == dim][c % (dim + 1) == dim][*place] += local[r][c];
    }

  private:
    static constexpr std::size_t none = -1;

    std::vector<std::size_t>               place_of_cell;
    std::vector<std::uint32_t>             places; // [served cell][row][column], offsets into the block's values
    std::array<std::array<double *, 2>, 2> values{};
  };
} // namespace alluvium::fluid
