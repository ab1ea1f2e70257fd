#include <alluvium/coupling/homogeneous_bed.h>
#include <alluvium/run/bed_flow.h>
#include <alluvium/run/model.h>
#include <alluvium/run/model_choice.h>
#include <alluvium/run/scene_numbers.h>

#include <deal.II/base/function.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>

namespace alluvium::run
{
  using namespace dealii;

  namespace
  {
    using Velocity = fluid::BoundaryKind<Model::dim>::Velocity;

    /** Some points of the boundary of @p name, or of the domain where it is a part of a side. */
    std::vector<Point<2>> points_of(const Model &m, const std::string &name)
    {
      std::vector<Point<2>> points;
      for (const auto &side : m.domain.sides())
        if (side.name == name)
          for (const double s : {0.02, 0.5, 0.98})
            points.emplace_back(side.a[0] + s * (side.b[0] - side.a[0]), side.a[1] + s * (side.b[1] - side.a[1]));
      if (points.empty())
        for (const double s : {0.01, 0.5, 0.97})
          points.push_back((1. - s) * m.domain.lower() + s * m.domain.upper());
      return points;
    }

    /** How large something that depends on time gets, and how fast it changes. */
    struct Range
    {
      double largest = 0., slope = 0., before = 0.;
      bool   is_known = false;

      void see(const double value, const double interval)
      {
        largest = std::max(largest, std::abs(value));
        if (is_known)
          slope = std::max(slope, std::abs(value - before) / interval);
        before   = value;
        is_known = true;
      }

      /** In which it changes by all that it is [s]. */
      double time() const { return slope > 1e-9 * largest ? largest / slope : SceneScales::infinity; }
    };

    /** What drives the fluid between now and @p end. */
    struct Drive
    {
      double       head = 0., velocity = 0., force = 0.; // differences of the reduced pressure [Pa], [m/s], [N/m^3]
      double       time   = SceneScales::infinity;       // in which the fastest of them changes [s]
      unsigned int n_open = 0;                           // boundaries that fluid passes
      bool         is_unknown = false;                   // one of them lets pass nobody knows how much
    };

    Drive find_drive(Model &m, const double end)
    {
      constexpr unsigned int n_samples = 200;
      const double           interval  = std::max(end - m.time, 1e-300) / n_samples;
      const double           rho       = m.solver.properties.density;
      Drive                  drive;
      Range                  head, velocity;
      Range                  force;
      auto                  &conditions = m.boundary_conditions;
      const double           now        = conditions.current_time();
      for (unsigned int i = 0; i <= n_samples; ++i)
        {
          conditions.set_time(m.time + i * interval);
          force.see(m.solver.driving_force(conditions.current_time()).norm(), interval);
          double low = SceneScales::infinity, high = -low, fastest = 0.;
          for (const auto &[id, condition] : conditions.all())
            {
              if (!condition.kind->lets_fluid_pass())
                continue;
              drive.n_open += i == 0;
              if (!condition.kind->gives_pressure() && condition.kind->velocity() != Velocity::given)
                {
                  drive.is_unknown = true;
                  continue;
                }
              for (const Point<2> &x : points_of(m, condition.name))
                if (condition.kind->gives_pressure())
                  {
                    const double p = conditions.value(condition, x) - rho * (m.gravity[0] * x[0] + m.gravity[1] * x[1]);
                    low            = std::min(low, p);
                    high           = std::max(high, p);
                  }
                else
                  fastest =
                    std::max(fastest, std::hypot(conditions.value(condition, x, 0), conditions.value(condition, x, 1)));
            }
          head.see(high > low ? high - low : 0., interval);
          velocity.see(fastest, interval);
        }
      conditions.set_time(now);
      // round-off of rho g H is no head
      const double rest = rho * m.gravity_size() * (m.domain.upper() - m.domain.lower()).norm();
      if (head.largest > 1e-9 * rest)
        {
          drive.head = head.largest;
          drive.time = head.time();
        }
      drive.velocity = velocity.largest;
      drive.time     = std::min(drive.time, velocity.time());
      if (force.largest > 1e-9 * rho * m.gravity_size())
        {
          drive.force = force.largest;
          drive.time  = std::min(drive.time, force.time());
        }
      m.solver.driving_force(now);
      if (drive.is_unknown)
        {
          drive.velocity = SceneScales::infinity;
          drive.time     = 0.;
        }
      return drive;
    }

    /** Drag of grains that slip at @p speed in a void fraction of @p eps, over their weight. */
    double drag_over_weight(const Model &m, const double eps, const double speed)
    {
      const auto &fluid = m.solver.properties;
      double      drag = 0., weight = 0.;
      for (std::size_t i = 0; i < m.grains.n(); ++i)
        if (!std::isinf(m.grains.mass[i]))
          {
            const double r = m.grains.fluid_radius[i];
            drag += grains::disc_volume(r) * speed / eps *
                    m.coupling.drag_law().gamma({eps, speed, 2. * r, fluid.density, fluid.viscosity});
            weight += m.grains.mass[i] * m.gravity_size();
          }
      return weight > 0. ? drag / weight : SceneScales::infinity;
    }
  } // namespace


