#pragma once

#include <alluvium/grains/contact_problem.h>

#include <algorithm>
#include <cmath>

namespace alluvium::grains
{
  /** What a sweep leaves behind besides new impulses. */
  struct SweepSums
  {
    double change = 0.; // sum of squared impulse changes [(N s/m)^2]
    double size   = 0.; // sum of squared impulses
    double work   = 0.; // sum of bias . impulse, part of the objective [J/m]
  };

  /** Relative change of a sweep over n contacts, in the measure of ContactTolerance. */
  inline double relative_change(const SweepSums &sums, const ContactProblem &problem)
  {
    const double n = std::max<double>(1., problem.contacts.size());
    return std::sqrt(sums.change / n) / std::max(std::sqrt(sums.size / n), problem.impulse_scale);
  }

  /** Exact solution of one contact with all others held: two clamps. Returns the squared impulse change. */
  inline double relax(Contact &c, DiscVelocity &vi, DiscVelocity &vj, const double rn_start, const double rt_start)
  {
    const double dx = vj.x - vi.x, dy = vj.y - vi.y;
    const double vn = dx * c.nx + dy * c.ny + c.bias_n;
    const double vt = dy * c.nx - dx * c.ny - (vi.s + vj.s) + c.bias_t;

    const double rn    = std::max(0., rn_start - vn * c.mass_n);
    const double limit = c.friction * rn;
    const double rt    = std::min(limit, std::max(-limit, rt_start - vt * c.mass_t));

    const double dn = rn - rn_start, dt = rt - rt_start;
    const double px = dn * c.nx - dt * c.ny, py = dn * c.ny + dt * c.nx;
    vi.x -= c.inverse_mass_i * px;
    vi.y -= c.inverse_mass_i * py;
    vi.s -= c.inverse_rotation_i * dt;
    vj.x += c.inverse_mass_j * px;
    vj.y += c.inverse_mass_j * py;
    vj.s -= c.inverse_rotation_j * dt;
    c.rn = rn;
    c.rt = rt;
    return dn * dn + dt * dt;
  }

  /**
   * One Gauss-Seidel sweep, forward or backward. With momentum, an impulse is first moved on by @p beta times its last
   * change; the caller has done the same to the velocities.
   */
  template <bool forward, bool momentum>
  SweepSums sweep(ContactProblem &problem, const double beta = 0.)
  {
    SweepSums           sums;
    DiscVelocity *const v = problem.velocity.data();
    Contact *const      c = problem.contacts.data();
    const std::size_t   n = problem.contacts.size();
    for (std::size_t k = 0; k < n; ++k)
      {
        Contact &contact = forward ? c[k] : c[n - 1 - k];
        double   rn = contact.rn, rt = contact.rt;
        if constexpr (momentum)
          {
            const double last_rn = contact.last_rn, last_rt = contact.last_rt;
            contact.last_rn = rn;
            contact.last_rt = rt;
            rn += beta * (rn - last_rn);
            rt += beta * (rt - last_rt);
          }
        sums.change += relax(contact, v[contact.i], v[contact.j], rn, rt);
        sums.size += contact.rn * contact.rn + contact.rt * contact.rt;
        sums.work += contact.bias_n * contact.rn + contact.bias_t * contact.rt;
      }
    return sums;
  }
} // namespace alluvium::grains
