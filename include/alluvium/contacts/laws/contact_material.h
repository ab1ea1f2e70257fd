#pragma once

#include <alluvium/contacts/laws/contact_settings.h>
#include <alluvium/grains/wall.h>

#include <vector>

namespace alluvium::contacts
{
  class ContactLaw;

  /** What the laws need to know of a pair of materials [-]. */
  struct ContactMaterial
  {
    double friction    = 0.; // Coulomb's
    double rolling     = 0.; // the moment of rolling friction is at most this times reduced radius times normal force
    double restitution = 0.; // Newton's
  };

  /** Materials of contacts between grains, and of grains with every wall segment. */
  struct ContactMaterials
  {
    ContactMaterial              grains;
    std::vector<ContactMaterial> walls;

    bool bounces = false, rolls = false; // whether any of them has restitution, or rolling friction

    const ContactLaw *law = nullptr; // that changes them from contact to contact; none
  };

  /**
   * The materials of @p settings for these walls. Throws UserError, with the names there are, if the settings name a
   * wall that does not exist, and for a number out of range.
   */
  ContactMaterials make_materials(const ContactSettings &settings, const std::vector<grains::WallSegment> &walls);
} // namespace alluvium::contacts
