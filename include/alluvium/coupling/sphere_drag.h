#pragma once

#include <alluvium/coupling/drag_law.h>

namespace alluvium::coupling
{
  /**
   * What the closures for beds of spheres have in common. They are published, in many guises, as the drag on a sphere
   * over that of Stokes at the superficial slip U = eps |u - v|,
   *
   *   F(eps, Re) = F_drag / (3 pi eta d U),   Re = rho d U / eta,
   *
   * which makes gamma = 18 eta eps F / d^2. A slice of a cylinder has (2/pi) / (3/4) of that: its S d / 2V (frontal
   * area S, volume V) instead of the sphere's, as in DallavalleDrag.
   */
  class SphereDrag : public DragLaw
  {
  public:
    explicit SphereDrag(const DragRange &range)
      : valid(range)
    {}

    void      add_parameters(dealii::ParameterHandler &prm) override;
    double    gamma(const DragState &state) const override;
    DragRange range() const override { return valid; }

    /** F: above zero and finite for eps in [0.05, 1] and Re >= 0. */
    virtual double force(const double eps, const double re) const = 0;

  private:
    const DragRange valid;
    std::string     shape  = "sphere";
    double          factor = 1.;
  };

  /** F of Ergun's law, which is zero at eps = 1, Re = 0. */
  double ergun_force(const double eps, const double re);
  /** F of Wen and Yu's law. */
  double wen_yu_force(const double eps, const double re);
  /** F in creeping flow after Van der Hoef, Beetstra and Kuipers (J. Fluid Mech. 528, 2005): Carman's in dense beds. */
  double creeping_force(const double eps);
} // namespace alluvium::coupling
