#include <alluvium/contacts/laws/contact_material.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <limits>

namespace alluvium::contacts
{
  namespace
  {
    /** Put the numbers of single walls in their places. */
    void apply(const std::string                      &parameter,
               const std::map<std::string, double>    &numbers,
               const double                            largest,
               const std::vector<grains::WallSegment> &walls,
               std::vector<ContactMaterial>           &materials,
               double ContactMaterial::*const member)
    {
      for (const auto &[name, number] : numbers)
        {
          check_user(number >= 0. && number <= largest,
                     "Contacts/" + parameter + ": the number of '" + name + "' must not be negative" +
                       (largest < std::numeric_limits<double>::max() ? ", nor above 1." : "."));
          bool        found = false;
          std::string names;
          for (std::size_t k = 0; k < walls.size(); ++k)
            {
              if (walls[k].name == name)
                {
                  materials[k].*member = number;
                  found                = true;
                }
              if (names.find("'" + walls[k].name + "'") == std::string::npos)
                names += (names.empty() ? "'" : ", '") + walls[k].name + "'";
            }
          check_user(found,
                     "Contacts/" + parameter + ": there is no wall '" + name + "'. " +
                       (names.empty() ? "This scene has no walls." : "The walls are " + names + "."));
        }
    }
  } // namespace

  ContactMaterials make_materials(const ContactSettings &settings, const std::vector<grains::WallSegment> &walls)
  {
    ContactMaterials result;
    result.grains          = {settings.friction, settings.rolling_friction, settings.restitution};
    ContactMaterial wall   = result.grains;
    wall.friction          = settings.wall_friction;
    result.walls           = std::vector<ContactMaterial>(walls.size(), wall);
    const double unlimited = std::numeric_limits<double>::max();
    apply(
      "Friction of single walls", settings.single_friction, unlimited, walls, result.walls, &ContactMaterial::friction);
    apply("Rolling friction of single walls",
          settings.single_rolling_friction,
          unlimited,
          walls,
          result.walls,
          &ContactMaterial::rolling);
    apply("Restitution of single walls",
          settings.single_restitution,
          1.,
          walls,
          result.walls,
          &ContactMaterial::restitution);

    const auto any = [&](double ContactMaterial::*const member) {
      return result.grains.*member > 0. || std::any_of(result.walls.begin(),
                                                       result.walls.end(),
                                                       [&](const ContactMaterial &m) { return m.*member > 0.; });
    };
    result.bounces = any(&ContactMaterial::restitution);
    result.rolls   = settings.rotation && any(&ContactMaterial::rolling);
    return result;
  }
} // namespace alluvium::contacts
