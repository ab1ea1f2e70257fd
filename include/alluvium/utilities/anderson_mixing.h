#pragma once

#include <vector>

namespace alluvium
{
  /**
   * Weights for combining the iterates of a fixed-point iteration: with residuals r_i, those w_i of sum 1 that make
   * |sum w_i r_i| smallest. (D. G. Anderson, J. ACM 12 (1965) 547.) Residuals so alike that they say nothing new are
   * left out.
   */
  class AndersonMixing
  {
  public:
    explicit AndersonMixing(const unsigned int depth)
      : depth(depth)
    {}

    /** Add the residual of the latest iterate, and drop the oldest beyond the depth. */
    void add(std::vector<double> residual);

    /** How many iterates weights() is for, the oldest first. */
    unsigned int n() const { return residuals.size(); }

    std::vector<double> weights() const;

  private:
    unsigned int                     depth;
    std::vector<std::vector<double>> residuals;
  };
} // namespace alluvium
