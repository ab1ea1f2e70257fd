#pragma once

#include <alluvium/contacts/solvers/contact_cone.h>
#include <alluvium/contacts/solvers/contact_problem.h>

#include <cstring>

// Packs never cross a function that is not inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace alluvium::contacts
{
  /** Four numbers that a processor handles at once, if it can; plain arithmetic with the same bits, if not. */
  using Pack = double __attribute__((vector_size(32)));

  constexpr unsigned int pack_size = 4;

  /** From four rows to four columns, or back. */
  ALLUVIUM_INLINE void transpose(Pack &a, Pack &b, Pack &c, Pack &d)
  {
    const Pack ab0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Pack cd0 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    a = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
    b = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
    c = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
    d = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
  }

  ALLUVIUM_INLINE Pack load_pack(const double *const p)
  {
    Pack result;
    std::memcpy(&result, p, sizeof result);
    return result;
  }

  ALLUVIUM_INLINE void store_pack(double *const p, const Pack &pack)
  {
    std::memcpy(p, &pack, sizeof pack);
  }

  ALLUVIUM_INLINE void load(const Disc &a, const Disc &b, const Disc &c, const Disc &d, DiscValues<Pack> &values)
  {
    values.x            = load_pack(&a.x);
    values.y            = load_pack(&b.x);
    values.s            = load_pack(&c.x);
    values.inverse_mass = load_pack(&d.x);
    transpose(values.x, values.y, values.s, values.inverse_mass);
    values.inverse_rotation = Pack{a.inverse_rotation, b.inverse_rotation, c.inverse_rotation, d.inverse_rotation};
  }

  ALLUVIUM_INLINE void store(Disc &a, Disc &b, Disc &c, Disc &d, const DiscValues<Pack> &values)
  {
    Pack rows[] = {values.x, values.y, values.s, values.inverse_mass};
    transpose(rows[0], rows[1], rows[2], rows[3]);
    store_pack(&a.x, rows[0]);
    store_pack(&b.x, rows[1]);
    store_pack(&c.x, rows[2]);
    store_pack(&d.x, rows[3]);
  }

  ALLUVIUM_INLINE void load(const Contact *const c, ContactValues<Pack> &values)
  {
    values.nx     = load_pack(&c[0].nx);
    values.ny     = load_pack(&c[1].nx);
    values.bias_n = load_pack(&c[2].nx);
    values.bias_t = load_pack(&c[3].nx);
    transpose(values.nx, values.ny, values.bias_n, values.bias_t);
    values.rn       = load_pack(&c[0].rn);
    values.rt       = load_pack(&c[1].rn);
    values.friction = load_pack(&c[2].rn);
    Pack indices    = load_pack(&c[3].rn);
    transpose(values.rn, values.rt, values.friction, indices);
  }

  /** Four pairs (first, second), one behind the other @p stride numbers apart. */
  ALLUVIUM_INLINE void load_pairs(const double *const p, Pack &first, Pack &second)
  {
    const Pack a = load_pack(p), b = load_pack(p + pack_size);
    first  = __builtin_shufflevector(a, b, 0, 2, 4, 6);
    second = __builtin_shufflevector(a, b, 1, 3, 5, 7);
  }

  ALLUVIUM_INLINE void store_pairs(double *const p, const Pack &first, const Pack &second)
  {
    store_pack(p, __builtin_shufflevector(first, second, 0, 4, 1, 5));
    store_pack(p + pack_size, __builtin_shufflevector(first, second, 2, 6, 3, 7));
  }

  ALLUVIUM_INLINE void store_impulses(Contact *const c, const Pack &rn, const Pack &rt)
  {
    using Half         = double __attribute__((vector_size(16))); // rn and rt lie side by side
    const Half pairs[] = {__builtin_shufflevector(rn, rt, 0, 4),
                          __builtin_shufflevector(rn, rt, 1, 5),
                          __builtin_shufflevector(rn, rt, 2, 6),
                          __builtin_shufflevector(rn, rt, 3, 7)};
    for (unsigned int k = 0; k < pack_size; ++k)
      std::memcpy(&c[k].rn, &pairs[k], sizeof pairs[k]);
  }
} // namespace alluvium::contacts
