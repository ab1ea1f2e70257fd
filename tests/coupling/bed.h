#pragma once

// Beds of discs for the tests of the coupling: cut out of a settled bed, so that they fill a rectangle from end to end.
#include "fixtures/boundary_kinds.h"

#include <alluvium/coupling/coupling.h>
#include <alluvium/deposits/deposit.h>

#include <deal.II/base/function_lib.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <cmath>

namespace bed
{
  using namespace dealii;
  namespace coupling = alluvium::coupling;
  namespace fluid    = alluvium::fluid;
  namespace deposits = alluvium::deposits;
  namespace grains   = alluvium::grains;

  struct Bed
  {
    grains::GrainArrays grains;
    double              width, height, d; // [m]
  };

  /** A bed of @p n discs 0.2 to 0.24 mm, settled on a floor between walls, @p width apart [m]. */
  inline std::vector<deposits::NewGrain>
  settled_seeds(const unsigned int seed, const unsigned int n, const double width)
  {
    using Registry           = alluvium::Registry<deposits::Deposit>;
    auto             deposit = Registry::entries().at("settled bed").create();
    ParameterHandler prm;
    deposit->add_parameters(prm);
    prm.set("Number of grains", static_cast<long int>(n));
    prm.set("Seed", static_cast<long int>(seed));
    prm.set("Cache folder", "");
    return deposit->make({{{0., 0.}}, {{width, 1.}}, {}, 2630., {{0., -9.81}}, "."});
  }

  /** @p layers of a settled bed of discs 0.2 to 0.24 mm, @p across grains wide, with @p packing for the fluid. */
  inline Bed
  random_bed(const unsigned int seed, const double across = 30., const double layers = 20., const double packing = 0.52)
  {
    const double d          = 2.2e-4;
    const double width      = across * d;
    const auto   new_grains = settled_seeds(seed, across * (layers + 12.) * 1.06, width);

    Bed          b;
    const double bottom = 4. * d;
    double       area   = 0.;
    b.d                 = d;
    b.width             = width;
    b.height            = layers * d;
    for (const auto &s : new_grains)
      if (s.y > bottom && s.y < bottom + b.height)
        {
          auto &g = b.grains;
          g.resize(g.n() + 1);
          g.id.back()          = g.n() - 1;
          g.position[0].back() = s.x;
          g.position[1].back() = s.y - bottom;
          g.radius.back()      = s.radius;
          area += numbers::PI * s.radius * s.radius;
        }
    const double factor = std::sqrt(packing * width * b.height / area);
    for (std::size_t i = 0; i < b.grains.n(); ++i)
      {
        b.grains.fluid_radius[i]        = factor * b.grains.radius[i];
        b.grains.mass[i]                = 2630. * numbers::PI * b.grains.radius[i] * b.grains.radius[i];
        b.grains.initial_position[0][i] = b.grains.position[0][i];
        b.grains.initial_position[1][i] = b.grains.position[1][i];
      }
    return b;
  }

  /** Discs of diameter @p d, as many as fit: the lightest way to a bed that only needs to be fixed. */
  inline Bed hexagonal_bed(const double width, const double height, const double d)
  {
    Bed        result;
    const auto rows = static_cast<unsigned int>(height / (d * std::sqrt(0.75)));
    for (unsigned int j = 0; j < rows; ++j)
      for (double x = (0.5 + 0.5 * (j % 2)) * d; x < width - 0.4 * d; x += d)
        {
          auto &g = result.grains;
          g.resize(g.n() + 1);
          g.id.back()           = g.n() - 1;
          g.position[0].back()  = x;
          g.position[1].back()  = (0.5 + j * std::sqrt(0.75)) * d;
          g.radius.back()       = 0.5 * d;
          g.fluid_radius.back() = 0.5 * d * std::sqrt(0.52 / 0.9069);
          g.mass.back()         = 2630. * M_PI * 0.25 * d * d;
        }
    result.width = width, result.height = height, result.d = d;
    return result;
  }

