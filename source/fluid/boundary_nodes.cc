#include <alluvium/fluid/boundary_nodes.h>
#include <alluvium/fluid/boundary_values.h>
#include <alluvium/fluid/cell_order.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/tria.h>

#include <algorithm>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    /** Shape functions of a cell at the Gauss points of a part of its face. */
    template <int dim>
    struct PartValues
    {
      std::vector<std::array<double, max_nodes<dim>>>                  phi;
      std::vector<std::array<std::array<double, dim>, max_nodes<dim>>> grad;
      std::vector<double>                                              jxw;

      /** @p face has the values at the Gauss points of the whole face, whose ends are the nodes @p vertex. */
      PartValues(const FEFaceValues<dim>           &face,
                 const geometry::FacePart          &part,
                 const std::array<unsigned int, 2> &vertex)
        : phi(face.n_quadrature_points)
        , grad(face.n_quadrature_points)
        , jxw(face.n_quadrature_points)
      {
        // what is linear along the face, from its values at two points of it
        const double s_0 = face.shape_value(vertex[1], 0), s_1 = face.shape_value(vertex[1], 1);
        for (unsigned int q = 0; q < face.n_quadrature_points; ++q)
          {
            const double s = part.begin + (q == 0 ? s_0 : s_1) * (part.end - part.begin), t = (s - s_0) / (s_1 - s_0);
            jxw[q] = face.JxW(q) * (part.end - part.begin);
            for (unsigned int v = 0; v < face.dofs_per_cell; ++v)
              {
                phi[q][v] = part.is_whole() ? face.shape_value(v, q)
                                            : (1. - t) * face.shape_value(v, 0) + t * face.shape_value(v, 1);
                for (unsigned int d = 0; d < dim; ++d)
                  grad[q][v][d] = part.is_whole() ? face.shape_grad(v, q)[d]
                                                  : (1. - t) * face.shape_grad(v, 0)[d] + t * face.shape_grad(v, 1)[d];
              }
          }
      }
    };

    /** Are faces with these normals of one line, or of a curved wall, rather than of a corner? */
    template <int dim>
    bool in_line(const Tensor<1, dim> &a, const Tensor<1, dim> &b)
    {
      return std::abs(a * b) >= 0.9; // within about 26 degrees
    }

    /** Hold the velocity along the mean of @p normals, or all of it at a corner. */
    template <int dim>
    void constrain_slip(const std::vector<Tensor<1, dim>>                  &normals,
                        const std::array<types::global_dof_index, dim + 1> &dof,
                        AffineConstraints<double>                          &constraints)
    {
      const Tensor<1, dim> first = normals.front();
      const bool           corner =
        std::any_of(normals.begin(), normals.end(), [&](const auto &m) { return !in_line(m, first); });
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
  BoundaryNodes<dim>::BoundaryNodes(const FluidDofs<dim>          &space,
                                    const BoundaryValues<dim>     &values,
                                    const BoundaryConditions<dim> &boundary_conditions)
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
              face_values.reinit(nodal_cell, f);
              const Tensor<1, dim>        normal = face_values.normal_vector(0);
              std::array<unsigned int, 2> vertex{};
              std::array<Point<dim>, 2>   end;
              for (unsigned int e = 0; e < 2; ++e)
                {
                  end[e] = cell->face(f)->vertex(e);
                  for (unsigned int v = 0; v < n_nodes; ++v)
                    if (cell->vertex_index(v) == cell->face(f)->vertex_index(e))
                      vertex[e] = v; // nodes are vertices
                }
              const double length = end[0].distance(end[1]);
              for (const auto &part : values.divide_face(id, end[0], end[1]))
                {
                  const BoundaryKind<dim> &kind       = *boundary_conditions.all().at(part.id).kind;
                  const bool               has_inflow = kind.velocity() == Velocity::given,
                             has_terms = (kind.gives_pressure() || kind.has_terms()) && cell->is_locally_owned();
                  for (unsigned int e = 0; e < 2; ++e)
                    {
                      const bool touches = e == 0 ? part.has_first() : part.has_second();
                      const auto index   = cell_nodes[vertex[e]];
                      Node      &node    = nodes[index];
                      for (unsigned int c = 0; c <= dim; ++c)
                        node.dof[c] = cell_dofs[system_fe.component_to_system_index(c, vertex[e])];
                      node.point = end[e];
                      node.faces.push_back(
                        {part.id, &kind, normal, 0.5 * length * (part.end - part.begin), touches, part.is_whole()});
                      if (touches || kind.velocity() == Velocity::given)
                        node.velocities.emplace(kind.velocity(), part.id);
                      if (touches && kind.gives_pressure() && !node.pressure)
                        node.pressure = part.id;
                      if (touches)
                        on_boundary[part.id].insert(index);
                    }
                  if (!has_inflow && !has_terms)
                    continue;
                  const PartValues<dim> values(face_values, part, vertex);
                  if (has_inflow)
                    {
                      InflowFace<dim> face{cell->is_locally_owned(),
                                           my_index,
                                           part.id,
                                           vertex,
                                           {{cell_nodes[vertex[0]], cell_nodes[vertex[1]]}},
                                           end,
                                           part.begin,
                                           part.end,
                                           normal,
                                           values.phi,
                                           {}};
                      for (const double w : values.jxw)
                        face.normal_jxw.push_back(normal * w);
                      inflow.push_back(face);
                    }
                  if (has_terms)
                    {
                      // half a quadrilateral's; of triangles those that touch with a corner add as much as this one
                      const double depth = (n_nodes == dim + 1 ? 1. : 0.5) * cell->measure() / length;
                      faces.push_back({my_index,
                                       part.id,
                                       depth,
                                       values.phi,
                                       values.grad,
                                       std::vector<Tensor<1, dim>>(quadrature.size(), normal),
                                       values.jxw,
                                       {}});
                      for (const auto &phi : values.phi)
                        faces.back().point.push_back(Point<dim>(phi[vertex[0]] * end[0] + phi[vertex[1]] * end[1]));
                    }
                }
            }
      }
  }


  template <int dim>
  std::vector<Tensor<1, dim>> BoundaryNodes<dim>::Node::normals_of(const Velocity velocity) const
  {
    std::vector<Tensor<1, dim>> result;
    for (const auto &face : faces)
      if (face.kind->velocity() == velocity && face.touches)
        result.push_back(face.normal);
    return result;
  }


  template <int dim>
  const typename BoundaryNodes<dim>::HalfFace *BoundaryNodes<dim>::Node::inflow() const
  {
    const auto it = velocities.find(Velocity::given);
    if (it == velocities.end())
      return nullptr;
    const auto face = std::find_if(faces.begin(), faces.end(), [&](const auto &f) { return f.boundary == it->second; });
    // beside a slot that ends before the node, flow through an open boundary is free; at corners walls win
    if (!face->touches && pressure)
      return nullptr;
    for (const auto &normal : normals_of(Velocity::zero))
      if (!in_line(normal, face->normal))
        return nullptr;
    return &*face;
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
        if (node.pressure)
          prescribe(dim, *node.pressure);
        if (const auto *inflow = node.inflow())
          for (unsigned int c = 0; c < dim; ++c)
            prescribe(c, inflow->boundary);
        else if (node.velocities.count(Velocity::zero))
          for (unsigned int c = 0; c < dim; ++c)
            fix(node, c);
        else if (const auto normals = node.normals_of(Velocity::no_flow_through); !normals.empty())
          constrain_slip<dim>(normals, node.dof, constraints);
      }
    return prescribed;
  }


  template <int dim>
  double BoundaryNodes<dim>::share(const types::global_dof_index node, const types::boundary_id id) const
  {
    double mine = 0., all = 0.;
    for (const auto &face : nodes.at(node).faces)
      if (face.kind->gives_pressure() && face.touches)
        {
          all += face.length;
          if (face.boundary == id)
            mine += face.length;
        }
    return mine > 0. ? mine / all : 1.;
  }


  template <int dim>
  std::map<types::global_dof_index, InflowNode<dim>> BoundaryNodes<dim>::inflow_nodes() const
  {
    std::map<types::global_dof_index, InflowNode<dim>> result;
    for (const auto &[index, node] : nodes)
      if (const auto *inflow = node.inflow())
        {
          InflowNode<dim> n{inflow->boundary, node.point, true, 0., inflow->normal};
          for (const auto &face : node.faces)
            if (in_line(face.normal, n.normal))
              {
                n.length += face.length;
                n.whole = n.whole && face.whole && face.boundary == n.boundary;
              }
          result[index] = n;
        }
    return result;
  }


  template class BoundaryNodes<2>;
} // namespace alluvium::fluid
