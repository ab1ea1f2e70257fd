#include <alluvium/run/mesh_changes.h>
#include <alluvium/run/model.h>

#include <deal.II/base/mpi.h>
#include <deal.II/grid/tria.h>

namespace alluvium::run
{
  namespace
  {
    /** What depends on the mesh, for the mesh as it is now. */
    void reinit(Model &m)
    {
      m.space.reinit(m.boundary_conditions);
      m.solver.reinit();
      m.coupling.reinit();
    }
  } // namespace


  void attach_mesh(Model &m, std::unique_ptr<dealii::Triangulation<2, 2>> mesh)
  {
    m.space.attach(*mesh);
    m.triangulation = std::move(mesh);
    m.transfer = std::make_unique<mesh::FieldTransfer<Model::dim>>(m.space.dof_handler(), m.space.nodal_dof_handler());
    reinit(m);
  }


  void count_cell_weights(Model &m)
  {
    if (dealii::Utilities::MPI::n_mpi_processes(m.communicator) > 1)
      m.cell_weights.count(m.grains.x, m.grains.y, m.coupling.reach(mesh::mean_diameter(m.grains)));
  }


  bool adapt_mesh(Model &m)
  {
    const auto             timer = m.timers.scope("mesh adaptation");
    fluid::BlockVector     field, before;
    const mesh::FluidState fluid_state{m.space, m.solver.solution(), m.coupling.void_fraction()};
    auto                   context = m.refinement_context();
    context.fluid                  = &fluid_state;
    count_cell_weights(m);
    const auto report = m.adaptivity.adapt(
      *m.triangulation,
      context,
      [&] {
        m.transfer->prepare({&m.solver.solution(), &m.solver.old()});
      },
      [&] {
        reinit(m);
        field = before = m.space.make_field();
        m.transfer->interpolate({&field, &before}, m.space.hanging_constraints(), {}, m.space.nodal_constraints());
        m.solver.set_solution(field);
        m.solver.old() = before;
        m.counts["mesh adaptations"] += 1;
      });
    if (report.changed && m.n_steps > 0)
      {
        m.solver.set_solution(field);
        m.boundary_conditions.set_time(m.time);
        m.counts["rebalanced flows"] +=
          m.coupling.rebalance(m.boundary_conditions, m.grains, m.time_step, before, report.share);
      }
    return report.changed;
  }
} // namespace alluvium::run