  SceneScales find_scene_scales(Model &m, const ModelChoice::Schedule &schedule)
  {
    SceneScales s;
    const auto &g            = m.grains;
    const auto  size         = m.domain.upper() - m.domain.lower();
    s.dt                     = m.time_step;
    s.has_fluid              = m.has_fluid;
    s.has_grains             = g.n() > 0;
    s.grains_move            = m.grains_move && s.has_grains;
    s.density                = m.solver.properties.density;
    s.viscosity              = m.solver.properties.viscosity;
    s.convection             = m.solver.discretisation.convection;
    s.inertia                = m.solver.discretisation.inertia;
    s.viscous_stress         = m.solver.discretisation.viscosity;
    s.width                  = std::min(size[0], size[1]);
    s.first_row              = schedule.row_interval > 0. ? schedule.row_interval : m.time_step;
    s.added_mass             = m.coupling.added_mass_coefficient();
    s.couples_rotation       = m.coupling.couples_rotation();
    s.iterates               = m.coupling.iteration_limit().largest_number > 0;
    s.mesh_follows           = m.adaptivity.adapts() && !m.never_refines;
    s.mesh_asks_grains_alone = m.adaptivity.needs_grains_alone();

    const auto &contact_settings = m.contacts.settings();
    s.rotates                    = contact_settings.rotation;
    s.friction                   = std::max(contact_settings.friction, contact_settings.wall_friction);
    for (const auto *single : {&contact_settings.single_friction, &contact_settings.single_rolling_friction})
      for (const auto &[wall, coefficient] : *single)
        s.friction = std::max(s.friction, coefficient);
    s.friction            = std::max(s.friction, contact_settings.rolling_friction);
    s.largest_move        = contact_settings.max_move;
    s.may_be_apart        = m.contacts.may_be_left_out();
    const bool walls_move = std::any_of(
      m.contacts.walls().begin(), m.contacts.walls().end(), [](const auto &w) { return grains::ever_acts(w); });

    if (s.has_grains)
      {
        s.diameter  = grains::mean_diameter(g);
        s.gap       = s.grains_move ? m.contacts.smallest_gap(g, s.diameter) : SceneScales::infinity;
        double mass = 0., volume = 0.;
        for (std::size_t i = 0; i < g.n(); ++i)
          if (!std::isinf(g.mass[i]))
            {
              mass += g.mass[i];
              volume += grains::disc_volume(g.fluid_radius[i]);
            }
        s.density_ratio = volume > 0. ? mass / (volume * s.density) : 0.;
      }
    double fastest = 0.;
    for (std::size_t i = 0; i < g.n(); ++i)
      fastest = std::max(fastest, std::hypot(g.velocity[0][i], g.velocity[1][i]));
    const double fall = std::sqrt(2. * m.gravity_size() * size[1 - m.upright().vertical] + fastest * fastest);
    s.settling_speed  = fall; // unless there is a fluid
    if (!m.has_fluid)
      return s;

    const Drive drive = find_drive(m, schedule.end_time);
    s.is_driven       = walls_move || drive.head > 0. || drive.velocity > 0. || drive.force > 0.;
    s.driving_time    = drive.time;
    const coupling::HomogeneousBed alone{g, m.solver.properties, 1.};
    const auto                    &law = m.coupling.drag_law();
    if (s.has_grains)
      {
        constexpr double dilation = 0.1; // of the speed of a fall: how fast the fluid goes through a bed that shears
        const double     eps      = coupling::inner_void_fraction(g);
        const double     terminal = alone.fluidisation_velocity(law, m.gravity_size());
        s.drag_of_fall            = std::max(drag_over_weight(m, 1., fall), drag_over_weight(m, eps, dilation * fall));
        s.settling_speed          = terminal > 0. ? std::max(terminal, fastest) : fall;
      }
    if (!m.triangulation) // what follows needs a mesh
      return s;

    const SceneNumbers numbers = find_scene_numbers(m, schedule.end_time);
    s.is_suspension            = numbers.is_suspension;
    s.eps                      = numbers.eps;
    s.permeability             = numbers.permeability;
    s.smallest_eps             = m.coupling.report().eps_min;
    s.packing                  = 1. - numbers.eps;
    if (schedule.chooses_steps && s.settling_speed > 0.)
      s.dt = std::min(schedule.end_time, 0.5 * s.diameter / s.settling_speed); // as far as grains may go

    for (const auto &[id, condition] : m.boundary_conditions.all())
      s.has_no_slip = s.has_no_slip || condition.kind->velocity() == Velocity::zero ||
                      (condition.kind->has_terms() && !condition.kind->lets_fluid_pass());
    const double height   = size[1 - m.upright().vertical];
    s.bed_height          = m.initial_bed.empty() ? 0. : m.initial_bed.top() - m.initial_bed.bottom();
    s.clear_height        = std::max(0., height - s.bed_height);
    const BedFlow    flow = flow_across_bed(m);
    constexpr double much = 2.; // diameters: what the faces of a bed leave free in any case
    s.has_clear_fluid     = !s.has_grains || !flow.has_head || s.clear_height > much * s.diameter;
    s.in_layers = flow.crosses && !s.grains_move && !s.has_no_slip && drive.n_open == 2 && drive.force == 0. &&
                  s.permeability > 0. && m.contacts.walls().size() <= 4;
    const bool has_bed = flow.crosses && s.permeability > 0. && s.bed_height > 0.;
    s.velocity         = drive.velocity / s.eps;
    if (has_bed)
      s.velocity = std::max(s.velocity, s.permeability * drive.head / (s.viscosity * s.eps * s.bed_height));
    else
      s.velocity = std::max(
        {s.velocity,
         std::sqrt(2. * drive.head / s.density),
         std::min(std::sqrt(drive.force * s.width / s.density), drive.force * s.width * s.width / (8. * s.viscosity))});
    if (s.grains_move)
      s.velocity = std::max({s.velocity, numbers.velocity, fastest});
    return s;
  }
} // namespace alluvium::run
