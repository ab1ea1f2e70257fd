#include <alluvium/contacts/laws/cohesion.h>
#include <alluvium/utilities/plugin.h>

namespace alluvium::contacts
{
  /**
   * Bridges of liquid in the manner of pendular ones: a bridge forms when two grains touch, pulls at them while its
   * length is below a rupture distance, and is gone until they touch again.
   */
  class LiquidBridgeCohesion : public Cohesion
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("Force",
                        attraction,
                        "Attraction of two touching grains, or of a grain and a wall [N/m].",
                        dealii::Patterns::Double(0.));
      prm.add_parameter("Rupture distance",
                        rupture,
                        "The gap at which a bridge ruptures, over the reduced radius r1 r2 / (r1 + r2), with a wall "
                        "over the grain's radius [-].",
                        dealii::Patterns::Double(0., 1.));
      prm.add_parameter("Force at rupture",
                        remaining,
                        "Attraction just before a bridge ruptures, over that of touching grains [-]; in between it is "
                        "linear in the gap.",
                        dealii::Patterns::Double(0., 1.));
    }

    bool acts() const override { return attraction > 0.; }

    double force(const double gap, const double reduced_radius) const override
    {
      const double length = reach(reduced_radius);
      return length > 0. ? attraction * (1. - (1. - remaining) * gap / length) : attraction;
    }

    double reach(const double reduced_radius) const override { return rupture * reduced_radius; }

  private:
    double attraction = 0., rupture = 0.2, remaining = 0.5;
  };

  ALLUVIUM_REGISTER(Cohesion,
                    LiquidBridgeCohesion,
                    "liquid bridge",
                    "a bridge that forms in contact and pulls until it is stretched to its rupture distance.")
} // namespace alluvium::contacts
