#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <vector>

namespace alluvium::fluid
{
  /**
   * The active cells of @p handler that are not artificial, tree by tree: an order that follows from the mesh alone.
   * deal.II's own depends on how the mesh came about, and is another one after a restart.
   */
  template <int dim>
  std::vector<typename dealii::DoFHandler<dim>::active_cell_iterator>
  ordered_cells(const dealii::DoFHandler<dim> &handler)
  {
    using Cell       = typename dealii::DoFHandler<dim>::cell_iterator;
    using ActiveCell = typename dealii::DoFHandler<dim>::active_cell_iterator;
    std::vector<ActiveCell> result;
    result.reserve(handler.get_triangulation().n_active_cells());
    std::vector<Cell> stack;
    for (const auto &tree : handler.cell_iterators_on_level(0))
      for (stack.assign(1, tree); !stack.empty();)
        {
          const Cell cell = stack.back();
          stack.pop_back();
          if (!cell->is_active())
            for (unsigned int c = cell->n_children(); c > 0; --c)
              stack.push_back(cell->child(c - 1));
          else if (const ActiveCell active = cell; !active->is_artificial())
            result.push_back(active);
        }
    return result;
  }
} // namespace alluvium::fluid
