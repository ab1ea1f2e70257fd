#include <alluvium/contacts/search/contact_overlaps.h>
#include <alluvium/grains/bed_packing.h>
#include <alluvium/run/grain_setup.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/magnitudes.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>

namespace alluvium::run
{
  using namespace dealii;

  namespace
  {
    /** Run @p make on one rank; its result, or its UserError, reaches all. */
    template <typename Make>
    auto made_on_first_rank(MPI_Comm communicator, const Make &make)
    {
      decltype(make()) result;
      std::string      error;
      if (Utilities::MPI::this_mpi_process(communicator) == 0)
        try
          {
            result = make();
          }
        catch (const UserError &e)
          {
            error = e.what();
          }
      error = Utilities::MPI::broadcast(communicator, error);
      check_user(error.empty(), error);
      return result;
    }

    /** As Utilities::MPI::broadcast(), which packs and compresses: ten seconds for a million grains. */
    std::vector<double> broadcast_numbers(MPI_Comm communicator, std::vector<double> numbers)
    {
      unsigned long long n = numbers.size();
      MPI_Bcast(&n, 1, MPI_UNSIGNED_LONG_LONG, 0, communicator);
      numbers.resize(n);
      constexpr unsigned long long most = 1 << 27; // MPI counts in int
      for (unsigned long long begin = 0; begin < n; begin += most)
        MPI_Bcast(&numbers[begin], static_cast<int>(std::min(most, n - begin)), MPI_DOUBLE, 0, communicator);
      return numbers;
    }
  } // namespace


