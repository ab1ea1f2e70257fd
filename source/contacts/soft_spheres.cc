#include <alluvium/contacts/soft_spheres.h>
#include <alluvium/utilities/divergence.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace alluvium::contacts
{
  void SoftSpheres::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Soft spheres");
    prm.add_parameter(
      "Stiffness",
      stiffness,
      "Normal force over overlap, per unit depth [Pa]. The overlap at the foot of n layers of diameter d is about "
      "n m g / stiffness, that of an impact at speed v about v sqrt(m / stiffness); a thousandth of d is hard enough.",
      Double(1e-12));
    prm.add_parameter(
      "Tangential stiffness ratio", tangential_ratio, "Tangential over normal stiffness [-].", Double(0.));
    prm.add_parameter("Restitution",
                      restitution,
                      "Coefficient of restitution, which sets the dashpots [-]; in this model it cannot be 0.",
                      Double(0.01, 1.));
    prm.add_parameter(
      "Steps per collision",
      steps_per_collision,
      "Sub-steps in the shortest collision [-]. A bounce begins and ends somewhere between two of them, so the "
      "coefficient of restitution is wrong by up to |ln e| over this, relatively.",
      Integer(5));
    prm.leave_subsection();
  }


  double SoftSpheres::damping(const double mass, const double k) const
  {
    const double l = std::log(restitution);
    return -2. * l * std::sqrt(mass * k) / std::sqrt(M_PI * M_PI + l * l);
  }


  double SoftSpheres::collision_time(const grains::GrainArrays &grains) const
  {
    double mass = std::numeric_limits<double>::max();
    for (const double m : grains.mass)
      if (!std::isinf(m))
        mass = std::min(mass, 0.5 * m);
    const double c = damping(mass, stiffness), rate = stiffness / mass - 0.25 * c * c / (mass * mass);
    // friction may be stiffer than the normal spring: its inertia is a third, as the disc turns
    return M_PI / std::sqrt(std::max(rate, 3. * tangential_ratio * stiffness / mass));
  }


  void SoftSpheres::find_forces(const grains::GrainArrays &grains,
                                const ContactMaterials    &materials,
                                const ContactGeometry     &geometry,
                                const double               h,
                                ContactCandidates         &pairs,
                                Forces                    &forces) const
  {
    for (auto *f : {&forces.fx, &forces.fy, &forces.moment})
      f->assign(grains.n(), 0.);
    forces.wall.assign(geometry.walls.segments().size(), {{0., 0.}});
    forces.wall_power = 0.;

    // What contact @p point of pair @p p exerts: normal and tangential force on its second partner.
    const auto force = [&](ContactPair           &p,
                           const ContactPoint    &point,
                           const double           mass,
                           const double           vx,
                           const double           vy,
                           const double           spin,
                           const ContactMaterial &material) {
      const double vn = vx * point.nx + vy * point.ny, vt = vy * point.nx - vx * point.ny - spin;
      p.rn            = -stiffness * point.gap - damping(mass, stiffness) * vn;
      const double kt = tangential_ratio * stiffness, ct = damping(mass, kt);
      const double limit = material.friction * std::max(p.rn, 0.);
      p.rt += h * vt;
      double ft = -kt * p.rt - ct * vt;
      if (std::abs(ft) > limit)
        {
          ft = std::copysign(limit, ft);
          if (kt > 0.)
            p.rt = -(ft + ct * vt) / kt; // the spring slides along
        }
      return std::array<double, 2>{{p.rn * point.nx - ft * point.ny, p.rn * point.ny + ft * point.nx}};
    };
    const auto tangential = [](const std::array<double, 2> &f, const ContactPoint &point) {
      return f[1] * point.nx - f[0] * point.ny;
    };

    for (ContactPair &p : pairs.discs)
      {
        const ContactPoint point   = touch(grains, geometry.periodicity, p.i, p.j);
        const double       inverse = 1. / grains.mass[p.i] + 1. / grains.mass[p.j];
        if (point.gap >= 0. || inverse == 0.)
          {
            p.rn = p.rt = 0.;
            continue;
          }
        const auto   f  = force(p,
                             point,
                             1. / inverse,
                             grains.velocity[0][p.j] - grains.velocity[0][p.i],
                             grains.velocity[1][p.j] - grains.velocity[1][p.i],
                             grains.radius[p.i] * grains.omega[p.i] + grains.radius[p.j] * grains.omega[p.j],
                             materials.grains);
        const double ft = tangential(f, point);
        forces.fx[p.i] -= f[0];
        forces.fy[p.i] -= f[1];
        forces.fx[p.j] += f[0];
        forces.fy[p.j] += f[1];
        forces.moment[p.i] -= grains.radius[p.i] * ft;
        forces.moment[p.j] -= grains.radius[p.j] * ft;
      }
    for (ContactPair &p : pairs.walls)
      {
        ContactPoint point;
        if (std::isinf(grains.mass[p.i]) ||
            !geometry.walls.touch(p.j, grains.position[0][p.i], grains.position[1][p.i], grains.radius[p.i], point) ||
            point.gap >= 0.)
          {
            p.rn = p.rt = 0.;
            continue;
          }
        const auto f = force(p,
                             point,
                             grains.mass[p.i],
                             point.vx - grains.velocity[0][p.i],
                             point.vy - grains.velocity[1][p.i],
                             grains.radius[p.i] * grains.omega[p.i],
                             materials.walls[p.j]);
        forces.fx[p.i] -= f[0];
        forces.fy[p.i] -= f[1];
        forces.moment[p.i] -= grains.radius[p.i] * tangential(f, point);
        forces.wall[p.j][0] += f[0];
        forces.wall[p.j][1] += f[1];
        forces.wall_power -= f[0] * point.vx + f[1] * point.vy;
      }
  }


  double SoftSpheres::spring_energy(const grains::GrainArrays &grains,
                                    const ContactGeometry     &geometry,
                                    const ContactCandidates   &pairs) const
  {
    double     energy = 0.;
    const auto add    = [&](const double gap, const double slip) {
      if (gap < 0.)
        energy += 0.5 * stiffness * (gap * gap + tangential_ratio * slip * slip);
    };
    for (const ContactPair &p : pairs.discs)
      if (!std::isinf(grains.mass[p.i]) || !std::isinf(grains.mass[p.j]))
        add(touch(grains, geometry.periodicity, p.i, p.j).gap, p.rt);
    for (const ContactPair &p : pairs.walls)
      if (ContactPoint point;
          !std::isinf(grains.mass[p.i]) &&
          geometry.walls.touch(p.j, grains.position[0][p.i], grains.position[1][p.i], grains.radius[p.i], point))
        add(point.gap, p.rt);
    return energy;
  }


  ContactReport SoftSpheres::advance(grains::GrainArrays       &grains,
                                     const grains::GrainLoads  &loads,
                                     const double               dt,
                                     const ContactMaterials    &materials,
                                     const bool                 rotation,
                                     const double               skin,
                                     ContactGeometry           &geometry,
                                     ContactNeighbours         &neighbours,
                                     std::vector<std::uint8_t> &touched)
  {
    ContactReport     report;
    const std::size_t n       = grains.n();
    const double      n_steps = std::ceil(dt * steps_per_collision / collision_time(grains) * (1. - 1e-10));
    if (n_steps > 1e7)
      throw UserError(
        "Contacts/Soft spheres/Stiffness: one step of the fluid would need more than 10 million sub-steps.");
    const unsigned int                 steps = std::max(1., n_steps);
    const double                       h     = dt / steps;
    std::vector<double>                px(n, 0.), py(n, 0.);
    std::vector<std::array<double, 2>> wall_impulse(geometry.walls.segments().size(), {{0., 0.}});

    const auto search_if_due = [&] {
      if (!neighbours.known(grains) || neighbours.slack(grains, geometry.periodicity) < 0.)
        neighbours.search(grains, geometry, skin);
    };
    const auto kick = [&](const Forces &forces) {
      for (std::size_t k = 0; k < n; ++k)
        {
          px[k] += 0.5 * h * forces.fx[k];
          py[k] += 0.5 * h * forces.fy[k];
          if (std::isinf(grains.mass[k]))
            continue;
          const double m = grains.mass[k] + loads.mass_added_to(k), m_e = m + 0.5 * h * loads.drag[k];
          grains.velocity[0][k] = (m * grains.velocity[0][k] + 0.5 * h * (loads.force[0][k] + forces.fx[k])) / m_e;
          grains.velocity[1][k] = (m * grains.velocity[1][k] + 0.5 * h * (loads.force[1][k] + forces.fy[k])) / m_e;
          if (!rotation)
            continue;
          const double inertia = grains::disc_inertia(grains.mass[k], grains.radius[k]);
          if (loads.torque.empty())
            grains.omega[k] += 0.5 * h * forces.moment[k] / inertia;
          else
            grains.omega[k] = (inertia * grains.omega[k] + 0.5 * h * (loads.torque[k] + forces.moment[k])) /
                              (inertia + 0.5 * h * loads.spin_drag[k]);
        }
      for (std::size_t k = 0; k < wall_impulse.size(); ++k)
        for (unsigned int d = 0; d < 2; ++d)
          wall_impulse[k][d] += 0.5 * h * forces.wall[k][d];
      report.wall_work += 0.5 * h * forces.wall_power;
    };

    geometry.walls.begin_substep(h);
    search_if_due();
    find_forces(grains, materials, geometry, 0., neighbours.pairs, before);
    for (unsigned int s = 0; s < steps; ++s)
      {
        geometry.walls.begin_substep(h);
        kick(before);
        for (std::size_t k = 0; k < n; ++k)
          {
            grains.position[0][k] += h * grains.velocity[0][k];
            grains.position[1][k] += h * grains.velocity[1][k];
            if (!std::isfinite(grains.position[0][k] + grains.position[1][k]))
              throw Divergence("Grain " + std::to_string(grains.id[k]) + " has no finite position any more.");
          }
        wrap_into_box(grains, geometry.periodicity);
        geometry.walls.move(h);
        neighbours.walls_moved(h * geometry.walls.largest_speed());
        search_if_due();
        find_forces(grains, materials, geometry, h, neighbours.pairs, after);
        kick(after);
        std::swap(before, after);
      }

    report.n_substeps = steps;
    for (std::size_t k = 0; k < n; ++k)
      {
        grains.contact_force[0][k] = px[k] / dt;
        grains.contact_force[1][k] = py[k] / dt;
        touched[k]                 = px[k] != 0. || py[k] != 0.;
        report.max_velocity = std::max(report.max_velocity, std::hypot(grains.velocity[0][k], grains.velocity[1][k]));
      }
    for (std::size_t k = 0; k < wall_impulse.size(); ++k)
      {
        auto &force = report.wall_force[geometry.walls.segments()[k].name];
        force[0] += wall_impulse[k][0] / dt;
        force[1] += wall_impulse[k][1] / dt;
      }
    const auto count = [&](const double gap) {
      ++report.n_contacts;
      report.mean_penetration -= gap;
      report.max_penetration = std::max(report.max_penetration, -gap);
    };
    for (const ContactPair &p : neighbours.pairs.discs)
      if (p.rn != 0.)
        count(touch(grains, geometry.periodicity, p.i, p.j).gap);
    for (const ContactPair &p : neighbours.pairs.walls)
      if (ContactPoint point;
          p.rn != 0. &&
          geometry.walls.touch(p.j, grains.position[0][p.i], grains.position[1][p.i], grains.radius[p.i], point))
        count(point.gap);
    if (report.n_contacts > 0)
      report.mean_penetration /= report.n_contacts;
    report.spring_energy = spring_energy(grains, geometry, neighbours.pairs);
    return report;
  }
} // namespace alluvium::contacts
