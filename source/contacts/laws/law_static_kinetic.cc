#include <alluvium/contacts/laws/contact_law.h>
#include <alluvium/utilities/plugin.h>

#include <cmath>

namespace alluvium::contacts
{
  /**
   * Friction that weakens with the speed v of slip, from a static to a kinetic coefficient:
   *
   *   mu(v) = mu_k + (mu_s - mu_k) exp(-v / v_0)
   *
   * (Bo & Pavelescu, The friction-speed relation and its influence on the critical velocity of stick-slip motion, Wear
   * 1982, with exponent 1). mu_k is the friction coefficient of the materials. v is the speed at the start of the
   * sub-step, so that within it the law is Coulomb's.
   */
  class StaticKineticLaw : public ContactLaw
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("Static friction ratio",
                        ratio,
                        "Friction of surfaces at rest over that of surfaces that slide, which the friction "
                        "coefficients above are [-].",
                        dealii::Patterns::Double(0.));
      prm.add_parameter("Transition slip speed",
                        transition,
                        "At this slip speed, friction has come down by 1 - 1/e of the difference [m/s].",
                        dealii::Patterns::Double(1e-300));
    }

    void set_coefficients(const std::vector<ContactState> &states,
                          std::vector<ContactMaterial>    &coefficients) const override
    {
      for (std::size_t k = 0; k < states.size(); ++k)
        coefficients[k].friction *= 1. + (ratio - 1.) * std::exp(-states[k].slip_speed / transition);
    }

  private:
    double ratio      = 1.25;
    double transition = 1e-3;
  };

  ALLUVIUM_REGISTER(ContactLaw,
                    StaticKineticLaw,
                    "static-kinetic",
                    "friction is larger at rest than in slip, with a smooth transition at a given slip speed.")
} // namespace alluvium::contacts