  void GrainSetup::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Grains");
    deposit.add_parameters(prm, "Deposit", "settled bed", "Where the grains are at t = 0.");
    prm.add_parameter("Density",
                      density,
                      "Density of the grains [kg/m^3], where the deposit does not give it.",
                      Patterns::Double(1e-3, magnitudes::largest_density));
    prm.add_parameter(
      "Fluid radius factor",
      factor,
      "Radius of a grain that the fluid sees, over the radius that touches. Below 1 it makes room for the fluid: discs "
      "pack denser (0.82) than spheres (0.6).",
      Patterns::Double(1e-3, 1.));
    prm.add_parameter(
      "Fluid packing fraction",
      packing,
      "If above 0, choose the fluid radius factor such that the bed, as deposited, has this packing fraction for the "
      "fluid: the area of the bed's grains over that between its bottom and its top, as wide as the bed is.",
      Patterns::Double(0., 0.9));
    prm.add_parameter("Mass follows",
                      mass_follows,
                      "Which radius r gives a grain its mass pi r^2 density per unit depth.",
                      Patterns::Selection("contact radius|fluid radius"));
    prm.add_parameter("Fixed", fixed_grains, "Hold all grains where they are; the fluid flows through them.");
    prm.add_parameter("Overlap tolerance",
                      overlap_tolerance,
                      "Largest overlap at t = 0, between grains or of a grain with a wall, as a part of the smallest "
                      "diameter; more is an "
                      "error.",
                      Patterns::Double(0.));
    wall_setup.add_parameters(prm);
    prm.leave_subsection();
  }


  std::vector<grains::WallSegment> GrainSetup::walls(const mesh::Domain<2> &domain) const
  {
    return wall_setup.walls(domain);
  }


  namespace
  {
    /** What falls is made in a scene that stands upright, and turned back. */
    std::vector<deposits::NewGrain> make_deposit(const deposits::Deposit &deposit, deposits::DepositContext context)
    {
      const auto upright = geometry::Upright::of(context.gravity);
      if (!deposit.falls() || upright.is_default())
        return deposit.make(context);
      context.upright = upright;
      upright.turn(context.lower, context.upper);
      for (auto *walls : {&context.walls, &context.sides})
        for (auto &wall : *walls)
          {
            for (auto *x : {&wall.a, &wall.b, &wall.velocity, &wall.centre})
              *x = upright.to(*x);
            // turning by a mirror turns spins round
            if (upright.vertical == 0 ? upright.sign > 0. : upright.sign < 0.)
              wall.spin = -wall.spin;
          }
      context.gravity         = upright.to(context.gravity);
      std::array<double, 2> a = context.periodicity.lower, b = a;
      for (unsigned int d = 0; d < 2; ++d)
        b[d] += context.periodicity.length[d];
      upright.turn(a, b);
      for (unsigned int d = 0; d < 2; ++d)
        {
          context.periodicity.lower[d]  = a[d];
          context.periodicity.length[d] = b[d] - a[d];
        }
      auto new_grains = deposit.make(context);
      for (auto &seed : new_grains)
        {
          const auto x = upright.from({{seed.x, seed.y}}), v = upright.from({{seed.vx, seed.vy}});
          seed.x  = x[0];
          seed.y  = x[1];
          seed.vx = v[0];
          seed.vy = v[1];
        }
      return new_grains;
    }
  } // namespace


  grains::GrainArrays GrainSetup::make(MPI_Comm                                communicator,
                                       const mesh::Domain<2>                  &domain,
                                       const std::vector<grains::WallSegment> &walls,
                                       const std::array<double, 2>            &gravity,
                                       const std::string                      &directory) const
  {
    std::vector<grains::WallSegment> standing; // at t = 0
    std::copy_if(
      walls.begin(), walls.end(), std::back_inserter(standing), [](const auto &wall) { return wall.present; });
    // one rank makes them, as plain numbers for all
    constexpr unsigned int    n_numbers = 7;
    const std::vector<double> numbers =
      broadcast_numbers(communicator, made_on_first_rank(communicator, [&] {
                          std::vector<std::string>              warnings;
                          const std::vector<deposits::NewGrain> new_grains =
                            make_deposit(deposit.get(),
                                         {{{domain.lower()[0], domain.lower()[1]}},
                                          {{domain.upper()[0], domain.upper()[1]}},
                                          standing,
                                          density,
                                          gravity,
                                          directory,
                                          domain.periodicity(),
                                          may_write,
                                          &warnings,
                                          {},
                                          domain.is_rectangle() ? std::vector<grains::WallSegment>() : domain.sides(),
                                          !fixed_grains});
                          for (const std::string &warning : warnings)
                            std::cerr << "alluvium: warning: " << warning << std::endl;
                          std::vector<double> flat;
                          for (const auto &s : new_grains)
                            flat.insert(flat.end(), {s.x, s.y, s.radius, s.density, s.vx, s.vy, s.omega});
                          return flat;
                        }));

    grains::GrainArrays grains;
    const std::size_t   n = numbers.size() / n_numbers;
    check_user(n > 0 || unit_length() > 0.,
               "Grains: the deposit '" + deposit.name() +
                 "' made no grains. If there shall be none: Grains/Deposit = none.");
    if (n == 0)
      return grains;
    grains.resize(n);
    std::vector<double> densities(n);
    for (std::size_t i = 0; i < n; ++i)
      {
        const double *s       = &numbers[i * n_numbers];
        grains.id[i]          = i;
        grains.position[0][i] = grains.initial_position[0][i] = s[0];
        grains.position[1][i] = grains.initial_position[1][i] = s[1];
        grains.radius[i]                                      = s[2];
        densities[i]                                          = s[3];
        grains.velocity[0][i]                                 = fixed_grains ? 0. : s[4];
        grains.velocity[1][i]                                 = fixed_grains ? 0. : s[5];
        grains.omega[i]                                       = fixed_grains ? 0. : s[6];
        for (unsigned int d = 0; d < 2; ++d)
          check_user(s[d] >= domain.lower()[d] && s[d] <= domain.upper()[d],
                     "Grains: grain " + std::to_string(i) + " at (" + in_digits(s[0]) + ", " + in_digits(s[1]) +
                       ") m is outside the domain, which reaches from (" + in_digits(domain.lower()[0]) + ", " +
                       in_digits(domain.lower()[1]) + ") to (" + in_digits(domain.upper()[0]) + ", " +
                       in_digits(domain.upper()[1]) + ") m.");
        check_user(domain.contains(s[0], s[1]),
                   "Grains: grain " + std::to_string(i) + " at (" + in_digits(s[0]) + ", " + in_digits(s[1]) +
                     ") m is outside the domain: in an obstacle, or beyond a boundary of the mesh.");
      }
    contacts::check_overlaps(grains,
                             walls,
                             2. * overlap_tolerance * *std::min_element(grains.radius.begin(), grains.radius.end()),
                             domain.periodicity());
    last_factor = find_radius_factor(grains, domain, geometry::Upright::of(gravity));
    for (std::size_t i = 0; i < n; ++i)
      {
        grains.fluid_radius[i] = last_factor * grains.radius[i];
        const double r         = mass_follows == "fluid radius" ? grains.fluid_radius[i] : grains.radius[i];
        grains.mass[i]         = grains::disc_mass(densities[i], r);
      }
    return grains;
  }


  double GrainSetup::find_radius_factor(const grains::GrainArrays &grains,
                                        const mesh::Domain<2>     &domain,
                                        const geometry::Upright   &upright) const
  {
    const unsigned int across = 1 - upright.vertical;

    if (packing == 0.)
      return factor;
    const grains::BedPacking bed = grains::measure_bed(grains, domain.lower()[across], domain.upper()[across], upright);
    check_user(bed.solid > 0., "Grains/Fluid packing fraction: the grains form no bed whose packing could be chosen.");
    const double result = std::sqrt(packing * bed.height * bed.width / bed.solid);
    check_user(result <= 1.,
               "Grains/Fluid packing fraction: the bed's own is only " + in_digits(bed.fraction()) +
                 ", so that it cannot be " + in_digits(packing) + " for the fluid.");
    return result;
  }
} // namespace alluvium::run
