#include <alluvium/run/check_boundaries.h>
#include <alluvium/utilities/expression.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_accessor.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace alluvium::run
{
  using namespace dealii;

  namespace
  {
    using Kind = fluid::BoundaryConditions<Model::dim>::Kind;

    void check_balance(const Model &m, const std::map<types::boundary_id, double> &fluxes, const double time)
    {
      double             sum = 0., size = 0.;
      std::ostringstream list;
      for (const auto &[id, flux] : fluxes)
        {
          sum += flux;
          size += std::abs(flux);
          list << (list.str().empty() ? "" : ", ") << "'" << m.boundary_conditions.all().at(id).name << "' "
               << std::abs(flux) << (flux > 0. ? " out" : " in");
        }
      // what formulas in decimals leave over goes through the node where the pressure is pinned
      if (std::abs(sum) <= 1e-6 * size)
        return;
      std::ostringstream text;
      text << "Boundary conditions/Velocity: the box has no boundary with a given pressure, but what flows in does not "
              "flow out: "
           << list.str() << " m^2/s";
      if (time > 0.)
        text << " at t = " << time << " s";
      text << ", a difference of " << std::abs(sum)
           << ". Give an outlet under 'Pressure', or velocities whose fluxes add up to zero.";
      throw UserError(text.str());
    }

    /** The height of a bed, where there is none. */
    void look_for_bed_height(Model &m)
    {
      if (m.initial_bed.empty())
        for (const auto &[id, condition] : m.boundary_conditions.all())
          if (!condition.of_plugin && mentions(condition.text, "L"))
            m.warnings.add(condition.described() + ": '" + condition.text +
                             "' uses L, the height of the bed at t = 0, which is 0: the grains form no bed",
                           m.time);
    }

    /** A velocity that depends on place and is zero wherever its boundary is. */
    void check_inlets(const Model &m, const std::map<types::boundary_id, double> &fluxes)
    {
      for (const auto &[id, flux] : fluxes)
        {
          const auto &c = m.boundary_conditions.all().at(id);
          if (flux != 0. || !(c.may_depend_on("x") || c.may_depend_on("y")) || c.may_depend_on("t"))
            continue;
          double largest = 0., largest_across = 0.; // across: what would be a flux
          for (const auto &face : m.space.boundary().inflow_faces())
            if (face.boundary == id)
              for (unsigned int i = 0; i <= 100; ++i)
                {
                  const double            s = face.from + 0.01 * i * (face.to - face.from);
                  const Point<Model::dim> point((1. - s) * face.end[0] + s * face.end[1]);
                  Tensor<1, Model::dim>   u;
                  for (unsigned int d = 0; d < Model::dim; ++d)
                    u[d] = m.boundary_conditions.value(c, point, d);
                  largest        = std::max(largest, u.norm());
                  largest_across = std::max(largest_across, std::abs(u * face.normal));
                }
          check_user(
            Utilities::MPI::max(largest, m.communicator) > 0. &&
              !(Utilities::MPI::max(largest_across, m.communicator) > 0.),
            "Boundary conditions/Velocity: '" + c.text + "' is zero everywhere on '" + c.name +
              "': the inlet lies beside it, or is too narrow to be seen. Name it with Domain/Named parts, such "
              "as `inlet = bottom: 0.014 < x < 0.016`.");
        }
    }

    /** A pressure that is the same at all levels lets fluid fall along a boundary that is not level. */
    void look_for_falling_fluid(Model &m)
    {
      const double g = m.gravity_size(), rho = m.solver.properties.density;
      for (const auto &[id, c] : m.boundary_conditions.all())
        {
          if (c.kind != Kind::pressure || c.add_hydrostatic || g == 0.)
            continue;
          constexpr double none = std::numeric_limits<double>::max();
          // smallest and minus largest: of the level, of the pressure
          double range[4] = {none, none, none, none};
          for (const auto &cell : m.space.dof_handler().active_cell_iterators())
            if (cell->is_locally_owned() && cell->at_boundary())
              for (const unsigned int f : cell->face_indices())
                if (cell->face(f)->at_boundary())
                  for (const auto &part : m.space.boundary().divide_face(
                         cell->face(f)->boundary_id(), cell->face(f)->vertex(0), cell->face(f)->vertex(1)))
                    if (part.id == id)
                      for (const double s : {part.begin, part.end})
                        {
                          const Point<Model::dim> x((1. - s) * cell->face(f)->vertex(0) + s * cell->face(f)->vertex(1));
                          const double            level = -(m.gravity[0] * x[0] + m.gravity[1] * x[1]) / g,
                                       p                = m.boundary_conditions.value(c, x);
                          range[0]                      = std::min(range[0], level);
                          range[1]                      = std::min(range[1], -level);
                          range[2]                      = std::min(range[2], p);
                          range[3]                      = std::min(range[3], -p);
                        }
          MPI_Allreduce(MPI_IN_PLACE, range, 4, MPI_DOUBLE, MPI_MIN, m.communicator);
          const double height = -range[0] - range[1], difference = -range[2] - range[3], at_rest = rho * g * height;
          double       largest = 0.;
          for (unsigned int d = 0; d < Model::dim; ++d)
            largest = std::max(largest, m.domain.upper()[d] - m.domain.lower()[d]);
          if (range[0] == none || height < 1e-6 * largest || std::abs(difference) > 0.01 * at_rest)
            continue;
          std::ostringstream text;
          text << "the pressure given on '" << c.name << "' is the same at all its levels, which differ by " << height
               << " m: fluid falls along it, driven by up to " << at_rest
               << " Pa. If its outside is fluid at rest, set "
               << "Boundary conditions/Add hydrostatic pressure = " << c.name;
          m.warnings.add(text.str(), m.time);
        }
    }
  } // namespace


  void check_boundaries(Model &m, const double end_time)
  {
    if (!m.has_fluid)
      return;
    look_for_bed_height(m);
    auto      &conditions = m.boundary_conditions;
    const bool closed     = !conditions.has_pressure();
    const bool natural    = std::any_of(conditions.all().begin(), conditions.all().end(), [](const auto &entry) {
      return entry.second.kind == Kind::natural;
    });
    constexpr unsigned int n_times = 50;
    for (unsigned int i = 0; i <= n_times; ++i)
      {
        const double time = m.time + i * std::max(0., end_time - m.time) / n_times;
        conditions.set_time(time);
        const auto fluxes = m.solver.given_fluxes(conditions, m.coupling.void_fraction());
        if (closed && !natural)
          check_balance(m, fluxes, time);
        if (i == 0)
          check_inlets(m, fluxes);
      }
    conditions.set_time(m.time);
    m.solver.given_fluxes(conditions, m.coupling.void_fraction());
    look_for_falling_fluid(m);
  }
} // namespace alluvium::run
