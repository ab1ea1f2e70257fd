#include <alluvium/coupling/grain_sums.h>
#include <alluvium/coupling/overlap_map.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>

namespace alluvium::coupling
{
  OverlapMap::OverlapMap(const fluid::FluidSpace<dim> &space)
    : space(&space)
    , cutter(space)
  {}


  void OverlapMap::reinit()
  {
    forget_positions();
    cutter.reinit();
  }


  bool OverlapMap::has_moved(const grains::GrainArrays &grains, const std::size_t g) const
  {
    double distance = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      distance = std::max(distance, std::abs(grains.position[d][g] - discs.position[d][g]));
    return distance > 2. * cut_with.tolerance * grains.radius[g];
  }


  std::vector<std::uint8_t> OverlapMap::find_moved(const grains::GrainArrays &grains, const OverlapSettings &settings)
  {
    const std::size_t   n = grains.n();
    std::vector<double> radius(n);
    for (std::size_t g = 0; g < n; ++g)
      radius[g] = settings.filter_radius > 0. ? 2. * settings.filter_radius * grains.radius[g] : grains.fluid_radius[g];

    const bool same =
      discs.n() == n && cut_with.rule == settings.rule && cut_with.shape_of_discs() == settings.shape_of_discs() &&
      cut_with.keep_arms == settings.keep_arms && discs.radius == radius && fluid_radius == grains.fluid_radius;
    cut_with = settings;
    std::vector<std::uint8_t> moved(n, 1);
    if (same)
      for (std::size_t g = 0; g < n; ++g)
        moved[g] = has_moved(grains, g);
    else
      {
        discs        = {grains.position, radius};
        fluid_radius = grains.fluid_radius;
      }
    return moved;
  }


  bool OverlapMap::is_cut_where(const grains::GrainArrays &grains) const
  {
    if (discs.n() != grains.n())
      return false;
    for (std::size_t g = 0; g < grains.n(); ++g)
      if (has_moved(grains, g))
        return false;
    return true;
  }


  bool OverlapMap::cut(const grains::GrainArrays &grains, const OverlapSettings &settings)
  {
    if (grains.n() == 0)
      {
        cut_with          = settings;
        pieces            = PieceList();
        pieces.keeps_arms = settings.keep_arms;
        pieces.terms.begin.assign(cutter.n_cells() + 1, 0);
        discs = {};
        return true; // on all ranks, whoever had pieces
      }
    const std::vector<std::uint8_t> moved = find_moved(grains, settings);
    if (std::none_of(moved.begin(), moved.end(), [](auto m) { return m; }))
      return false;

    const bool  all    = std::all_of(moved.begin(), moved.end(), [](auto m) { return m; });
    const Discs before = all ? Discs() : discs;
    for (std::size_t g = 0; g < grains.n(); ++g)
      if (moved[g])
        for (unsigned int d = 0; d < dim; ++d)
          discs.position[d][g] = grains.position[d][g];
    cutter.cut(discs, before, moved, settings, pieces);
    weigh(grains);
    return true;
  }


  void OverlapMap::weigh(const grains::GrainArrays &grains)
  {
    std::vector<double> weight(grains.n(), 0.);
    for (std::size_t k = 0; k < pieces.n(); ++k)
      weight[pieces.grain[k]] += pieces.raw_area[k];
    sum_over_ranks(weight, communicator());
    for (std::size_t g = 0; g < grains.n(); ++g)
      {
        if (!(weight[g] > 0.)) // a message for every grain would cost more than cutting it
          throw UserError("Grain " + std::to_string(grains.id[g]) + " at (" + std::to_string(grains.position[0][g]) +
                          ", " + std::to_string(grains.position[1][g]) + ") m has left the fluid's domain.");
        weight[g] = grains::disc_volume(grains.fluid_radius[g]) / weight[g];
      }
    for (std::size_t k = 0; k < pieces.n(); ++k)
      pieces.terms.shape[k].area = pieces.raw_area[k] * weight[pieces.grain[k]];
  }
} // namespace alluvium::coupling
