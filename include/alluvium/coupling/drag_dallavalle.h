#pragma once

#include <alluvium/coupling/drag_law.h>

namespace alluvium::coupling
{
  /**
   * Dallavalle's drag coefficient with Di Felice's voidage function:
   *
   *   gamma = factor * shape * eps^-n (a sqrt(eps Re) + b)^2 eta / d^2,   Re = rho d |u - v| / eta
   *
   * with shape = S d / 2V (S frontal area, V volume): 3/4 for a sphere, 2/pi for a disc. n is 2.8 (constant
   * exponent 3.8), or Di Felice's n = beta - 1, beta = 3.7 - 0.65 exp(-(1.5 - log10(eps Re))^2 / 2) (Int. J. Multiphase
   * Flow 20, 1994).
   */
  class DallavalleDrag : public DragLaw
  {
  public:
    DallavalleDrag(const double shape, const double a, const double b)
      : shape(shape)
      , a(a)
      , b(b)
    {}

    void   add_parameters(dealii::ParameterHandler &prm) override;
    double gamma(const DragState &state) const override;
    /** Di Felice's data. */
    DragRange range() const override { return {0.4, 1., 0., 1e4}; }

  private:
    const double shape, a, b;
    std::string  exponent = "constant";
    double       factor   = 1.;
  };
} // namespace alluvium::coupling
