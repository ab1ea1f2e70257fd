#include <alluvium/contacts/solvers/contact_pack.h>
#include <alluvium/contacts/solvers/contact_sweep.h>

#include <cstddef>

namespace alluvium::contacts
{
  namespace
  {
    /** Terms of a sum, one or several at a time; see ReproducibleSum. */
    template <typename T>
    struct Terms
    {
      T shift, sum;

      ALLUVIUM_INLINE void add(const T &term) { sum += (term + shift) - shift; }
    };

    template <typename T>
    struct SweepTerms
    {
      Terms<T> change, size, work;

      explicit ALLUVIUM_INLINE SweepTerms(const ContactMeasure::Sums &sums)
        : change{T{} + sums.change.unit_shift(), T{}}
        , size{T{} + sums.size.unit_shift(), T{}}
        , work{T{} + sums.work.unit_shift(), T{}}
      {}

      ALLUVIUM_INLINE void
      add(const ContactValues<T> &c, const T &rn, const T &rt, const T &dn, const T &dt, const T &weight)
      {
        change.add(weight * (dn * dn + dt * dt));
        size.add(weight * (rn * rn + rt * rt));
        work.add(weight * (c.bias_n * rn + c.bias_t * rt));
      }
    };

    /** One contact. */
    template <bool momentum, class Law>
    ALLUVIUM_INLINE void relax(ContactProblem     &problem,
                               const std::size_t   k,
                               SweepTerms<double> &terms,
                               LastImpulse *const  last,
                               const double        beta)
    {
      Contact              &contact = problem.contacts[k];
      Disc                 &disc_i = problem.discs[contact.i], &disc_j = problem.discs[contact.j];
      ContactValues<double> c = values(contact);
      DiscValues<double>    i = values(disc_i), j = values(disc_j);
      if constexpr (momentum)
        {
          const LastImpulse before = last[k];
          last[k]                  = {c.rn, c.rt};
          c.rn += beta * (c.rn - before.rn);
          c.rt += beta * (c.rt - before.rt);
        }
      double rn, rt;
      Law::solve(c, i, j, rn, rt);
      const double dn = rn - c.rn, dt = rt - c.rt;
      push(c, i, j, dn, dt);
      disc_i.x   = i.x;
      disc_i.y   = i.y;
      disc_i.s   = i.s;
      disc_j.x   = j.x;
      disc_j.y   = j.y;
      disc_j.s   = j.s;
      contact.rn = rn;
      contact.rt = rt;
      terms.add(c, rn, rt, dn, dt, problem.counts(contact) ? 1. : 0.);
    }

    /** Four contacts that share no disc. */
    template <bool momentum, class Law>
    ALLUVIUM_INLINE void relax_four(
      ContactProblem &problem, const std::size_t k, SweepTerms<Pack> &terms, LastImpulse *const last, const double beta)
    {
      Contact *const      contact = problem.contacts.data() + k;
      Disc *const         discs   = problem.discs.data();
      ContactValues<Pack> c{};
      DiscValues<Pack>    i{}, j{};
      load(contact, c);
      load(discs[contact[0].i], discs[contact[1].i], discs[contact[2].i], discs[contact[3].i], i);
      load(discs[contact[0].j], discs[contact[1].j], discs[contact[2].j], discs[contact[3].j], j);
      if constexpr (momentum)
        {
          Pack last_rn, last_rt;
          load_pairs(&last[k].rn, last_rn, last_rt);
          store_pairs(&last[k].rn, c.rn, c.rt);
          c.rn += beta * (c.rn - last_rn);
          c.rt += beta * (c.rt - last_rt);
        }
      Pack rn, rt;
      Law::solve(c, i, j, rn, rt);
      const Pack dn = rn - c.rn, dt = rt - c.rt;
      push(c, i, j, dn, dt);
      store(discs[contact[0].i], discs[contact[1].i], discs[contact[2].i], discs[contact[3].i], i);
      store(discs[contact[0].j], discs[contact[1].j], discs[contact[2].j], discs[contact[3].j], j);
      store_impulses(contact, rn, rt);
      Pack weight = {1., 1., 1., 1.};
      if (problem.communicator != nullptr)
        for (unsigned int m = 0; m < pack_size; ++m)
          weight[m] = problem.counts(contact[m]) ? 1. : 0.;
      terms.add(c, rn, rt, dn, dt, weight);
    }

    template <bool packed, bool forward, bool momentum, class Law>
    ALLUVIUM_INLINE void sweep_colour(ContactProblem       &problem,
                                      const unsigned int    colour,
                                      ContactMeasure::Sums &sums,
                                      LastImpulse *const    last,
                                      const double          beta)
    {
      const std::size_t begin = problem.colour_begin[colour], end = problem.colour_begin[colour + 1];
      const std::size_t n_packs  = packed ? (end - begin) / pack_size : 0;
      const std::size_t n_single = end - begin - n_packs * pack_size;

      SweepTerms<Pack>   packs(sums);
      SweepTerms<double> singles(sums);
      for (std::size_t k = 0; k < n_packs; ++k)
        relax_four<momentum, Law>(problem, begin + pack_size * (forward ? k : n_packs - 1 - k), packs, last, beta);
      for (std::size_t k = 0; k < n_single; ++k)
        relax<momentum, Law>(problem, end - n_single + (forward ? k : n_single - 1 - k), singles, last, beta);
      for (unsigned int m = 0; m < pack_size; ++m)
        {
          sums.change.add_rounded(packs.change.sum[m]);
          sums.size.add_rounded(packs.size.sum[m]);
          sums.work.add_rounded(packs.work.sum[m]);
        }
      sums.change.add_rounded(singles.change.sum);
      sums.size.add_rounded(singles.size.sum);
      sums.work.add_rounded(singles.work.sum);
    }

