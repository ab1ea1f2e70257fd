#include <alluvium/run/model.h>
#include <alluvium/run/scene_size.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace alluvium::run
{
  namespace
  {
    constexpr const char *guess = "Are lengths in mm? They must be in m.";

    std::string described(const double width, const double height, const double diameter)
    {
      std::ostringstream text;
      text << "the domain is " << width << " m x " << height << " m";
      if (diameter > 0.)
        text << ", which is " << width / diameter << " x " << height / diameter << " mean grain diameters of "
             << diameter << " m";
      return text.str();
    }
  } // namespace


  void check_scene_size(const Model &m)
  {
    const auto   size  = m.domain.upper() - m.domain.lower();
    const double width = size[0], height = size[1], d = grains::mean_diameter(m.grains);
    if (m.has_fluid && m.domain.is_rectangle() && m.coarse_size > 0.)
      {
        const double n_cells = std::ceil(width / m.coarse_size) * std::ceil(height / m.coarse_size);
        if (n_cells > 1.01 * m.adaptivity.most_cells()) // a mesh that is counted exactly is checked later
          {
            std::ostringstream text;
            text << "Domain: " << described(width, height, d) << ": unrefined cells of " << m.coarse_size
                 << " m would be " << n_cells << ", and 'Mesh refinement/Max cells' is " << m.adaptivity.most_cells()
                 << ". " << guess << " If they are, ask for larger cells ('Coarsest cell size', criteria).";
            throw UserError(text.str());
          }
      }

    if (m.grains.n() == 0 || std::max(width, height) <= m.domain.most_diameters() * d)
      return;
    double area = 0.;
    for (const double r : m.grains.radius)
      area += grains::disc_volume(r);
    constexpr double hardly_a_grain = 1e-3;
    if (area > hardly_a_grain * width * height)
      return;
    std::ostringstream text;
    text << "Domain: " << described(width, height, d) << ", and its grains fill " << area / (width * height)
         << " of it. " << guess << " If they are, allow it with 'Domain/Max diameters across'.";
    throw UserError(text.str());
  }


  void check_mesh_size(const Model &m, const double n_cells)
  {
    std::ostringstream text;
    text << "The unrefined mesh has " << n_cells << " cells, and 'Mesh refinement/Max cells' is "
         << m.adaptivity.most_cells() << ". Make it coarser or allow more.";
    check_user(n_cells <= m.adaptivity.most_cells(), text.str());
  }
} // namespace alluvium::run