  /** What a test may vary. */
  struct Settings
  {
    double      h_over_d = 1.;
    double      dt       = 1e-3;
    double      filter   = 2.;                                                      // 0: the grain
    bool        smooth   = false;                                                   // the filter
    bool        moments = true, lumped = true, triangles = false, periodic = false; // in x
    std::string drag = "disc", scheme = "semi-implicit per grain", regularisation = "floor";
    double      added_mass  = 0.;
    bool        convection  = true;
    bool        rotation    = false;
    bool        graded      = false; // h only at half the height, up to 8 d elsewhere
    double      tolerance   = 1e-3;  // of `iterated`
    int         repetitions = 10;
  };

  /** A coupled fluid on a uniform mesh over a rectangle: slip sides, pressures below and above. */
  class Channel
  {
  public:
    Channel(const double width, const double height, const double h, const Settings &s, const double pressure_below)
      : solver(space)
      , coupling(space, solver)
    {
      const std::vector<unsigned int> n = {static_cast<unsigned int>(std::max(1., std::round(width / h))),
                                           static_cast<unsigned int>(std::max(1., std::round(height / h)))};
      if (s.triangles)
        {
          Triangulation<2> quads;
          GridGenerator::subdivided_hyper_rectangle(quads, n, Point<2>(), Point<2>(width, height), true);
          GridGenerator::convert_hypercube_to_simplex_mesh(quads, tria_simplex);
        }
      else if (s.graded)
        make_graded(width, height, h, 8. * h / s.h_over_d);
      else
        GridGenerator::subdivided_hyper_rectangle(tria, n, Point<2>(), Point<2>(width, height), true);
      if (s.periodic)
        {
          std::vector<GridTools::PeriodicFacePair<Triangulation<2>::cell_iterator>> pairs;
          GridTools::collect_periodic_faces(tria, 0, 1, 0, pairs);
          tria.add_periodicity(pairs);
          space.set_periodic_box({{{0., 0.}}, {{width, 0.}}});
        }
      else
        {
          bc.set(0, {boundary_kinds::slip, "left", nullptr});
          bc.set(1, {boundary_kinds::slip, "right", nullptr});
        }
      set_pressure_below(pressure_below);
      bc.set(3, {boundary_kinds::pressure, "top", std::make_shared<Functions::ConstantFunction<2>>(0.)});
      settings = s;
      initialize();
    }

    /** Cells of about @p h at half the height, as large as half the distance to it elsewhere, but not above @p max. */
    void make_graded(const double width, const double height, const double h, const double max)
    {
      unsigned int levels = 0;
      while (h * (2 << levels) <= max)
        ++levels;
      const double coarse = h * (1 << levels);
      GridGenerator::subdivided_hyper_rectangle(
        tria,
        {static_cast<unsigned int>(std::round(width / coarse)), static_cast<unsigned int>(std::round(height / coarse))},
        Point<2>(),
        Point<2>(width, height),
        true);
      for (; levels > 0; --levels)
        {
          for (const auto &cell : tria.active_cell_iterators())
            if (cell->is_locally_owned() &&
                cell->extent_in_direction(1) > 0.5 * std::abs(cell->center()[1] - 0.5 * height))
              cell->set_refine_flag();
          tria.execute_coarsening_and_refinement();
        }
    }

    void set_pressure_below(const double p)
    {
      bc.set(2, {boundary_kinds::pressure, "bottom", std::make_shared<Functions::ConstantFunction<2>>(p)});
    }

