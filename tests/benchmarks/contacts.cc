// Cost and quality of the contact step on settled beds.
//
//   benchmark_contacts [--solver NAME] [--time SECONDS] [--dt DT]... [--shake V] [--fluidise A] [--kick V] [--set 'NAME
//   = VALUE']... [--set 'SECTION/NAME = VALUE']... [--cold] [--search] [BED.bin]...
//
// Without beds it settles its own, of 2,000 and 10,000 discs. A bed file is int32 N, double width, then N rows of x y
// radius vx vy spin * radius; its walls are x = 0, x = width and y = 0. --shake gives every grain a random velocity up
// to V m/s at the start of every millisecond: the worst case. --fluidise A carries all grains with drag (relaxation
// time 1 ms) and moves them up and down with a wave of A times their weight, as a fluidised bed would.
// --kick V gives one grain in twenty a velocity of V m/s at the start.
// --cold shows how one step from zero velocities and unknown impulses converges, against CPU time in units of one plain
// sweep.
// --search tells what a contact search costs, with known impulses, and how much of it is looking for pairs.
// With mpirun, ranks share the work; each tells what it computed and sent. Alone, the first bed also tells the memory.
#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/contacts/search/contact_neighbours.h>
#include <alluvium/deposits/deposit.h>
#include <alluvium/utilities/mpi_environment.h>
#include <alluvium/utilities/plugin.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <random>
#include <string>

#include <sys/resource.h>

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::deposits;
using namespace alluvium::grains;

namespace
{
  constexpr double density = 2630., gravity = 9.81;

  double seconds_in_mpi = 0.; // CPU time

  /** The most memory that the program had up to now [kB]. */
  double peak_memory()
  {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  }

  struct Bed
  {
    std::string name;
    double      width = 0.;
    GrainArrays grains;

    void add(const double x, const double y, const double r, const double vx, const double vy, const double omega)
    {
      const std::size_t k = grains.n();
      grains.resize(k + 1);
      grains.id[k]          = k;
      grains.position[0][k] = x;
      grains.position[1][k] = y;
      grains.radius[k]      = r;
      grains.mass[k]        = density * M_PI * r * r;
      grains.velocity[0][k] = vx;
      grains.velocity[1][k] = vy;
      grains.omega[k]       = omega;
    }
  };

  double cpu_seconds()
  {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  }

  Bed read_bed(const std::string &file)
  {
    std::ifstream in(file, std::ios::binary);
    Bed           bed;
    bed.name       = file.substr(file.rfind('/') + 1);
    std::int32_t n = 0;
    in.read(reinterpret_cast<char *>(&n), sizeof n);
    in.read(reinterpret_cast<char *>(&bed.width), sizeof bed.width);
    for (std::int32_t k = 0; k < n; ++k)
      {
        double row[6];
        in.read(reinterpret_cast<char *>(row), sizeof row);
        bed.add(row[0], row[1], row[2], row[3], row[4], row[5] / row[2]);
      }
    if (!in)
      {
        std::fprintf(stderr, "%s is no bed\n", file.c_str());
        std::exit(1);
      }
    return bed;
  }

  Bed settle_bed(const int n)
  {
    Bed bed;
    bed.name  = "own " + std::to_string(n);
    bed.width = std::ceil(std::sqrt(n)) * 1.1 * 2e-4;
    dealii::ParameterHandler prm;
    auto                     deposit = Registry<Deposit>::entries().at("settled bed").create();
    deposit->add_parameters(prm);
    prm.parse_input_from_string("set Number of grains = " + std::to_string(n) + "\nset Cache folder =\n");
    DepositContext context;
    context.lower   = {{0., 0.}};
    context.upper   = {{bed.width, 3. * bed.width}};
    context.density = density;
    context.gravity = {{0., -gravity}};
    const double t  = cpu_seconds();
    for (const NewGrain &s : deposit->make(context))
      bed.add(s.x, s.y, s.radius, s.vx, s.vy, s.omega);
    std::printf("settled %zu discs in %.2f s CPU\n", bed.grains.n(), cpu_seconds() - t);
    return bed;
  }

  std::vector<WallSegment> walls_of(const Bed &bed)
  {
    const double w = bed.width, h = 1e3 * w;
    return {{{{0., h}}, {{0., 0.}}, {{0., 0.}}, "left"},
            {{{0., 0.}}, {{w, 0.}}, {{0., 0.}}, "bottom"},
            {{{w, 0.}}, {{w, h}}, {{0., 0.}}, "right"}};
  }

