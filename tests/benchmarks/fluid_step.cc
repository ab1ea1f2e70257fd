// What a fluid step costs, by phase: a fixed hexagonal bed in the lower two thirds of a box, driven by a head.
//
//   benchmark_fluid_step [N_CELLS [H_OVER_D [DT [FILTER]]]]      (defaults: 10000, 1, 1e-3 s, 2 d)
//
// The bed is as large as the cells allow. The first step is left out of the means but for the preconditioner that it
// makes.
#include "../coupling/bed.h"

#include <alluvium/utilities/timers.h>

#include <cstdio>
#include <ctime>

namespace
{
  bed::Bed hexagonal_bed(const double width, const double height, const double d)
  {
    bed::Bed   result;
    const auto rows = static_cast<unsigned int>(height / (d * std::sqrt(0.75)));
    for (unsigned int j = 0; j < rows; ++j)
      for (double x = (0.5 + 0.5 * (j % 2)) * d; x < width - 0.4 * d; x += d)
        {
          auto &g = result.grains;
          g.resize(g.n() + 1);
          g.id.back()           = g.n() - 1;
          g.x.back()            = x;
          g.y.back()            = (0.5 + j * std::sqrt(0.75)) * d;
          g.radius.back()       = 0.5 * d;
          g.fluid_radius.back() = 0.5 * d * std::sqrt(0.52 / 0.9069);
          g.mass.back()         = 2630. * M_PI * 0.25 * d * d;
        }
    result.width = width, result.height = height, result.d = d;
    return result;
  }

  double cpu()
  {
    return double(std::clock()) / CLOCKS_PER_SEC;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const double                             n_cells = argc > 1 ? std::stod(argv[1]) : 1e4;
  bed::Settings                            s;
  s.h_over_d       = argc > 2 ? std::stod(argv[2]) : 1.;
  s.dt             = argc > 3 ? std::stod(argv[3]) : 1e-3;
  s.filter         = argc > 4 ? std::stod(argv[4]) : 2.;
  const double   d = 2.2e-4, h = s.h_over_d * d;
  const double   width = h * std::round(std::sqrt(n_cells / 1.5)), height = h * std::round(1.5 * width / h);
  const bed::Bed b = hexagonal_bed(width, height / 1.5, d);
  bed::Channel   channel(width, height, h, s, 0.5 * 1000. * 9.81 * b.height);

  channel.step(b.grains, true);
  const double fresh_solve        = channel.solver.timers.all().at("fluid: linear solver").cpu;
  const auto   first              = channel.solver.last_report().n_iterations;
  channel.solver.timers           = {};
  const unsigned int n_steps      = n_cells > 1e5 ? 5 : 10;
  unsigned int       n_iterations = 0;
  const double       start        = cpu();
  for (unsigned int k = 0; k < n_steps; ++k)
    {
      channel.step(b.grains, true);
      n_iterations += channel.coupling.report().n_iterations;
    }
  const double total = (cpu() - start) / n_steps;

  const double cells  = channel.space.triangulation().n_global_active_cells();
  const auto   report = channel.coupling.report();
  std::printf("%g cells, %u unknowns, %zu grains, %zu pieces (%.1f a cell), h/d %g, dt %g s\n",
              cells,
              unsigned(channel.space.n_dofs()),
              b.grains.n(),
              report.n_pieces,
              report.n_pieces / cells,
              s.h_over_d,
              s.dt);
  std::printf("%-24s %12s %12s\n", "CPU time a step", "us a cell", "us a dof");
  const auto line = [&](const char *name, const double seconds) {
    std::printf("%-24s %12.2f %12.2f\n", name, 1e6 * seconds / cells, 1e6 * seconds / channel.space.n_dofs());
  };
  double rest = total;
  for (const auto &[name, phase] : channel.solver.timers.all())
    {
      line(name.c_str(), phase.cpu / n_steps);
      rest -= phase.cpu / n_steps;
    }
  line("drag, forces", rest);
  line("step", total);
  line("first linear solve", fresh_solve);
  std::printf("iterations: %u fresh, %.1f a step kept\n", first, double(n_iterations) / n_steps);
}
