#include <alluvium/contacts/laws/cohesion.h>
#include <alluvium/utilities/plugin.h>

namespace alluvium::contacts
{
  /** Dry, clean grains. */
  class NoCohesion : public Cohesion
  {
  public:
    bool   acts() const override { return false; }
    double force(double, double) const override { return 0.; }
    double reach(double) const override { return 0.; }
  };

  ALLUVIUM_REGISTER(Cohesion, NoCohesion, "none", "grains do not attract each other.")
} // namespace alluvium::contacts
