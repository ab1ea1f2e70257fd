// What a fluid step costs, from cutting the grains to their forces, by phase: a fixed hexagonal bed in the lower two
// thirds of a box, driven by a head that rises by 1 % a step. Also with mpirun: times are then those of the slowest
// rank.
//
//   benchmark_fluid_step [N_CELLS [H_OVER_D [DT [FILTER [N_STEPS [smooth]]]]]]      (defaults: 10000, 1, 1e-3 s, 2 d,
//   10, even)
//
// The bed is as large as the cells allow, and all of it is cut anew in every step. The flow is let establish itself
// first; then one step makes a new preconditioner ("fresh"), and the others keep it ("kept").
#include "../coupling/bed.h"

#include <alluvium/utilities/mpi_environment.h>
#include <alluvium/utilities/timers.h>

#include <cstdio>
#include <ctime>
#include <map>
#include <string>

namespace
{
  double cpu()
  {
    return double(std::clock()) / CLOCKS_PER_SEC;
  }

  /** CPU time and linear iterations of a step, and the parts of the time. */
  struct Cost
  {
    double                        total = 0., n_iterations = 0.;
    std::map<std::string, double> phases;
  };

  /** Per step, of @p n_steps with a head that rises from @p head. */
  Cost measure(bed::Channel &channel, const bed::Bed &b, const unsigned int n_steps, double &head)
  {
    Cost cost;
    channel.solver.timers = {};
    MPI_Barrier(MPI_COMM_WORLD);
    const double start = cpu();
    for (unsigned int k = 0; k < n_steps; ++k)
      {
        head *= 1.01;
        channel.set_pressure_below(head);
        channel.coupling.forget_positions();
        channel.step(b.grains, true);
        cost.n_iterations += double(channel.coupling.report().n_iterations) / n_steps;
      }
    MPI_Barrier(MPI_COMM_WORLD);
    cost.total  = (cpu() - start) / n_steps;
    double rest = cost.total;
    for (const auto &[name, phase] : channel.solver.timers.slowest(MPI_COMM_WORLD))
      {
        cost.phases[name] = phase.cpu / n_steps;
        rest -= cost.phases[name];
      }
    cost.phases["drag, forces"] = rest;
    return cost;
  }
} // namespace

int main(int argc, char **argv)
{
  const alluvium::MpiEnvironment mpi(argc, argv);
  const double                   n_cells = argc > 1 ? std::stod(argv[1]) : 1e4;
  bed::Settings                  s;
  s.h_over_d                 = argc > 2 ? std::stod(argv[2]) : 1.;
  s.dt                       = argc > 3 ? std::stod(argv[3]) : 1e-3;
  s.filter                   = argc > 4 ? std::stod(argv[4]) : 2.;
  const unsigned int n_steps = argc > 5 ? std::stoi(argv[5]) : 10;
  s.smooth                   = argc > 6 && std::string(argv[6]) == "smooth";

  const double   d = 2.2e-4, h = s.h_over_d * d;
  const double   width = h * std::round(std::sqrt(n_cells / 1.5)), height = h * std::round(1.5 * width / h);
  const bed::Bed b    = bed::hexagonal_bed(width, height / 1.5, d);
  double         head = 0.5 * 1000. * 9.81 * b.height;
  bed::Channel   channel(width, height, h, s, head);

  for (unsigned int k = 0; k < 4; ++k)
    channel.step(b.grains, true);
  channel.solver.linear_solver.clear();
  const Cost fresh = measure(channel, b, 1, head), kept = measure(channel, b, n_steps, head);

  const double cells  = channel.space.triangulation().n_global_active_cells();
  const auto   report = channel.coupling.report();
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    return 0;
  std::printf("%g cells, %u unknowns, %zu grains, %zu pieces (%.1f a cell), h/d %g, dt %g s, %u ranks\n",
              cells,
              unsigned(channel.space.n_dofs()),
              b.grains.n(),
              report.n_pieces,
              report.n_pieces / cells,
              s.h_over_d,
              s.dt,
              dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
  std::printf("%-24s %12s %12s %12s\n", "CPU time a step", "us a cell", "us a dof", "in assemblies");
  const double assembly = kept.phases.at("fluid: assembly");
  const auto   line     = [&](const char *name, const double seconds) {
    std::printf("%-24s %12.2f %12.3f %12.2f\n",
                name,
                1e6 * seconds / cells,
                1e6 * seconds / channel.space.n_dofs(),
                seconds / assembly);
  };
  for (const auto &[name, seconds] : kept.phases)
    line(name.c_str(), seconds);
  line("step", kept.total);
  line("linear solver, fresh", fresh.phases.at("fluid: linear solver"));
  std::printf("iterations: %.0f fresh, %.1f kept\n", fresh.n_iterations, kept.n_iterations);
}
