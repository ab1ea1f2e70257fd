#include <alluvium/fluid/cell_cache.h>
#include <alluvium/fluid/cell_order.h>
#include <alluvium/fluid/piece_gradients.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <cmath>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    Quadrature<dim> cell_quadrature(const bool simplex)
    {
      if (simplex)
        return QGaussSimplex<dim>(2);
      return QGauss<dim>(2);
    }
  } // namespace


  template <int dim>
  void CellCache<dim>::reinit(const FluidDofs<dim> &dofs, const AffineConstraints<double> &constraints)
  {
    const bool            simplex    = dofs.has_triangles();
    const Quadrature<dim> quadrature = cell_quadrature<dim>(simplex);
    n_q                              = quadrature.size();
    AssertThrow(n_q <= max_nodes<dim>, ExcInternalError());
    FEValues<dim> values(dofs.mapping(),
                         dofs.nodal_dof_handler().get_fe(),
                         quadrature,
                         update_values | update_gradients | update_JxW_values);

    const FiniteElement<dim>            &system_fe      = dofs.dof_handler().get_fe();
    const unsigned int                   n_nodes        = dofs.n_nodes_per_cell();
    const types::global_dof_index        first_pressure = dofs.first_pressure();
    std::vector<types::global_dof_index> cell_dofs(system_fe.n_dofs_per_cell()), cell_nodes(n_nodes);
    cell_data.clear();
    dofs.reinit_nodal_field(volumes);
    for (const auto &cell : ordered_cells(dofs.dof_handler()))
      if (cell->is_locally_owned())
        {
          const auto nodal = dofs.nodal_cell(cell);
          values.reinit(nodal);
          cell->get_dof_indices(cell_dofs);
          nodal->get_dof_indices(cell_nodes);
          CellData<dim> data{};
          data.size = cell->diameter() / std::sqrt(double(dim));
          for (unsigned int q = 0; q < n_q; ++q)
            {
              data.jxw[q] = values.JxW(q);
              data.measure += data.jxw[q];
              for (unsigned int v = 0; v < n_nodes; ++v)
                {
                  shapes[q][v] = values.shape_value(v, q);
                  for (unsigned int d = 0; d < dim; ++d)
                    data.grad[q][v][d] = values.shape_grad(v, q)[d];
                }
            }
          for (unsigned int v = 0; v < n_nodes; ++v)
            {
              data.vertex[v] = cell->vertex(v);
              data.node[v]   = dofs.nodal_partitioner().global_to_local(cell_nodes[v]);
              for (unsigned int c = 0; c <= dim; ++c)
                {
                  const auto dof               = cell_dofs[system_fe.component_to_system_index(c, v)];
                  data.dofs[v * (dim + 1) + c] = dof;
                  data.constrained             = data.constrained || constraints.is_constrained(dof);
                  if (c < dim)
                    data.velocity[v][c] = dofs.partitioner(0).global_to_local(dof);
                  else
                    data.pressure[v] = dofs.partitioner(1).global_to_local(dof - first_pressure);
                }
            }
          if (!simplex)
            {
              // opposite edges alike: the map is affine and the pieces' moments integrate Q1 exactly
              data.parallelogram = true;
              if constexpr (dim == 2)
                data.parallelogram =
                  (data.vertex[0] + (data.vertex[3] - data.vertex[1]) - data.vertex[2]).norm() < 1e-12 * data.size;
            }
          else
            data.parallelogram = true;
          if constexpr (dim == 2)
            data.to_reference = inverse_jacobian(data.vertex[1] - data.vertex[0], data.vertex[2] - data.vertex[0]);
          cell_data.push_back(data);

          dealii::Vector<double> local(n_nodes);
          for (unsigned int v = 0; v < n_nodes; ++v)
            for (unsigned int q = 0; q < n_q; ++q)
              local(v) += shapes[q][v] * data.jxw[q];
          dofs.nodal_constraints().distribute_local_to_global(local, cell_nodes, volumes);
        }
    volumes.compress(VectorOperation::add);
    volumes.update_ghost_values();
  }


  template class CellCache<2>;
} // namespace alluvium::fluid