  void measure(const Bed         &bed,
               const std::string &solver,
               const double       dt,
               const double       time,
               const double       shake,
               const double       fluidise,
               const double       kick,
               const std::string &set)
  {
    GrainArrays              g = bed.grains;
    ContactStepper           stepper;
    dealii::ParameterHandler prm;
    stepper.add_parameters(prm);
    prm.set("Contact solver", solver);
    prm.parse_input_from_string(set);
    const double w = bed.width;
    stepper.set_walls(walls_of(bed));
    stepper.set_communicator(MPI_COMM_WORLD);
    GrainLoads loads;
    loads.reset(g.n());
    double weight = 0., diameter = 0., mpi_before = 0.;
    for (std::size_t k = 0; k < g.n(); ++k)
      {
        loads.force[1][k] = -g.mass[k] * gravity;
        weight += g.mass[k] * gravity;
        diameter += 2. * g.radius[k] / g.n();
      }

    std::mt19937_64 random(1);
    const int       steps = static_cast<int>(std::lround(time / dt)), every = std::max(1, static_cast<int>(1e-3 / dt));
    unsigned long long sweeps = 0, updates = 0;
    unsigned int       halvings = 0, unconverged = 0, substeps = 0;
    double             mean = 0., largest = 0., support = 0., seconds = 0., wall = 0.;
    ContactReport      first, report;
    ContactTraffic     before;
    for (int s = -1; s < steps; ++s) // the first step starts cold and does not count
      {
        if (shake > 0. && s >= 0 && s % every == 0)
          for (std::size_t k = 0; k < g.n(); ++k)
            {
              g.velocity[0][k] = shake * (2. * (random() >> 11) * 0x1p-53 - 1.);
              g.velocity[1][k] = shake * (2. * (random() >> 11) * 0x1p-53 - 1.);
            }
        if (kick > 0. && s == 0)
          for (std::size_t k = 0; k < g.n(); ++k)
            if (random() % 20 == 0)
              {
                const double angle = 2. * M_PI * (random() >> 11) * 0x1p-53;
                g.velocity[0][k]   = kick * std::cos(angle);
                g.velocity[1][k]   = kick * std::sin(angle);
              }
        if (fluidise > 0. && s >= 0)
          for (std::size_t k = 0; k < g.n(); ++k)
            {
              const double wave = std::sin(4. * M_PI * g.position[0][k] / w + 20. * s * dt);
              loads.drag[k]     = g.mass[k] / 1e-3;
              loads.force[1][k] = g.mass[k] * gravity * fluidise * wave;
            }
        const double t = cpu_seconds(), t_wall = MPI_Wtime();
        report = stepper.advance(g, loads, dt, {{0., -gravity}});
        if (s < 0)
          {
            first      = report;
            before     = stepper.traffic();
            mpi_before = seconds_in_mpi;
            continue;
          }
        seconds += cpu_seconds() - t;
        wall += MPI_Wtime() - t_wall;
        sweeps += report.n_sweeps;
        updates += report.n_updates;
        halvings += report.n_halvings;
        unconverged += report.n_unconverged;
        substeps += report.n_substeps;
        mean += report.mean_penetration / steps;
        largest  = std::max(largest, report.max_penetration);
        double f = 0.;
        for (const auto &[name, force] : report.wall_force)
          f -= force[1];
        support += f / weight / steps;
      }
    int n_ranks, rank;
    MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    {
      // Waiting for other ranks takes CPU time, and on shared cores any time: what a rank computes is the rest.
      const ContactTraffic t    = stepper.traffic();
      std::uint64_t        bits = 0;
      for (const auto *v : {&g.position[0],
                            &g.position[1],
                            &g.velocity[0],
                            &g.velocity[1],
                            &g.omega,
                            &g.contact_force[0],
                            &g.contact_force[1]})
        for (const double value : *v)
          {
            std::uint64_t word;
            std::memcpy(&word, &value, sizeof word);
            bits = (bits ^ word) * 0x9e3779b97f4a7c15ull;
          }
      std::printf("rank %d of %d: wall %.3f s, CPU %.3f s, of which in MPI %.3f s; in MPI %.3f s wall; a sweep: %.1f "
                  "messages, %.0f bytes, %.1f "
                  "reductions; %llu grains came from others; bits of the end state %016llx\n",
                  rank,
                  n_ranks,
                  wall,
                  seconds,
                  seconds_in_mpi - mpi_before,
                  t.seconds - before.seconds,
                  double(t.n_messages - before.n_messages) / sweeps,
                  double(t.n_bytes - before.n_bytes) / sweeps,
                  double(t.n_reductions - before.n_reductions) / sweeps,
                  t.n_migrated - before.n_migrated,
                  static_cast<unsigned long long>(bits));
    }
    if (rank != 0)
      return;
    std::printf(
      "%-20s dt %.0e: cold %5llu sweeps; then sweeps/step %7.1f  ns/update %5.1f  CPU/0.01 s %.4f s  ms/step %.3f  "
      "mean pen/d %.1e  max %.1e  support %.6f  vmax/gdt %.1e  contacts %u substeps %u halvings %u unconverged %u\n",
      bed.name.c_str(),
      dt,
      first.n_sweeps,
      double(sweeps) / steps,
      1e9 * seconds / std::max(1ull, updates),
      seconds * 0.01 / time,
      1e3 * seconds / steps,
      mean / diameter,
      largest / diameter,
      support,
      report.max_velocity / (gravity * dt),
      report.n_contacts,
      substeps,
      halvings,
      unconverged);
  }

