#include <alluvium/contacts/rest.h>

#include <algorithm>
#include <cmath>

namespace alluvium::contacts
{
  namespace
  {
    constexpr double smallest_load_change = 1e-3; // of a grain's weight, that counts

    double square(const double a, const double b)
    {
      return a * a + b * b;
    }

    /** How far a grain at rest may seem to move while it is watched. */
    double largest_move(const Rest::Scales &scales)
    {
      return std::min(0.02 * scales.g * scales.dt * scales.dt, 1e-3 * scales.diameter);
    }


    /** Whether no surface moves by more than that in a step. */
    bool are_slow(const grains::GrainArrays &grains, const Rest::Scales &scales)
    {
      const double speed = largest_move(scales) / scales.dt;
      for (std::size_t k = 0; k < grains.n(); ++k)
        if (square(grains.velocity[0][k], grains.velocity[1][k]) + square(grains.radius[k] * grains.omega[k], 0.) >
            speed * speed)
          return false;
      return true;
    }
  } // namespace


  bool Rest::unchanged(const grains::GrainArrays &grains, const grains::GrainLoads &loads, const Scales &scales) const
  {
    const double move = largest_move(scales), load = smallest_load_change * scales.weight;
    if (id != grains.id)
      return false;
    for (std::size_t k = 0; k < grains.n(); ++k)
      {
        double dx = grains.position[0][k] - x[k], dy = grains.position[1][k] - y[k];
        periodicity.shorten(dx, dy);
        if (square(dx, dy) > move * move || square(loads.force[0][k] - fx[k], loads.force[1][k] - fy[k]) > load * load)
          return false;
      }
    return true;
  }


  bool Rest::holds(const grains::GrainArrays &grains, const grains::GrainLoads &loads, const Scales &scales) const
  {
    // somebody else may have given them a velocity
    return is_known() && scales.g > 0. && unchanged(grains, loads, scales) && are_slow(grains, scales);
  }


  ContactReport Rest::stand_still(const grains::GrainLoads  &loads,
                                  grains::GrainArrays       &grains,
                                  std::vector<std::uint8_t> &touched) const
  {
    for (std::size_t k = 0; k < grains.n(); ++k)
      {
        grains.velocity[0][k] = grains.velocity[1][k] = grains.omega[k] = 0.;
        grains.contact_force[0][k]                                      = -loads.force[0][k];
        grains.contact_force[1][k]                                      = -loads.force[1][k];
      }
    touched              = last_touched;
    ContactReport report = last_report;
    report.n_sweeps = report.n_updates = 0;
    report.n_substeps = report.n_halvings = report.n_loose = report.n_stalled = report.n_corrections = 0;
    report.max_velocity = report.wall_work = 0.;
    report.crush                           = {};
    report.at_rest                         = true;
    return report;
  }


  void Rest::watch(const grains::GrainArrays       &grains,
                   const grains::GrainLoads        &loads,
                   const Scales                    &scales,
                   const std::vector<std::uint8_t> &touched,
                   ContactReport                   &report)
  {
    if (steps == 0 || !(scales.g > 0.))
      return;
    // What touches nothing has nothing to rest on: it is only slow. So is what creeps as fast as a thick fluid lets it.
    constexpr double largest_drag = 1e-2; // of a grain's weight
    for (std::size_t k = 0; k < grains.n(); ++k)
      if (!std::isinf(grains.mass[k]) &&
          (!touched[k] ||
           loads.drag[k] * std::hypot(grains.velocity[0][k], grains.velocity[1][k]) > largest_drag * scales.weight))
        {
          report.n_quiet = n_quiet = 0;
          return;
        }
    if (n_quiet > 0 && report.n_unconverged == 0 && unchanged(grains, loads, scales))
      ++n_quiet;
    else
      {
        n_quiet = 1;
        id      = grains.id;
        x       = grains.position[0];
        y       = grains.position[1];
        fx      = loads.force[0];
        fy      = loads.force[1];
      }
    // The step that brings a grain to a halt ends where it will stay, but its forces are not those of rest.
    if (!are_slow(grains, scales))
      n_quiet = std::min(n_quiet, least_steps() - 2);
    report.n_quiet = n_quiet;
    if (is_known())
      {
        last_report  = report;
        last_touched = touched;
      }
  }


  void Rest::save(ByteWriter &writer) const
  {
    writer.put(n_quiet);
    writer.put(id);
    for (const auto *values : {&x, &y, &fx, &fy})
      writer.put(*values);
    writer.put(last_touched);
    // of the report, what stand_still() takes from it
    writer.put<std::uint64_t>(last_report.wall_force.size());
    for (const auto &[name, force] : last_report.wall_force)
      {
        writer.put(name);
        writer.put(force[0]);
        writer.put(force[1]);
      }
    writer.put(last_report.n_quiet);
    writer.put(last_report.n_contacts);
    writer.put(last_report.n_unconverged);
    writer.put(last_report.residual);
    writer.put(last_report.violation);
    writer.put(last_report.smooth_velocity);
    writer.put(last_report.max_penetration);
    writer.put(last_report.mean_penetration);
  }


  void Rest::load(ByteReader &reader)
  {
    n_quiet = reader.get<unsigned int>();
    id      = reader.get_vector<grains::GrainId>();
    for (auto *values : {&x, &y, &fx, &fy})
      *values = reader.get_vector<double>();
    last_touched = reader.get_vector<std::uint8_t>();
    last_report  = {};
    for (auto n = reader.get<std::uint64_t>(); n > 0; --n)
      {
        auto &force = last_report.wall_force[reader.get_string()];
        force[0]    = reader.get<double>();
        force[1]    = reader.get<double>();
      }
    last_report.n_quiet          = reader.get<unsigned int>();
    last_report.n_contacts       = reader.get<unsigned int>();
    last_report.n_unconverged    = reader.get<unsigned int>();
    last_report.residual         = reader.get<double>();
    last_report.violation        = reader.get<double>();
    last_report.smooth_velocity  = reader.get<double>();
    last_report.max_penetration  = reader.get<double>();
    last_report.mean_penetration = reader.get<double>();
  }
} // namespace alluvium::contacts
