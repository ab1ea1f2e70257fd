#include <alluvium/fluid/boundary_nodes.h>
#include <alluvium/fluid/cell_order.h>
#include <alluvium/fluid/fluid_space.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/tria.h>

#include <algorithm>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    template <typename Cell>
    bool is_on_face(const Cell &cell, const unsigned int f, const unsigned int v)
    {
      for (const unsigned int w : cell->face(f)->vertex_indices())
        if (cell->face(f)->vertex_index(w) == cell->vertex_index(v))
          return true;
      return false;
    }

    /** Hold the velocity along the mean of @p normals, or all of it at a corner. */
    template <int dim>
    void constrain_slip(const std::vector<Tensor<1, dim>>                  &normals,
                        const std::array<types::global_dof_index, dim + 1> &dof,
                        AffineConstraints<double>                          &constraints)
    {
      const Tensor<1, dim> first  = normals.front();
      const bool           corner = std::any_of(normals.begin(), normals.end(), [&](const auto &m) {
        return std::abs(m * first) < 0.9; // steeper than about 26 degrees: a corner, not a curved wall
      });
      if (corner)
        {
          for (unsigned int c = 0; c < dim; ++c)
            if (!constraints.is_constrained(dof[c]))
              constraints.add_line(dof[c]);
          return;
        }
      Tensor<1, dim> normal;
      for (const auto &m : normals)
        normal += m;
      normal /= normal.norm();
      unsigned int c = 0;
      for (unsigned int e = 1; e < dim; ++e)
        if (std::abs(normal[e]) > std::abs(normal[c]))
          c = e;
      if (constraints.is_constrained(dof[c]))
        return;
      constraints.add_line(dof[c]);
      for (unsigned int e = 0; e < dim; ++e)
        if (e != c && std::abs(normal[e]) > 1e-12)
          constraints.add_entry(dof[c], dof[e], -normal[e] / normal[c]);
    }
  } // namespace


  template <int dim>
  BoundaryNodes<dim>::BoundaryNodes(const FluidSpace<dim> &space, const BoundaryConditions<dim> &boundary_conditions)
  {
    for (const auto &[id, condition] : boundary_conditions.all())
      on_boundary[id]; // also where this rank has none of it
    const FiniteElement<dim> &system_fe = space.dof_handler().get_fe(), &scalar_fe = space.nodal_dof_handler().get_fe();
    const unsigned int        n_nodes = space.n_nodes_per_cell();
    const QGauss<dim - 1>     quadrature(2);
    FEFaceValues<dim>         face_values(space.mapping(),
                                  scalar_fe,
                                  quadrature,
                                  update_values | update_gradients | update_normal_vectors | update_JxW_values);
    std::vector<types::global_dof_index> cell_dofs(system_fe.n_dofs_per_cell()), cell_nodes(n_nodes);

    unsigned int cell_index = 0;
    for (const auto &cell : ordered_cells(space.dof_handler()))
      {
        const unsigned int my_index = cell_index;
        cell_index += cell->is_locally_owned();
        if (!cell->at_boundary())
          continue;
        const auto nodal_cell = space.nodal_cell(cell);
        cell->get_dof_indices(cell_dofs);
        nodal_cell->get_dof_indices(cell_nodes);
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            {
              const auto id = cell->face(f)->boundary_id();
              if (space.periodic_box().length[id / 2 % dim] > 0.)
                continue; // no boundary: the mesh goes on at the other side
              const auto &condition = boundary_conditions.all().at(id);
              face_values.reinit(nodal_cell, f);
              for (unsigned int v = 0; v < n_nodes; ++v)
                {
                  // nodes are vertices; FE_SimplexP has no has_support_on_face() of its own
                  if (!is_on_face(cell, f, v))
                    continue;
                  Node &node = nodes[cell_nodes[v]];
                  for (unsigned int c = 0; c <= dim; ++c)
                    node.dof[c] = cell_dofs[system_fe.component_to_system_index(c, v)];
                  node.point = cell->vertex(v);
                  node.kinds.emplace(condition.kind, id);
                  if (condition.kind == Kind::slip)
                    node.slip_normals.push_back(face_values.normal_vector(0));
                  on_boundary[id].insert(cell_nodes[v]);
                }
              if (condition.kind == Kind::velocity && cell->is_locally_owned())
                {
                  InflowFace<dim> face;
                  face.cell = my_index;
                  for (unsigned int q = 0; q < quadrature.size(); ++q)
                    {
                      std::array<double, max_nodes<dim>> phi{};
                      for (unsigned int v = 0; v < n_nodes; ++v)
                        phi[v] = face_values.shape_value(v, q);
                      face.phi.push_back(phi);
                      face.normal_jxw.push_back(face_values.normal_vector(q) * face_values.JxW(q));
                    }
                  inflow.push_back(face);
                }
              if (condition.kind == Kind::pressure && cell->is_locally_owned())
                {
                  // half a quadrilateral's; of triangles those that touch with a corner add as much as this one
                  const double  depth = (n_nodes == dim + 1 ? 1. : 0.5) * cell->measure() / cell->face(f)->measure();
                  OpenFace<dim> face{my_index, id, depth, {}, {}, {}, {}};
                  for (unsigned int q = 0; q < quadrature.size(); ++q)
                    {
                      auto &phi  = face.phi.emplace_back();
                      auto &grad = face.grad.emplace_back();
                      for (unsigned int v = 0; v < n_nodes; ++v)
                        {
                          phi[v] = face_values.shape_value(v, q);
                          for (unsigned int d = 0; d < dim; ++d)
                            grad[v][d] = face_values.shape_grad(v, q)[d];
                        }
                      face.normal.push_back(face_values.normal_vector(q));
                      face.jxw.push_back(face_values.JxW(q));
                    }
                  open.push_back(face);
                }
            }
      }
  }


  template <int dim>
  std::vector<PrescribedDof<dim>> BoundaryNodes<dim>::constrain(const AffineConstraints<double> &hanging,
                                                                AffineConstraints<double>       &constraints) const
  {
    std::vector<PrescribedDof<dim>> prescribed;
    const auto                      fix = [&](const Node &node, const unsigned int component) {
      if (!constraints.is_constrained(node.dof[component]))
        constraints.add_line(node.dof[component]);
    };
    for (const auto &[index, node] : nodes)
      {
        const auto prescribe = [&, &n = node](const unsigned int component, const types::boundary_id id) {
          if (hanging.is_constrained(n.dof[component]))
            return;
          fix(n, component);
          prescribed.push_back({n.dof[component], id, component, n.point});
        };
        if (const auto it = node.kinds.find(Kind::pressure); it != node.kinds.end())
          prescribe(dim, it->second);
        if (node.kinds.count(Kind::no_slip))
          for (unsigned int c = 0; c < dim; ++c)
            fix(node, c);
        else if (const auto it = node.kinds.find(Kind::velocity); it != node.kinds.end())
          for (unsigned int c = 0; c < dim; ++c)
            prescribe(c, it->second);
        else if (!node.slip_normals.empty())
          constrain_slip<dim>(node.slip_normals, node.dof, constraints);
      }
    return prescribed;
  }


  template class BoundaryNodes<2>;
} // namespace alluvium::fluid