    void initialize()
    {
      space.attach(settings.triangles ? static_cast<const Triangulation<2> &>(tria_simplex) : tria);
      space.reinit(bc);
      ParameterHandler prm;
      coupling.add_parameters(prm);
      prm.enter_subsection("Coupling");
      prm.set("Drag law", settings.drag);
      prm.set("Time scheme", settings.scheme);
      prm.set("Drag regularisation", settings.regularisation);
      prm.set("Added mass coefficient", settings.added_mass);
      prm.set("Rotation", settings.rotation);
      prm.enter_subsection("Time scheme: iterated");
      prm.set("Tolerance", settings.tolerance);
      prm.set("Coupling iterations", static_cast<long int>(settings.repetitions));
      prm.leave_subsection();
      prm.leave_subsection();
      coupling.parse_parameters();
      coupling.settings.filter_radius = settings.filter;
      coupling.settings.shape =
        settings.smooth ? coupling::OverlapSettings::Shape::parabolic : coupling::OverlapSettings::Shape::top_hat;
      coupling.settings.rule =
        settings.moments ? coupling::OverlapSettings::Rule::moments : coupling::OverlapSettings::Rule::centroid;
      solver.discretisation.lumped_drag = settings.lumped;
      solver.reinit();
      solver.choose_datum(bc);
      coupling.reinit();
    }

    /** Largest minus smallest reduced pressure [Pa]. */
    double pressure_range() const
    {
      const auto &p   = solver.solution().block(1);
      double      low = std::numeric_limits<double>::max(), high = -low;
      for (const double value : p)
        {
          low  = std::min(low, value);
          high = std::max(high, value);
        }
      return Utilities::MPI::max(high, MPI_COMM_WORLD) - Utilities::MPI::min(low, MPI_COMM_WORLD);
    }

    void step(const grains::GrainArrays &g, const bool fixed)
    {
      const std::vector<std::uint8_t> touched(g.n(), 0);
      solver.accept();
      coupling.step(bc, g, touched, settings.dt, fixed, loads);
    }

    Settings                                settings;
    parallel::distributed::Triangulation<2> tria{MPI_COMM_WORLD};
    Triangulation<2>                        tria_simplex;
    fluid::BoundaryConditions<2>            bc;
    fluid::FluidSpace<2>                    space;
    fluid::VansSolver<2>                    solver;
    coupling::Coupling                      coupling;
    grains::GrainLoads                      loads;
  };

  /** Superficial velocity [m/s] of the homogenised law under pressure gradient @p gradient [Pa/m]. */
  inline double darcy_velocity(const Bed &bed, const coupling::DragLaw &law, const double gradient)
  {
    double solid = 0.;
    for (const double r : bed.grains.fluid_radius)
      solid += numbers::PI * r * r;
    const double eps = 1. - solid / (bed.width * bed.height);
    double       low = 0., high = 1.;
    for (unsigned int k = 0; k < 100; ++k)
      {
        const double u    = 0.5 * (low + high);
        double       drag = 0.;
        for (const double r : bed.grains.fluid_radius)
          drag += numbers::PI * r * r * law.gamma({eps, u, 2. * r, 1000., 1e-3}) * u;
        (drag / (bed.width * bed.height) > eps * gradient ? high : low) = u;
      }
    return eps * low;
  }

  struct Flux
  {
    double over_darcy, u_max_over_superficial, third_law, imbalance;
    double pressure_range; // largest minus smallest reduced pressure over what is imposed
  };

  /** Stationary flux through the fixed @p bed under a head of @p gradient times its height. */
  inline Flux fixed_bed_flux(const Bed &bed, const Settings &s, const double gradient = 0.75)
  {
    const double pressure = gradient * 1000. * 9.81 * bed.height;
    Channel      channel(bed.width, bed.height, s.h_over_d * bed.d, s, pressure);
    channel.solver.discretisation.convection = s.convection;
    double flux = 0., last = 1.;
    for (unsigned int k = 0; k < 80 && (k < 4 || std::abs(flux - last) > 1e-6 * std::abs(flux)); ++k)
      {
        channel.step(bed.grains, true);
        last = flux;
        flux = channel.solver.flux(3);
      }
    channel.coupling.audit();
    const auto  &report = channel.coupling.report();
    const double exact  = bed.width * darcy_velocity(bed, channel.coupling.drag_law(), pressure / bed.height);
    return {flux / exact,
            channel.solver.solution().block(0).linfty_norm() * bed.width / exact,
            std::abs(report.force_on_grains[1] + report.force_on_fluid[1]) / report.force_scale,
            (flux + channel.solver.flux(2)) / flux,
            channel.pressure_range() / pressure};
  }
} // namespace bed
