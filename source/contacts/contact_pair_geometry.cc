#include <alluvium/contacts/contact_pair_geometry.h>
#include <alluvium/contacts/solvers/contact_pack.h>

#include <cmath>

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace alluvium::contacts
{
  namespace
  {
    ALLUVIUM_INLINE double root(const double x)
    {
      return std::sqrt(x);
    }

    ALLUVIUM_INLINE Pack root(const Pack &x)
    {
#ifdef __SSE2__
      const __m128d low = _mm_sqrt_pd(_mm_set_pd(x[1], x[0])), high = _mm_sqrt_pd(_mm_set_pd(x[3], x[2]));
      return Pack{low[0], low[1], high[0], high[1]};
#else
      return Pack{root(x[0]), root(x[1]), root(x[2]), root(x[3])};
#endif
    }

    /** One number for each of some items, from value(item). */
    template <typename T, class Item, class Value>
    ALLUVIUM_INLINE T collect(const Item *const item, const Value &value)
    {
      if constexpr (sizeof(T) == sizeof(double))
        return value(item[0]);
      else
        return T{value(item[0]), value(item[1]), value(item[2]), value(item[3])};
    }

    template <typename T>
    ALLUVIUM_INLINE void put(double *const to, const T &value)
    {
      std::memcpy(to, &value, sizeof value);
    }

    template <typename T>
    ALLUVIUM_INLINE void shorten(T &dx, const double length)
    {
      if (length > 0.)
        dx = dx > 0.5 * length ? dx - length : (dx < -0.5 * length ? dx + length : dx);
    }

    /** What one pair, or four of them, are apart. */
    template <typename T>
    struct Apart
    {
      T dx, dy, distance, gap;

      template <class Item, class Partner>
      ALLUVIUM_INLINE Apart(const Item *const          item,
                            const grains::GrainArrays &g,
                            const grains::Periodicity &periodicity,
                            const Partner             &partner)
      {
        const double *const x = g.position[0].data(), *const y = g.position[1].data(), *const r = g.radius.data();
        dx = collect<T>(item, [&](const Item &p) { return x[partner(p)]; }) -
             collect<T>(item, [&](const Item &p) { return x[p.i]; });
        dy = collect<T>(item, [&](const Item &p) { return y[partner(p)]; }) -
             collect<T>(item, [&](const Item &p) { return y[p.i]; });
        shorten(dx, periodicity.length[0]);
        shorten(dy, periodicity.length[1]);
        distance = root(dx * dx + dy * dy);
        gap      = distance - (collect<T>(item, [&](const Item &p) { return r[p.i]; }) +
                          collect<T>(item, [&](const Item &p) { return r[partner(p)]; }));
      }
    };

    template <typename T>
    ALLUVIUM_INLINE void find(const ContactPair *const   pair,
                              const unsigned int         k,
                              const grains::GrainArrays &grains,
                              const Disc *const          discs,
                              const grains::Periodicity &periodicity,
                              const ContactMargins      &margins,
                              PairGeometry              &result)
    {
      const Apart<T> apart(pair, grains, periodicity, [](const ContactPair &p) { return p.j; });
      const T        vx = collect<T>(pair, [&](const ContactPair &p) { return discs[p.j].x - discs[p.i].x; }),
              vy        = collect<T>(pair, [&](const ContactPair &p) { return discs[p.j].y - discs[p.i].y; });
      const T zero{}, one = zero + 1.;
      const T over = apart.distance > zero ? 1. / apart.distance : zero;
      put(result.nx + k, apart.distance > zero ? apart.dx * over : one);
      put(result.ny + k, apart.dy * over);
      put(result.distance + k, apart.distance);
      put(result.gap + k, apart.gap);
      put(result.bias + k, margins.bias(apart.gap));
      const T approach = vx * apart.dx + vy * apart.dy;
      put(result.approach + k, approach);
      put(result.vn + k, approach * over);
    }

    template <bool packed>
    ALLUVIUM_INLINE void find_all(const ContactPair *const   pairs,
                                  const unsigned int         n,
                                  const grains::GrainArrays &grains,
                                  const Disc *const          discs,
                                  const grains::Periodicity &periodicity,
                                  const ContactMargins      &margins,
                                  PairGeometry              &result)
    {
      unsigned int k = 0;
      if constexpr (packed)
        for (; k + pack_size <= n; k += pack_size)
          find<Pack>(pairs + k, k, grains, discs, periodicity, margins, result);
      for (; k < n; ++k)
        find<double>(pairs + k, k, grains, discs, periodicity, margins, result);
    }

    template <bool packed>
    ALLUVIUM_INLINE void find_all_gaps(const Contact *const       contacts,
                                       const unsigned int         n,
                                       const grains::GrainArrays &grains,
                                       const grains::Periodicity &periodicity,
                                       double *const              gaps)
    {
      // Beyond the grains are walls.
      const std::uint32_t n_grains = grains.n();
      const auto          partner  = [&](const Contact &c) { return c.j < n_grains ? c.j : c.i; };
      unsigned int        k        = 0;
      if constexpr (packed)
        for (; k + pack_size <= n; k += pack_size)
          put(gaps + k, Apart<Pack>(contacts + k, grains, periodicity, partner).gap);
      for (; k < n; ++k)
        gaps[k] = Apart<double>(contacts + k, grains, periodicity, partner).gap;
    }

#ifdef __x86_64__
    __attribute__((target("avx2"))) void find_avx2(const ContactPair *const   pairs,
                                                   const unsigned int         n,
                                                   const grains::GrainArrays &grains,
                                                   const Disc *const          discs,
                                                   const grains::Periodicity &periodicity,
                                                   const ContactMargins      &margins,
                                                   PairGeometry              &result)
    {
      find_all<true>(pairs, n, grains, discs, periodicity, margins, result);
    }

    __attribute__((target("avx2"))) void find_gaps_avx2(const Contact *const       contacts,
                                                        const unsigned int         n,
                                                        const grains::GrainArrays &grains,
                                                        const grains::Periodicity &periodicity,
                                                        double *const              gaps)
    {
      find_all_gaps<true>(contacts, n, grains, periodicity, gaps);
    }

    const bool has_avx2 = __builtin_cpu_supports("avx2");
#endif
  } // namespace

  void find_geometry(const ContactPair *const   pairs,
                     const unsigned int         n,
                     const grains::GrainArrays &grains,
                     const std::vector<Disc>   &discs,
                     const grains::Periodicity &periodicity,
                     const ContactMargins      &margins,
                     PairGeometry              &geometry)
  {
#ifdef __x86_64__
    if (has_avx2)
      return find_avx2(pairs, n, grains, discs.data(), periodicity, margins, geometry);
#endif
    find_all<false>(pairs, n, grains, discs.data(), periodicity, margins, geometry);
  }

  void find_gaps(const Contact *const       contacts,
                 const unsigned int         n,
                 const grains::GrainArrays &grains,
                 const grains::Periodicity &periodicity,
                 double *const              gaps)
  {
#ifdef __x86_64__
    if (has_avx2)
      return find_gaps_avx2(contacts, n, grains, periodicity, gaps);
#endif
    find_all_gaps<false>(contacts, n, grains, periodicity, gaps);
  }
} // namespace alluvium::contacts
