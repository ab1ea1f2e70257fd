#include <alluvium/coupling/coupling.h>
#include <alluvium/coupling/homogeneous_bed.h>
#include <alluvium/fluid/vans_problem.h>
#include <alluvium/grains/packing.h>

#include <deal.II/base/mpi.h>

#include <boost/math/tools/roots.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace alluvium::coupling
{
  double HomogeneousBed::resistance(const DragLaw &law, const double u) const
  {
    double sum = 0.;
    for (const double r : grains.fluid_radius)
      sum += grains::disc_volume(r) * law.gamma({eps, u, 2. * r, fluid.density, fluid.viscosity});
    return sum;
  }


  double HomogeneousBed::permeability(const DragLaw &law) const
  {
    double volume = 0.;
    for (const double r : grains.fluid_radius)
      volume += grains::disc_volume(r);
    const double drag = resistance(law, 0.);
    return drag > 0. ? fluid.viscosity * eps * eps * volume / ((1. - eps) * drag) : 0.;
  }


  double HomogeneousBed::fluidisation_velocity(const DragLaw &law, const double g) const
  {
    double weight = 0.;
    for (std::size_t i = 0; i < grains.n(); ++i)
      if (!std::isinf(grains.mass[i]))
        weight += g * (grains.mass[i] - grains::disc_mass(fluid.density, grains.fluid_radius[i]));
    // inertia only adds to the drag of creeping flow: that is where the search starts
    const double start = eps * weight / resistance(law, 0.);
    if (!(weight > 0.) || !std::isfinite(start))
      return 0.;
    const auto     excess       = [&](const double u) { return resistance(law, u) * u / eps - weight; };
    std::uintmax_t n_iterations = 200;
    const auto [low, high]      = boost::math::tools::bracket_and_solve_root(
      excess, start, 2., true, boost::math::tools::eps_tolerance<double>(48), n_iterations);
    return eps * 0.5 * (low + high);
  }


  double HomogeneousBed::relaxation_time(const DragLaw &law) const
  {
    double mass = 0.;
    for (const double m : grains.mass)
      mass += std::isinf(m) ? 0. : m;
    const double drag = resistance(law, 0.);
    return drag > 0. ? mass / drag : 0.;
  }


  namespace
  {
    /** Call @p what(number of the piece, void fraction at its centroid) for all pieces of this rank. */
    template <typename What>
    void for_each_piece(const Coupling &coupling, const fluid::FluidSpace<2> &space, const What &what)
    {
      const auto &pieces = coupling.overlap().terms();
      const auto &eps    = coupling.void_fraction();
      for (unsigned int c = 0; c < space.cells().size(); ++c)
        for (unsigned int k = pieces.begin[c]; k < pieces.begin[c + 1]; ++k)
          {
            double e = 0.;
            for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
              e += pieces.shape[k].phi[v] * eps.local_element(space.cells()[c].node[v]);
            what(k, e);
          }
    }
  } // namespace


  double permeability_of_pieces(const Coupling               &coupling,
                                const fluid::FluidSpace<2>   &space,
                                const fluid::FluidProperties &fluid,
                                const grains::GrainArrays    &grains,
                                const double                  area)
  {
    constexpr double smallest_eps = 0.05; // that drag laws know
    const auto      &pieces       = coupling.overlap().terms();
    double           sum          = 0.;
    for_each_piece(coupling, space, [&](const unsigned int k, const double void_fraction) {
      const double e = std::max(void_fraction, smallest_eps);
      const double d = 2. * grains.fluid_radius[coupling.overlap().grain()[k]];
      sum += pieces.shape[k].area * coupling.drag_law().gamma({e, 0., d, fluid.density, fluid.viscosity}) / (e * e);
    });
    sum = dealii::Utilities::MPI::sum(sum, space.communicator());
    return sum > 0. ? fluid.viscosity * area / sum : 0.;
  }


  double void_fraction_of_densest(const Coupling &coupling, const fluid::FluidSpace<2> &space, const double share)
  {
    constexpr unsigned int n_bins = 1000;
    std::vector<double>    solid(n_bins, 0.);
    for_each_piece(coupling, space, [&](const unsigned int k, const double void_fraction) {
      const double bin = std::clamp(void_fraction, 0., 1.) * n_bins;
      solid[std::min(static_cast<unsigned int>(bin), n_bins - 1)] += coupling.overlap().terms().shape[k].area;
    });
    dealii::Utilities::MPI::sum(solid, space.communicator(), solid);
    const double all = std::accumulate(solid.begin(), solid.end(), 0.);
    double       sum = 0.;
    for (unsigned int bin = 0; all > 0. && bin < n_bins; ++bin)
      if ((sum += solid[bin]) >= share * all)
        return (bin + 0.5) / n_bins;
    return 1.;
  }


  double inner_void_fraction(const grains::GrainArrays &grains)
  {
    double solid = 0., contact = 0.;
    for (std::size_t i = 0; i < grains.n(); ++i)
      {
        solid += grains.fluid_radius[i] * grains.fluid_radius[i];
        contact += grains.radius[i] * grains.radius[i];
      }
    return contact > 0. ? 1. - grains::inner_packing_fraction(grains) * solid / contact : 1.;
  }
} // namespace alluvium::coupling