  /** Search again and again, as if grains had moved. */
  void measure_search(const Bed &bed, const double skin)
  {
    const GrainArrays &g = bed.grains;
    ContactGeometry    geometry;
    geometry.walls.set(walls_of(bed));
    const double      reach = 2. * skin * *std::max_element(g.radius.begin(), g.radius.end());
    ContactNeighbours neighbours;
    neighbours.search(g, geometry, reach);
    std::size_t n_contacts = 0;
    for (auto *list : {&neighbours.pairs.discs, &neighbours.pairs.walls})
      for (ContactPair &p : *list)
        {
          ContactPoint point;
          const double gap = list == &neighbours.pairs.discs ? touch(g, geometry.periodicity, p.i, p.j).gap
                             : geometry.walls.touch(p.j, g.position[0][p.i], g.position[1][p.i], g.radius[p.i], point)
                               ? point.gap
                               : reach;
          if (gap < 1e-3 * g.radius[p.i])
            {
              p.rn = 1.;
              ++n_contacts;
            }
        }
    const std::size_t n_pairs = neighbours.pairs.discs.size() + neighbours.pairs.walls.size();
    const int         n_times = 5 + 500000 / g.n();
    double            t       = cpu_seconds();
    for (int k = 0; k < n_times; ++k)
      find_candidates(g, geometry, reach);
    const double finding = (cpu_seconds() - t) / n_times;
    t                    = cpu_seconds();
    for (int k = 0; k < n_times; ++k)
      neighbours.search(g, geometry, reach);
    const double all = (cpu_seconds() - t) / n_times;
    std::printf("%s skin %.2f d: %zu contacts, %zu pairs; a search %.3f ms: finding pairs %.1f ns a contact (%.1f a "
                "pair), with colours and impulses %.1f (%.1f)\n",
                bed.name.c_str(),
                skin,
                n_contacts,
                n_pairs,
                1e3 * all,
                1e9 * finding / n_contacts,
                1e9 * finding / n_pairs,
                1e9 * all / n_contacts,
                1e9 * all / n_pairs);
  }

  struct ColdRun
  {
    double        seconds, support, velocity;
    ContactReport report;
  };

  /** One step from zero velocities and impulses that ends after so many sweeps. */
  ColdRun run_cold(const Bed &bed, const std::string &solver, const double dt, const std::string &set, const int sweeps)
  {
    GrainArrays g = bed.grains;
    for (auto *v : {&g.velocity[0], &g.velocity[1], &g.omega})
      std::fill(v->begin(), v->end(), 0.);
    ContactStepper           stepper;
    dealii::ParameterHandler prm;
    stepper.add_parameters(prm);
    prm.set("Contact solver", solver);
    prm.set("Largest number of halvings", "0");
    prm.set("Largest number of sweeps", std::to_string(sweeps));
    prm.set("Stagnation tolerance factor", "1");
    prm.set("Overlap correction", "0"); // opening overlaps would lift the bed, and the floor carry more than its weight
    prm.parse_input_from_string(set);
    stepper.set_walls(walls_of(bed));
    GrainLoads loads;
    loads.reset(g.n());
    double weight = 0.;
    for (std::size_t k = 0; k < g.n(); ++k)
      {
        loads.force[1][k] = -g.mass[k] * gravity;
        weight += g.mass[k] * gravity;
      }
    const double t = cpu_seconds();
    ColdRun      run;
    run.report  = stepper.advance(g, loads, dt, {{0., -gravity}});
    run.seconds = cpu_seconds() - t;
    double sum  = 0.;
    for (std::size_t k = 0; k < g.n(); ++k)
      sum += g.velocity[0][k] * g.velocity[0][k] + g.velocity[1][k] * g.velocity[1][k];
    run.velocity = std::sqrt(sum / g.n()) / (gravity * dt);
    run.support  = 0.;
    for (const auto &[name, force] : run.report.wall_force)
      run.support -= force[1] / weight;
    return run;
  }