    template <bool packed, class Law>
    ALLUVIUM_INLINE void sweep_colour(ContactProblem       &problem,
                                      const unsigned int    colour,
                                      const SweepOrder      order,
                                      ContactMeasure::Sums &sums,
                                      LastImpulse *const    last,
                                      const double          beta)
    {
      if (order == SweepOrder::forward)
        last ? sweep_colour<packed, true, true, Law>(problem, colour, sums, last, beta)
             : sweep_colour<packed, true, false, Law>(problem, colour, sums, last, beta);
      else
        last ? sweep_colour<packed, false, true, Law>(problem, colour, sums, last, beta)
             : sweep_colour<packed, false, false, Law>(problem, colour, sums, last, beta);
    }

    /** Rolling friction of a colour, after the rest of its contacts. */
    template <bool momentum>
    void roll_colour(ContactProblem &problem, const unsigned int colour, ContactMeasure::Sums &sums, const double beta)
    {
      for (std::size_t k = problem.colour_begin[colour]; k < problem.colour_begin[colour + 1]; ++k)
        {
          const Contact   &c = problem.contacts[k];
          RollingFriction &r = problem.rolling[k];
          Disc            &i = problem.discs[c.i], &j = problem.discs[c.j];
          double           start = r.impulse;
          if constexpr (momentum)
            {
              start += beta * (r.impulse - r.last);
              r.last = r.impulse;
            }
          r.impulse           = solve_rolling(r, c, i, j, start);
          const double change = r.impulse - start;
          roll(r, i, j, change);
          if (problem.counts(c))
            {
              sums.change.add(change * change);
              sums.size.add(r.impulse * r.impulse);
              sums.work.add(r.bias * r.impulse);
            }
        }
    }

    using SweepColour = void(ContactProblem &, unsigned int, SweepOrder, ContactMeasure::Sums &, LastImpulse *, double);

    void cone_colour(ContactProblem       &problem,
                     const unsigned int    colour,
                     const SweepOrder      order,
                     ContactMeasure::Sums &sums,
                     LastImpulse *const    last,
                     const double          beta)
    {
      sweep_colour<false, FrictionCone>(problem, colour, order, sums, last, beta);
    }

#ifdef __x86_64__
    __attribute__((target("avx2"))) void cone_colour_avx2(ContactProblem       &problem,
                                                          const unsigned int    colour,
                                                          const SweepOrder      order,
                                                          ContactMeasure::Sums &sums,
                                                          LastImpulse *const    last,
                                                          const double          beta)
    {
      sweep_colour<true, FrictionCone>(problem, colour, order, sums, last, beta);
    }

    // Packs pay only where the processor has registers for them; the bits are the same.
    SweepColour *const best_cone_colour = __builtin_cpu_supports("avx2") ? cone_colour_avx2 : cone_colour;
#else
    SweepColour *const best_cone_colour = cone_colour;
#endif

    ALLUVIUM_INLINE void extrapolate_discs(Disc *const discs, const std::size_t n, const double beta)
    {
      const Pack factor = {beta, beta, beta, 0.}; // the fourth number is no velocity
      for (std::size_t k = 0; k < n; ++k)
        {
          const Pack now = load_pack(&discs[k].x), last = load_pack(&discs[k].last_x);
          store_pack(&discs[k].x, now + factor * (now - last));
          store_pack(&discs[k].last_x, __builtin_shufflevector(now, last, 0, 1, 2, 7));
        }
    }

    using Extrapolate = void(Disc *, std::size_t, double);

    void extrapolate_plain(Disc *const discs, const std::size_t n, const double beta)
    {
      extrapolate_discs(discs, n, beta);
    }

#ifdef __x86_64__
    __attribute__((target("avx2"))) void extrapolate_avx2(Disc *const discs, const std::size_t n, const double beta)
    {
      extrapolate_discs(discs, n, beta);
    }

    Extrapolate *const best_extrapolate = __builtin_cpu_supports("avx2") ? extrapolate_avx2 : extrapolate_plain;
#else
    Extrapolate *const best_extrapolate = extrapolate_plain;
#endif
  } // namespace

  void remember(ContactProblem &problem)
  {
    for (Disc &d : problem.discs)
      {
        d.last_x = d.x;
        d.last_y = d.y;
        d.last_s = d.s;
      }
  }

  void extrapolate(ContactProblem &problem, const double beta)
  {
    best_extrapolate(problem.discs.data(), problem.n_discs, beta);
  }

  SweepSums sweep(ContactProblem    &problem,
                  ContactMeasure    &measure,
                  const SweepOrder   order,
                  LastImpulse *const last,
                  const double       beta)
  {
    ContactMeasure::Sums sums = measure.begin();
    const unsigned int   n    = problem.n_colours();
    for (unsigned int k = 0; k < n; ++k)
      {
        const unsigned int colour = order == SweepOrder::forward ? k : n - 1 - k;
        best_cone_colour(problem, colour, order, sums, last, beta);
        if (!problem.rolling.empty())
          last ? roll_colour<true>(problem, colour, sums, beta) : roll_colour<false>(problem, colour, sums, beta);
        if (problem.communicator != nullptr)
          problem.communicator->after_colour(problem.discs, colour);
      }
    return measure.end(sums);
  }
} // namespace alluvium::contacts
