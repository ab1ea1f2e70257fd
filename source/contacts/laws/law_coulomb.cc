#include <alluvium/contacts/laws/contact_law.h>
#include <alluvium/utilities/plugin.h>

namespace alluvium::contacts
{
  /** Coulomb friction and Newton's restitution with constant coefficients. */
  class CoulombLaw : public ContactLaw
  {
  public:
    bool is_constant() const override { return true; }
    void set_coefficients(const std::vector<ContactState> &, std::vector<ContactMaterial> &) const override {}
  };

  ALLUVIUM_REGISTER(ContactLaw,
                    CoulombLaw,
                    "Coulomb",
                    "every contact has the coefficients of its materials, whatever it does.")
} // namespace alluvium::contacts
