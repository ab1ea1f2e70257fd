#include <alluvium/coupling/flow_totals.h>
#include <alluvium/run/mesh_changes.h>
#include <alluvium/run/model.h>

#include <deal.II/base/mpi.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>

namespace alluvium::run
{
  namespace
  {
    /** All but the numbers of the unknowns that depends on the mesh: matrix, cells, pieces. */
    void build_on_numbers(Model &m)
    {
      m.space.build_on_numbers(m.boundary_conditions);
      m.solver.reinit();
      m.coupling.reinit();
    }


    /** What depends on the mesh, for the mesh as it is now. */
    void reinit(Model &m)
    {
      m.space.number();
      build_on_numbers(m);
    }
  } // namespace


  void attach_mesh(Model &m, std::unique_ptr<dealii::Triangulation<2, 2>> mesh)
  {
    m.space.attach(*mesh);
    m.triangulation = std::move(mesh);
    m.transfer = std::make_unique<fluid::FieldTransfer<Model::dim>>(m.space.dof_handler(), m.space.nodal_dof_handler());
    reinit(m);
  }


  void repartition(Model &m, const mesh::Partition &partition)
  {
    m.transfer->prepare({&m.solver.solution(), &m.solver.old()});
    partition.apply(*m.triangulation);
    reinit(m);
    fluid::BlockVector                      field = m.space.make_field(), before = field;
    const dealii::AffineConstraints<double> none; // hanging nodes keep their bits, too
    m.transfer->interpolate({&field, &before}, none, {}, none);
    m.solver.set_solution(field);
    m.solver.old() = before;
    m.solver.old().update_ghost_values();
  }


  void count_cell_weights(Model &m)
  {
    if (dealii::Utilities::MPI::n_mpi_processes(m.communicator) > 1)
      m.cell_weights.count(
        m.grains.position[0], m.grains.position[1], m.coupling.reach(grains::mean_diameter(m.grains)));
  }


  namespace
  {
    /** The totals of the flow, with the void fraction of the grains as they are now. */
    coupling::FlowTotals totals_now(Model &m)
    {
      m.coupling.update_void_fraction(m.grains);
      return coupling::flow_totals(m.coupling, m.space, m.solver, m.boundary_conditions, m.grains);
    }
  } // namespace


  bool adapt_mesh(Model &m)
  {
    observers::MeshChange        change;
    const auto                   timer = m.timers.scope("mesh adaptation");
    fluid::BlockVector           field, before;
    const refinement::FluidState fluid_state{m.space, m.solver.solution(), m.coupling.void_fraction()};
    auto                         context = m.refinement_context();
    context.fluid                        = &fluid_state;
    count_cell_weights(m);
    unsigned int n_rounds = 0;
    const auto   report   = m.adaptivity.adapt(
      *m.triangulation,
      context,
      [&] {
        if (n_rounds > 0)
          {
            m.transfer->prepare({&field, &before});
            return;
          }
        if (m.watches_mesh_changes)
          {
            change.before         = totals_now(m);
            change.n_cells_before = m.triangulation->n_global_active_cells();
          }
        m.transfer->prepare({&m.solver.solution(), &m.solver.old()});
      },
      [&] {
        // a round needs numbers only, for the fields; what else there is on the mesh waits for the last one
        m.space.number();
        m.space.reinit_field(field);
        m.space.reinit_field(before);
        m.transfer->interpolate({&field, &before}, m.space.hanging_constraints(), {}, m.space.nodal_constraints());
        m.counts["mesh adaptations"] += 1;
        ++n_rounds;
      });
    if (n_rounds > 0)
      {
        build_on_numbers(m);
        m.solver.set_solution(field);
        m.solver.old() = before;
      }
    if (report.changed && m.n_steps > 0)
      {
        m.solver.set_solution(field);
        m.boundary_conditions.set_time(m.time);
        if (m.watches_mesh_changes)
          change.interpolated = totals_now(m);
        change.reinitialised =
          m.coupling.reinitialise_flow(m.boundary_conditions, m.grains, m.time_step, before, report.share);
        m.counts["rebalanced flows"] += change.reinitialised;
        if (m.watches_mesh_changes)
          {
            change.after   = change.reinitialised ? totals_now(m) : change.interpolated;
            change.time    = m.time;
            change.n_cells = report.n_cells;
            change.share   = report.share;
            m.mesh_change  = change;
          }
      }
    return report.changed;
  }
} // namespace alluvium::run
