#include <alluvium/run/checkpoint.h>
#include <alluvium/run/mesh_changes.h>
#include <alluvium/run/model.h>
#include <alluvium/run/poles.h>
#include <alluvium/run/scene_size.h>
#include <alluvium/run/set_up.h>
#include <alluvium/utilities/divergence.h>
#include <alluvium/utilities/input_files.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/numbers.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

namespace alluvium::run
{
  using namespace dealii;

  namespace
  {
    /** Criteria that look at the fluid see more on a finer mesh: they are asked until the mesh stays. */
    void find_initial_mesh(Model &m)
    {
      constexpr unsigned int max_rounds = 10;
      for (unsigned int round = 0; m.adaptivity.needs_fluid() && round < max_rounds; ++round)
        {
          if (!adapt_mesh(m))
            break;
          m.coupling.update_void_fraction(m.grains);
        }
    }


    /** What formulas of boundary conditions and driving may use. */
    std::map<std::string, double> formula_constants(const Model &m)
    {
      const unsigned int up = m.upright().vertical;
      return {{"rho", m.solver.properties.density},
              {"eta", m.solver.properties.viscosity},
              {"g", m.gravity_size()},
              {"H", m.domain.upper()[up] - m.domain.lower()[up]},
              {"L", m.initial_bed.empty() ? 0. : m.initial_bed.top() - m.initial_bed.bottom()},
              {"d", m.initial_diameter},
              {"pi", numbers::PI}};
    }


    /**
     * Names and formulas, before grains and mesh take their time; set_up_fluid() reads the formulas once more, with the
     * grains' L and d, which are 0 before.
     */
    void check_boundary_conditions(Model &m)
    {
      m.boundary_conditions.initialize(m.domain.boundary_ids(), formula_constants(m));
      Tensor<1, Model::dim> gradient;
      Point<Model::dim>     highest;
      for (unsigned int d = 0; d < Model::dim; ++d)
        {
          gradient[d] = m.solver.properties.density * m.gravity[d];
          highest[d]  = m.gravity[d] > 0. ? m.domain.lower()[d] : m.domain.upper()[d];
        }
      m.boundary_conditions.set_hydrostatic_pressure(gradient, highest);
    }


    void set_up_fluid(Model &m, Checkpoint *from)
    {
      count_cell_weights(m);
      const auto context = m.refinement_context();
      if (!from)
        m.never_refines = m.adaptivity.never_refines(m.coarse_size, context);
      const auto *partition = from ? from->partition() : nullptr;
      auto        mesh      = m.domain.make_triangulation(m.coarse_size,
                                              m.never_refines,
                                              m.cell_weights,
                                              partition ? partition->owners : std::vector<types::subdomain_id>());
      m.adaptivity.check_mesh(*mesh);
      if (!from)
        check_mesh_size(m, mesh->n_global_active_cells());
      if (from)
        from->load_mesh(*mesh);
      else
        {
          m.adaptivity.balance(*mesh, m.cell_weights);
          m.adaptivity.make_initial_mesh(*mesh, context);
        }

      const auto constants = formula_constants(m);
      m.boundary_conditions.initialize(m.domain.boundary_ids(), constants);
      const auto periodicity = m.domain.periodicity();
      m.space.set_periodic_box({periodicity.lower, periodicity.length});
      m.space.boundary().set_parts(m.domain.parts());
      m.solver.initialize_driving(constants);
      attach_mesh(m, std::move(mesh));
      m.solver.choose_datum(m.boundary_conditions);
      if (from)
        {
          from->load_fields(m);
          if (partition && !partition->last_cells.empty())
            repartition(m, *partition);
          m.adaptivity.balance(*m.triangulation, m.cell_weights);
          from->load_history(m);
          return;
        }
      m.coupling.update_void_fraction(m.grains);
      find_initial_mesh(m);
    }


