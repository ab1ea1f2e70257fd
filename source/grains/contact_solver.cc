#include <alluvium/grains/contact_solver.h>

#include <algorithm>
#include <cmath>

namespace alluvium::grains
{
  void apply_impulses(ContactProblem &problem)
  {
    DiscVelocity *const v = problem.velocity.data();
    for (const Contact &c : problem.contacts)
      {
        const double px = c.rn * c.nx - c.rt * c.ny, py = c.rn * c.ny + c.rt * c.nx;
        v[c.i].x -= c.inverse_mass_i * px;
        v[c.i].y -= c.inverse_mass_i * py;
        v[c.i].s -= c.inverse_rotation_i * c.rt;
        v[c.j].x += c.inverse_mass_j * px;
        v[c.j].y += c.inverse_mass_j * py;
        v[c.j].s -= c.inverse_rotation_j * c.rt;
      }
  }

  void measure_residual(const ContactProblem &problem, ContactSolution &solution)
  {
    double                    sum = 0., largest = 0., size = 0.;
    const DiscVelocity *const v = problem.velocity.data();
    for (const Contact &c : problem.contacts)
      {
        const double dx = v[c.j].x - v[c.i].x, dy = v[c.j].y - v[c.i].y;
        const double vn    = dx * c.nx + dy * c.ny + c.bias_n;
        const double vt    = dy * c.nx - dx * c.ny - (v[c.i].s + v[c.j].s) + c.bias_t;
        const double rn    = std::max(0., c.rn - vn * c.mass_n);
        const double limit = c.friction * rn;
        const double rt    = std::min(limit, std::max(-limit, c.rt - vt * c.mass_t));
        const double d     = (rn - c.rn) * (rn - c.rn) + (rt - c.rt) * (rt - c.rt);
        sum += d;
        size += c.rn * c.rn + c.rt * c.rt;
        largest = std::max(largest, d);
      }
    const double n     = std::max<double>(1., problem.contacts.size());
    const double scale = std::max(std::sqrt(size / n), problem.impulse_scale);
    solution.residual  = std::sqrt(sum / n) / scale;
    solution.violation = std::sqrt(largest) / scale;
  }
} // namespace alluvium::grains
