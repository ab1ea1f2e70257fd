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
    /** Of the refined mesh: how many cells there will be is known before one is made. */
    void check_refined_size(const Model &m, const std::array<double, 2> &n)
    {
      const dealii::Point<2> lower = m.domain.lower();
      const auto             side  = m.domain.upper() - lower;
      // of many, so many evenly spread ones: multiples of these two shares fill a square evenly
      constexpr double                        most = 5000., share[] = {0.7548776662466927, 0.5698402909980532};
      const double                            n_cells = n[0] * n[1];
      const bool                              all     = n_cells <= most;
      const std::size_t                       n_seen  = all ? n_cells : most;
      std::vector<refinement::CellCorners<2>> cells;
      for (std::size_t i = 0; i < n_seen; ++i)
        {
          std::array<double, 2> k = {{std::fmod(double(i), n[0]), std::floor(i / n[0])}};
          for (unsigned int d = 0; d < 2 && !all; ++d)
            k[d] = std::floor(n[d] * std::fmod(i * share[d], 1.));
          refinement::CellCorners<2> corners;
          for (unsigned int v = 0; v < 4; ++v)
            for (unsigned int d = 0; d < 2; ++d)
              corners[v][d] = lower[d] + (k[d] + (v >> d & 1)) / n[d] * side[d];
          cells.push_back(corners);
        }
      m.adaptivity.check_number(m.adaptivity.expected_cells(cells, n_cells / n_seen, m.refinement_context()));
    }
  } // namespace


  void check_scene_size(const Model &m)
  {
    const auto   size  = m.domain.upper() - m.domain.lower();
    const double width = size[0], height = size[1], d = grains::mean_diameter(m.grains);
    if (m.has_fluid && m.domain.is_rectangle() && m.coarse_size > 0.)
      {
        const auto   n       = m.domain.n_cells_of_rectangle(m.coarse_size);
        const double n_cells = n[0] * n[1];
        if (n_cells > m.adaptivity.most_cells())
          {
            std::ostringstream text;
            text << "Domain: " << described(width, height, d) << ": unrefined cells of " << m.coarse_size
                 << " m would be " << n_cells << ", and 'Mesh refinement/Max cells' is " << m.adaptivity.most_cells()
                 << ". " << guess << " If they are, ask for larger cells ('Coarsest cell size', criteria).";
            throw UserError(text.str());
          }
        check_refined_size(m, n);
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
