#include <alluvium/fluid/boundary_scene.h>
#include <alluvium/run/check_boundaries.h>
#include <alluvium/utilities/expression.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace alluvium::run
{
  using namespace dealii;

  namespace
  {
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

    /** Look at the values of terms, which no solution has been asked for yet. */
    void check_terms(const Model &m)
    {
      for (const auto &face : m.space.boundary().faces())
        {
          const auto &condition = m.boundary_conditions.all().at(face.boundary);
          if (condition.kind->gives_pressure())
            continue; // a value of the solution
          for (unsigned int c = 0; condition.value && c < condition.kind->n_values(); ++c)
            for (const auto &point : face.point)
              m.boundary_conditions.value(condition, point, c);
        }
    }

    /** Is there a node at which the fluid may move? In a channel of one cell between walls without slip there is none. */
    void look_for_free_nodes(Model &m)
    {
      unsigned long long n_free = 0;
      for (const auto dof : m.space.owned()[0])
        n_free += !m.space.constraints().is_constrained(dof);
      const auto &all = m.boundary_conditions.all();
      const bool  may_flow =
        std::any_of(all.begin(), all.end(), [](const auto &entry) { return entry.second.kind->gives_pressure(); });
      if (Utilities::MPI::sum(n_free, m.communicator) == 0 && may_flow)
        m.warnings.add("all nodes of the mesh are on walls, where the fluid does not move, so that there is no flow. Make "
                       "cells smaller (Domain/Coarse cell size, or Mesh refinement/Criteria)",
                       m.time);
    }

    /** What kinds of boundary conditions say of their boundaries. */
    void check_kinds(Model &m, const std::map<types::boundary_id, double> &fluxes)
    {
      double size = 0.;
      for (unsigned int d = 0; d < Model::dim; ++d)
        size = std::max(size, m.domain.upper()[d] - m.domain.lower()[d]);
      for (const auto &[id, condition] : m.boundary_conditions.all())
        {
          const auto        flux    = fluxes.find(id);
          const std::string warning = condition.kind->check({m.space,
                                                             m.boundary_conditions,
                                                             id,
                                                             condition,
                                                             m.solver.properties,
                                                             Tensor<1, Model::dim>({m.gravity[0], m.gravity[1]}),
                                                             size,
                                                             flux == fluxes.end() ? 0. : flux->second});
          if (!warning.empty())
            m.warnings.add(warning, m.time);
        }
    }
  } // namespace


  void check_boundaries(Model &m, const double end_time)
  {
    if (!m.has_fluid)
      return;
    look_for_bed_height(m);
    look_for_free_nodes(m);
    auto                  &conditions = m.boundary_conditions;
    const bool             closed     = !conditions.fixes_pressure();
    constexpr unsigned int n_times    = 50;
    for (unsigned int i = 0; i <= n_times; ++i)
      {
        const double time = m.time + i * std::max(0., end_time - m.time) / n_times;
        conditions.set_time(time);
        const auto fluxes = m.solver.given_fluxes(conditions, m.coupling.void_fraction());
        if (closed)
          check_balance(m, fluxes, time);
        check_terms(m);
        if (i == 0)
          check_kinds(m, fluxes);
      }
    conditions.set_time(m.time);
    m.solver.given_fluxes(conditions, m.coupling.void_fraction());
  }
} // namespace alluvium::run