    /**
     * The first prediction needs the contact forces at rest: without them the bed would "fall" in it. They come from a
     * step of the contacts under the grains' submerged weight, whose motion is thrown away; or from some steps, if
     * nothing moves in them: then the bed is known to be at rest when the run starts.
     */
    void find_initial_contact_forces(Model &m)
    {
      load_by_gravity(m);
      if (m.has_fluid)
        for (std::size_t i = 0; i < m.grains.n(); ++i)
          {
            const double volume    = grains::disc_volume(m.grains.fluid_radius[i]);
            const double displaced = m.solver.properties.density * volume;
            const auto   excess    = m.solver.unsupported_weight();
            m.loads.force[0][i] -= displaced * m.gravity[0] - volume * excess[0];
            m.loads.force[1][i] -= displaced * m.gravity[1] - volume * excess[1];
          }
      const auto          memory        = m.contacts.memory();
      grains::GrainArrays trial         = m.grains;
      unsigned int        n_steps_tried = 0;
      do
        m.contact_report = m.contacts.advance(trial, m.loads, m.time_step, m.gravity);
      while (m.contact_report.n_quiet == ++n_steps_tried);
      m.touched = m.contacts.touched();
      // moving walls start where they are said to; where none moves, the rest that was found is kept
      if (m.contacts.memory().wall_positions != memory.wall_positions)
        m.contacts.restore(memory);
      m.grains.contact_force = trial.contact_force;
    }
  } // namespace


  void load_by_gravity(Model &m)
  {
    m.loads.reset(m.grains.n());
    for (std::size_t i = 0; i < m.grains.n(); ++i)
      {
        m.loads.force[0][i] = m.grains.mass[i] * m.gravity[0];
        m.loads.force[1][i] = m.grains.mass[i] * m.gravity[1];
      }
  }


  void set_up(Model &m, const std::string &directory, Checkpoint *from, const double end_time)
  {
    check_user(m.has_fluid || !(m.grain_setup.unit_length() > 0.),
               "Grains/Deposit = none and Fluid/Model = none: there is nothing to compute.");
    m.domain.initialize(m.communicator, directory);
    if (m.has_fluid)
      check_boundary_conditions(m);
    const auto walls = m.grain_setup.walls(m.domain);
    m.contacts.set_walls(walls);
    check_poles_of_walls(m, end_time);
    m.contacts.set_periodicity(m.domain.periodicity());
    m.contacts.set_communicator(m.communicator);
    const std::array<double, 2> lower = {{m.domain.lower()[0], m.domain.lower()[1]}},
                                upper = {{m.domain.upper()[0], m.domain.upper()[1]}};
    const unsigned int across         = 1 - m.upright().vertical;
    if (from)
      {
        from->load_grains(m);
        m.initial_bed.upright = m.upright();
      }
    else
      {
        m.clock.dt         = m.time_step;
        m.grains           = m.grain_setup.make(m.communicator, m.domain, walls, m.gravity, directory);
        m.initial_diameter = m.grains.n() > 0 ? grains::mean_diameter(m.grains) : m.grain_setup.unit_length();
        m.initial_bed      = grains::find_bed_faces(m.grains, lower[across], upper[across], m.upright());
        m.coarse_size      = m.domain.coarse_cell_size() > 0. || !m.has_fluid
                               ? m.domain.coarse_cell_size()
                               : m.adaptivity.coarse_size(m.refinement_context());
        m.touched.assign(m.grains.n(), 0);
        check_scene_size(m);
        if (const std::string remark = m.adaptivity.remark_on_limits(m.refinement_context());
            m.has_fluid && !remark.empty())
          m.warnings.add(remark, m.time);
        if (m.is_root)
          for (const InputFile &input : noted_inputs())
            if (std::filesystem::path(input.path).extension() == ".csv")
              m.inputs[input.path] = input.digest;
      }
    double largest = 0.;
    for (const double r : m.grains.radius)
      largest = std::max(largest, 2. * r);
    for (const auto &name : m.domain.open_to_grains_names())
      m.leavers.by_side[name];
    m.store.let_leave(!m.leavers.by_side.empty());
    if (m.has_fluid)
      set_up_fluid(m, from);
    m.store.initialize(lower, upper, m.contacts.settings().skin * largest);
    if (m.grains_move && !from)
      try
        {
          find_initial_contact_forces(m);
        }
      catch (const Divergence &error) // nothing has run yet: it is what was asked for
        {
          throw UserError(std::string("The scene cannot start: ") + error.what() +
                          " Is it in SI units (metres, seconds)? Try a smaller Time/Time step, slower grains or slower "
                          "walls.");
        }
  }
} // namespace alluvium::run
