#pragma once

#include <alluvium/contacts/solvers/contact_problem.h>

namespace alluvium::contacts
{
#define ALLUVIUM_INLINE inline __attribute__((always_inline))

  /** a = max(a, b) and a = min(a, b), for numbers and packs of them. */
  template <typename T>
  ALLUVIUM_INLINE void raise_to(T &a, const T &b)
  {
    a = a > b ? a : b;
  }
  template <typename T>
  ALLUVIUM_INLINE void lower_to(T &a, const T &b)
  {
    a = a < b ? a : b;
  }

  /** The numbers of a disc, or of several. */
  template <typename T>
  struct DiscValues
  {
    T x, y, s, inverse_mass, inverse_rotation;
  };

  /** The numbers of a contact, or of several that share no disc; (rn, rt) is the impulse that solving starts from. */
  template <typename T>
  struct ContactValues
  {
    T nx, ny, bias_n, bias_t, rn, rt, friction;
  };

  inline DiscValues<double> values(const Disc &d)
  {
    return {d.x, d.y, d.s, d.inverse_mass, d.inverse_rotation};
  }

  inline ContactValues<double> values(const Contact &c)
  {
    return {c.nx, c.ny, c.bias_n, c.bias_t, c.rn, c.rt, c.friction};
  }

  /** Coulomb friction with a given coefficient: an impulse moves against the velocity and is clamped to the cone. */
  struct FrictionCone
  {
    /** The impulse (rn, rt) that solves contact @p c with all others held. */
    template <typename T>
    static ALLUVIUM_INLINE void
    solve(const ContactValues<T> &c, const DiscValues<T> &i, const DiscValues<T> &j, T &rn, T &rt)
    {
      const T dx = j.x - i.x, dy = j.y - i.y;
      const T vn     = dx * c.nx + dy * c.ny + c.bias_n;
      const T vt     = dy * c.nx - dx * c.ny - (i.s + j.s) + c.bias_t;
      const T normal = i.inverse_mass + j.inverse_mass; // the local block is diagonal
      const T all    = normal + (i.inverse_rotation + j.inverse_rotation);
      // The reciprocals wait for no velocity.
      rn = c.rn - vn * (1. / normal);
      raise_to(rn, T{});
      const T limit = c.friction * rn, opposite = T{} - limit;
      rt = c.rt - vt * (1. / all);
      raise_to(rt, opposite);
      lower_to(rt, limit);
    }
  };

  /** The impulse of rolling friction @p r that solves it in contact @p c with all others held, from @p start. */
  ALLUVIUM_INLINE double
  solve_rolling(const RollingFriction &r, const Contact &c, const Disc &i, const Disc &j, const double start)
  {
    const double inverse = r.lever_i * r.lever_i * i.inverse_rotation + r.lever_j * r.lever_j * j.inverse_rotation;
    const double limit   = r.coefficient * c.rn;
    double       impulse = inverse > 0. ? start - (r.lever_j * j.s - r.lever_i * i.s + r.bias) / inverse : 0.;
    raise_to(impulse, -limit);
    lower_to(impulse, limit);
    return impulse;
  }

  /** Add a rolling impulse @p p to the spins of the discs. */
  ALLUVIUM_INLINE void roll(const RollingFriction &r, Disc &i, Disc &j, const double p)
  {
    i.s -= r.lever_i * i.inverse_rotation * p;
    j.s += r.lever_j * j.inverse_rotation * p;
  }

  /** Add an impulse (pn, pt) of contact @p c to the velocities of its discs. */
  template <typename T>
  ALLUVIUM_INLINE void push(const ContactValues<T> &c, DiscValues<T> &i, DiscValues<T> &j, const T &pn, const T &pt)
  {
    const T px = pn * c.nx - pt * c.ny, py = pn * c.ny + pt * c.nx;
    i.x -= i.inverse_mass * px;
    i.y -= i.inverse_mass * py;
    i.s -= i.inverse_rotation * pt;
    j.x += j.inverse_mass * px;
    j.y += j.inverse_mass * py;
    j.s -= j.inverse_rotation * pt;
  }
} // namespace alluvium::contacts
