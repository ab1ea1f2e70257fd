#include <alluvium/contacts/search/contact_search.h>
#include <alluvium/coupling/homogeneous_bed.h>
#include <alluvium/run/model.h>
#include <alluvium/run/scene_numbers.h>

#include <deal.II/base/function.h>
#include <deal.II/base/mpi.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace alluvium::run
{
  using namespace dealii;

  namespace
  {
    /** The largest velocity given on a boundary now [m/s]. */
    double largest_given_velocity(const Model &m)
    {
      double largest = 0.;
      for (const auto &[id, condition] : m.boundary_conditions.all())
        if (condition.kind->velocity() == fluid::BoundaryKind<Model::dim>::Velocity::given)
          for (const auto &side : m.domain.sides())
            if (side.name == condition.name)
              for (const double s : {0.02, 0.25, 0.5, 0.75, 0.98})
                {
                  const Point<2> x(side.a[0] + s * (side.b[0] - side.a[0]), side.a[1] + s * (side.b[1] - side.a[1]));
                  largest = std::max(largest, std::hypot(condition.value->value(x, 0), condition.value->value(x, 1)));
                }
      return largest;
    }

    /** Whether most of the grains touch neither another one nor a wall, but for a hundredth of their diameter. */
    bool most_touch_nothing(const Model &m)
    {
      contacts::ContactGeometry geometry;
      geometry.walls.set(m.contacts.walls());
      geometry.periodicity = m.domain.periodicity();
      std::vector<bool> touches(m.grains.n(), false);
      const auto        found = contacts::find_candidates(m.grains, geometry, 0.01 * grains::mean_diameter(m.grains));
      for (const auto &p : found.discs)
        touches[p.i] = touches[p.j] = true;
      for (const auto &p : found.walls)
        touches[p.i] = true;
      return 2 * std::count(touches.begin(), touches.end(), true) < long(m.grains.n());
    }

    void find_velocity(const Model &m, SceneNumbers &s)
    {
      const auto take = [&](const double velocity, const std::string &of) {
        if (velocity > s.velocity)
          {
            s.velocity    = velocity;
            s.velocity_of = of;
          }
      };
      take(s.terminal_velocity, "at which a grain sinks alone");
      if (s.eps < 1.)
        take(s.fluidisation_velocity / s.eps,
             s.is_suspension ? "between the grains of a suspension that is held up"
                             : "between the grains of a bed that is just fluidised");
      take(largest_given_velocity(m), "given on a boundary now");
      double smallest = std::numeric_limits<double>::max();
      for (const auto &cell : m.space.cells())
        smallest = std::min(smallest, cell.size);
      s.courant = s.velocity * m.time_step / Utilities::MPI::min(smallest, m.communicator);
    }

    void find_costs(const Model &m, SceneNumbers &s)
    {
      // measured on one core, see doc/lab/reports/fluid-cost.md; steps in which little moves take less
      constexpr double program = 2e8, byte_of_grain = 2e3, byte_of_unknown = 1.5e3, byte_of_piece = 300.;
      constexpr double time_of_grain = 4e-6, time_of_unknown = 1.2e-6, time_of_piece = 3e-7, solves = 2.;
      const double     n_ranks = Utilities::MPI::n_mpi_processes(m.communicator), n_grains = m.grains.n();
      s.memory = n_ranks * (program + byte_of_grain * n_grains);
      s.time   = m.grains_move ? time_of_grain * n_grains : 0.;
      if (m.has_fluid)
        {
          const double unknowns = m.space.n_dofs(), pieces = m.coupling.report().n_pieces;
          s.memory += byte_of_unknown * unknowns + byte_of_piece * pieces;
          s.time += solves * (time_of_unknown * unknowns + time_of_piece * pieces);
        }
      s.time *= s.n_steps / n_ranks;
    }
  } // namespace


  SceneNumbers find_scene_numbers(const Model &m, const double end_time, const double longest_step)
  {
    SceneNumbers s;
    const auto  &g = m.grains;
    s.n_steps      = std::max(0., std::ceil((end_time - m.time) / std::min(m.time_step, longest_step) - 1e-6));
    s.diameter     = grains::mean_diameter(g);
    if (g.n() > 0)
      s.radius_factor = g.fluid_radius[0] / g.radius[0];
    s.bed = grains::measure_bed(
      g, m.domain.lower()[1 - m.upright().vertical], m.domain.upper()[1 - m.upright().vertical], m.upright());
    s.is_suspension = m.grains_move && g.n() > 0 && most_touch_nothing(m);
    if (m.has_fluid && g.n() > 0)
      {
        const auto  &fluid   = m.solver.properties;
        const auto  &law     = m.coupling.drag_law();
        const double gravity = m.gravity_size();
        double       mass = 0., volume = 0., contact_volume = 0., n = 0., all = 0.;
        for (const double r : g.fluid_radius)
          all += grains::disc_volume(r);
        for (std::size_t i = 0; i < g.n(); ++i)
          if (!std::isinf(g.mass[i]))
            {
              mass += g.mass[i];
              volume += grains::disc_volume(g.fluid_radius[i]);
              contact_volume += grains::disc_volume(g.radius[i]);
              n += 1.;
            }
        s.eps = s.bed.solid > 0. ? 1. - s.bed.fluid_fraction() : coupling::inner_void_fraction(g);
        const coupling::HomogeneousBed bed{g, fluid, s.eps}, alone{g, fluid, 1.};
        s.permeability =
          s.eps < 1. ? (s.bed.solid > 0. ? coupling::permeability_of_pieces(
                                             m.coupling, m.space, fluid, g, s.bed.area() * all / s.bed.fluid_solid)
                                         : bed.permeability(law))
                     : 0.; // the pieces are those of all grains
        s.fluidisation_velocity = bed.fluidisation_velocity(law, gravity);
        s.has_drag              = bed.has_drag(law);
        s.relaxation_time       = bed.relaxation_time(law);
        const double d          = s.diameter * s.radius_factor;
        s.viscous_time          = fluid.viscosity > 0. ? fluid.density * s.diameter * s.diameter / fluid.viscosity : 0.;
        if (n > 0. && gravity > 0.)
          {
            s.density_ratio =
              mass / (fluid.density * (m.grain_setup.mass_follows_fluid_radius() ? volume : contact_volume));
            if (s.bed.solid > 0. && s.density_ratio > 1. && !s.is_suspension)
              {
                // the bed's share of all grains, as far as these are of one kind
                const double share  = s.bed.solid / contact_volume;
                s.critical_gradient = share * (mass / fluid.density - volume) / s.bed.area();
                s.terzaghi          = (s.density_ratio - 1.) * s.bed.fluid_fraction();
              }
            const double excess = mass / volume - fluid.density;
            if (excess > 0.)
              {
                s.archimedes     = excess * fluid.density * gravity * d * d * d / (fluid.viscosity * fluid.viscosity);
                s.shields_stress = excess * gravity * d;
                s.terminal_velocity = alone.fluidisation_velocity(law, gravity);
                s.reynolds          = fluid.density * s.terminal_velocity * d / fluid.viscosity;
                s.stokes            = alone.relaxation_time(law) * s.terminal_velocity / d;
              }
          }
        find_velocity(m, s);
      }
    find_costs(m, s);
    return s;
  }


  std::string duration_in_words(const double seconds)
  {
    std::ostringstream text;
    text.precision(2);
    if (seconds < 100.)
      text << seconds << " s";
    else if (seconds < 6000.)
      text << seconds / 60. << " min";
    else if (seconds < 1.5e5)
      text << seconds / 3600. << " h";
    else
      text << seconds / 86400. << " days";
    return text.str();
  }
} // namespace alluvium::run
