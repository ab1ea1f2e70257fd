#include <alluvium/contacts/laws/cohesion.h>
#include <alluvium/utilities/plugin.h>

namespace alluvium::contacts
{
  /** The same attraction in every contact; grains part as soon as more than that pulls at them. */
  class ConstantForceCohesion : public Cohesion
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("Force",
                        attraction,
                        "Attraction of two touching grains, or of a grain and a wall [N/m].",
                        dealii::Patterns::Double(0.));
    }

    bool   acts() const override { return attraction > 0.; }
    double force(double, double) const override { return attraction; }
    double reach(double) const override { return 0.; }

  private:
    double attraction = 0.;
  };

  ALLUVIUM_REGISTER(Cohesion,
                    ConstantForceCohesion,
                    "constant force",
                    "the same force in every contact, while it lasts.")
} // namespace alluvium::contacts
