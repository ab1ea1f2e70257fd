#pragma once

#include <algorithm>
#include <cmath>

namespace alluvium
{
  /**
   * A sum that does not depend on the order of its terms: every term is first rounded to a multiple of a unit so coarse
   * that no sum of them is ever rounded again. Sums over several ranks then have the same bits as over one.
   *
   * The bound given must not be smaller than the largest absolute value of any partial sum. It costs accuracy: terms
   * are rounded to about 2^-50 times the bound. For terms >= 0, holds() tells afterwards, alike in any order, whether
   * the bound was large enough. (The pre-rounding of Demmel & Nguyen, Fast reproducible floating-point summation,
   * 2013.)
   */
  class ReproducibleSum
  {
  public:
    explicit ReproducibleSum(const double bound)
    {
      int exponent;
      std::frexp(std::clamp(bound, 1e-250, 1e250), &exponent);
      limit = std::ldexp(1., exponent);
      shift = 3. * limit;
    }

    void add(const double term) { sum += (term + shift) - shift; }

    /** What add() adds to a term and takes away again, for loops that do that themselves ... */
    double unit_shift() const { return shift; }

    /** ... and bring a sum of terms so rounded. */
    void add_rounded(const double part) { sum += part; }

    double value() const { return sum; }

    /** Put the sum of all ranks' values in place of this rank's. */
    void set(const double total) { sum = total; }

    bool holds() const { return sum <= limit; }

  private:
    double limit, shift; // shift: in the middle of an octave, so that adding a term stays within it
    double sum = 0.;
  };

  /** More terms than any sum over discs or contacts has: times the largest term, a bound. */
  constexpr double most_terms = 1e7;
} // namespace alluvium