  void measure_cold(const Bed &bed, const std::string &solver, const double dt, const std::string &set)
  {
    // What a step costs besides sweeps: two runs of plain sweeps of different lengths tell.
    const std::string plain = set + "set Hydrostatic initial guess = false\n";
    const ColdRun     few   = run_cold(bed, "Gauss-Seidel", dt, plain, 20),
                  more      = run_cold(bed, "Gauss-Seidel", dt, plain, 420);
    const double sweep = (more.seconds - few.seconds) / 400., rest = std::max(0., few.seconds - 20. * sweep);
    std::printf("%s dt %.0e: a plain sweep %.3f ms, %.1f ns a contact; all else in a step as long as %.0f sweeps\n"
                "  sweeps  sweep-equivalents  of the weight on walls  residual  violation  rms velocity / g dt\n",
                bed.name.c_str(),
                dt,
                1e3 * sweep,
                1e9 * sweep * 20. / few.report.n_updates,
                rest / sweep);
    for (const int sweeps : {25, 50, 75, 100, 150, 200, 300, 400, 550, 700, 850, 1000, 1500, 2000, 3000})
      {
        const ColdRun run = run_cold(bed, solver, dt, set, sweeps);
        std::printf("  %6llu  %17.0f  %22.4f  %.2e   %.2e  %.3e%s\n",
                    run.report.n_sweeps,
                    (run.seconds - rest) / sweep,
                    run.support,
                    run.report.residual,
                    run.report.violation,
                    run.velocity,
                    run.report.n_unconverged == 0 ? "  converged" : "");
        if (run.report.n_unconverged == 0)
          break;
      }
  }
} // namespace

// MPI's own interface for profiling: what ranks spend on messages, waiting for each other included.
#define TIMED(call)                                                                                                    \
  const double t      = cpu_seconds();                                                                                 \
  const int    result = call;                                                                                          \
  seconds_in_mpi += cpu_seconds() - t;                                                                                 \
  return result;

extern "C" {
int MPI_Waitall(int n, MPI_Request requests[], MPI_Status *statuses)
{
  TIMED(PMPI_Waitall(n, requests, statuses))
}

int MPI_Isend(const void *data, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request *request)
{
  TIMED(PMPI_Isend(data, n, type, to, tag, comm, request))
}

int MPI_Irecv(void *data, int n, MPI_Datatype type, int from, int tag, MPI_Comm comm, MPI_Request *request)
{
  TIMED(PMPI_Irecv(data, n, type, from, tag, comm, request))
}

int MPI_Allreduce(const void *from, void *to, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm)
{
  TIMED(PMPI_Allreduce(from, to, n, type, op, comm))
}

int MPI_Allgatherv(const void  *from,
                   int          n,
                   MPI_Datatype from_type,
                   void        *to,
                   const int    counts[],
                   const int    offsets[],
                   MPI_Datatype to_type,
                   MPI_Comm     comm)
{
  TIMED(PMPI_Allgatherv(from, n, from_type, to, counts, offsets, to_type, comm))
}
}

int main(int argc, char **argv)
{
  const alluvium::MpiEnvironment mpi(argc, argv);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::string         solver = "accelerated Gauss-Seidel";
  double              time = 0.05, shake = 0., fluidise = 0., kick = 0.;
  std::string         set;
  bool                cold = false, search = false;
  std::vector<double> dts;
  std::vector<Bed>    beds;
  for (int k = 1; k < argc; ++k)
    {
      const std::string a = argv[k];
      if (a == "--solver" && k + 1 < argc)
        solver = argv[++k];
      else if (a == "--time" && k + 1 < argc)
        time = std::atof(argv[++k]);
      else if (a == "--dt" && k + 1 < argc)
        dts.push_back(std::atof(argv[++k]));
      else if (a == "--set" && k + 1 < argc)
        {
          // "Section/Name = value" is a parameter of a subsection.
          const std::string text = argv[++k];
          const std::size_t cut  = text.find('/');
          if (cut == std::string::npos)
            set += "set " + text + "\n";
          else
            set += "subsection " + text.substr(0, cut) + "\nset " + text.substr(cut + 1) + "\nend\n";
        }
      else if (a == "--fluidise" && k + 1 < argc)
        fluidise = std::atof(argv[++k]);
      else if (a == "--cold")
        cold = true;
      else if (a == "--search")
        search = true;
      else if (a == "--kick" && k + 1 < argc)
        kick = std::atof(argv[++k]);
      else if (a == "--shake" && k + 1 < argc)
        shake = std::atof(argv[++k]);
      else
        beds.push_back(read_bed(a));
    }
  if (beds.empty())
    for (const int n : {2000, 10000})
      beds.push_back(settle_bed(n));
  if (dts.empty())
    dts = {1e-4, 1e-3};
  const double empty = peak_memory();
  for (const Bed &bed : beds)
    if (search)
      measure_search(bed, 0.15);
    else
      for (const double dt : dts)
        {
          if (cold)
            measure_cold(bed, solver, dt, set);
          else
            measure(bed, solver, dt, time, shake, fluidise, kick, set);
          if (&bed == &beds.front() && dt == dts.front())
            std::printf("peak memory %.3f kB a disc, grains included\n", (peak_memory() - empty) / bed.grains.n());
        }
}
