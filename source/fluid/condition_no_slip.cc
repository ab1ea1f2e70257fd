#include <alluvium/fluid/boundary_kind.h>

namespace alluvium::fluid
{
  namespace
  {
    class NoSlip : public BoundaryKind<2>
    {
    public:
      Velocity    velocity() const override { return Velocity::zero; }
      std::string in_words() const override { return "no slip"; }
    };
  } // namespace

  ALLUVIUM_REGISTER_BOUNDARY_KIND(
    NoSlip,
    "No-slip walls",
    "Names of the boundaries on which the fluid sticks: u = 0. Separated by commas. A rectangle's "
    "boundaries are left, right, bottom and top; a mesh file's are its physical groups.")
} // namespace alluvium::fluid
