#include <alluvium/fluid/boundary_kind.h>

namespace alluvium::fluid
{
  namespace
  {
    class Slip : public BoundaryKind<2>
    {
    public:
      Velocity    velocity() const override { return Velocity::no_flow_through; }
      std::string in_words() const override { return "slip"; }
    };

    class Symmetric : public Slip
    {
    };
  } // namespace

  ALLUVIUM_REGISTER_BOUNDARY_KIND(Slip,
                                  "Slip walls",
                                  "Names of the impermeable boundaries without wall shear: u.n = 0.")
  ALLUVIUM_REGISTER_BOUNDARY_KIND(
    Symmetric,
    "Symmetric",
    "Names of the symmetry lines: u.n = 0 and no shear, in this formulation the same as a slip wall.")
} // namespace alluvium::fluid
