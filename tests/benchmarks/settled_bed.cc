// One settled bed, made and measured: what the table of deposits is made from.
//
//   benchmark_settled_bed --list
//       the contact solvers there are, one a line
//   benchmark_settled_bed --make N BED.csv [--set 'NAME = VALUE']...
//       settle N discs (parameters of the deposit 'settled bed') and say what it took and how still the bed is
//   benchmark_settled_bed BED.csv [--solver NAME] [--dt DT] [--time SECONDS] [--set 'NAME = VALUE']...
//       hold the bed (parameters of the contacts) and say what that costs and how exact it is
//   benchmark_settled_bed BED.csv --stay [--dt DT] [--time SECONDS] [--set 'NAME = VALUE']...
//       let the bed start at rest, without knowing any contact force, and say how far its grains move
//
// A bed is a table of grains as the deposit 'file' reads it, in a box from (0, 0) with walls left, right and below; the
// comment `# width = W` in it says how wide. Every call prints one JSON object. Held beds first take 0.01 s that does
// not count.
#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/contacts/solvers/contact_solver.h>
#include <alluvium/deposits/deposit.h>
#include <alluvium/deposits/deposit_table.h>
#include <alluvium/grains/packing.h>
#include <alluvium/utilities/plugin.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>

using namespace alluvium;
using namespace alluvium::contacts;
using namespace alluvium::deposits;
using namespace alluvium::grains;

namespace
{
  constexpr double density = 2630., gravity = 9.81, window = 1e-3, warm_up = 0.01; // SI

  double cpu_seconds()
  {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  }

  [[noreturn]] void fail(const std::string &message)
  {
    std::fprintf(stderr, "benchmark_settled_bed: %s\n", message.c_str());
    std::exit(1);
  }

  double read_width(const std::string &file)
  {
    std::ifstream in(file);
    double        width = 0.;
    for (std::string line; std::getline(in, line) && line.rfind("#", 0) == 0;)
      std::sscanf(line.c_str(), "# width = %lf", &width);
    if (!(width > 0.))
      fail(file + " has no line '# width = ...' at its top.");
    return width;
  }

  /** A bed between its walls, and what is measured on it. */
  struct Bed
  {
    GrainArrays    grains;
    GrainLoads     loads;
    ContactStepper stepper;
    double         weight = 0., diameter = 0.;

    Bed(const std::vector<NewGrain> &new_grains, const double width)
    {
      const double top = 1e3 * width;
      stepper.set_walls({{{{0., top}}, {{0., 0.}}, {{0., 0.}}, "left"},
                         {{{0., 0.}}, {{width, 0.}}, {{0., 0.}}, "bottom"},
                         {{{width, 0.}}, {{width, top}}, {{0., 0.}}, "right"}});
      grains.resize(new_grains.size());
      loads.reset(new_grains.size());
      for (std::size_t k = 0; k < new_grains.size(); ++k)
        {
          const NewGrain &s     = new_grains[k];
          grains.id[k]          = static_cast<GrainId>(k);
          grains.position[0][k] = s.x;
          grains.position[1][k] = s.y;
          grains.radius[k]      = s.radius;
          grains.mass[k]        = s.density * M_PI * s.radius * s.radius;
          loads.force[1][k]     = -grains.mass[k] * gravity;
          weight -= loads.force[1][k];
          diameter += 2. * s.radius / new_grains.size();
        }
    }

    ContactReport step(const double dt) { return stepper.advance(grains, loads, dt, {{0., -gravity}}); }

    double speed() const
    {
      double sum = 0.;
      for (std::size_t k = 0; k < grains.n(); ++k)
        sum += grains.velocity[0][k] * grains.velocity[0][k] + grains.velocity[1][k] * grains.velocity[1][k];
      return std::sqrt(sum / grains.n());
    }
  };

  double support(const ContactReport &report, const double weight)
  {
    double sum = 0.;
    for (const auto &[name, force] : report.wall_force)
      sum -= force[1];
    return sum / weight;
  }

  void make(const int n, const std::string &file, const std::string &set)
  {
    const double             width = std::ceil(std::sqrt(n)) * 1.1 * 2e-4;
    dealii::ParameterHandler prm;
    auto                     deposit = Registry<Deposit>::entries().at("settled bed").create();
    deposit->add_parameters(prm);
    prm.parse_input_from_string("set Number of grains = " + std::to_string(n) + "\nset Cache folder =\n" + set);
    DepositContext context;
    context.lower                          = {{0., 0.}};
    context.upper                          = {{width, 3. * width}};
    context.density                        = density;
    context.gravity                        = {{0., -gravity}};
    const double                start      = cpu_seconds();
    const std::vector<NewGrain> new_grains = deposit->make(context);
    const double                cpu        = cpu_seconds() - start;
    char                        text[64];
    std::snprintf(text, sizeof text, "width = %.17g", width);
    write_grain_table(file, new_grains, text);

    Bed                 bed(new_grains, width);
    const ContactReport overlaps = bed.step(1e-12); // only to measure the overlaps of the deposit as it is
    std::printf("{\"discs\": %zu, \"cpu_s\": %.3f, \"packing\": %.4f, \"mean_penetration_d\": %.2e, "
                "\"max_penetration_d\": %.2e}\n",
                new_grains.size(),
                cpu,
                inner_packing_fraction(bed.grains),
                overlaps.mean_penetration / bed.diameter,
                overlaps.max_penetration / bed.diameter);
  }

  void
  stay(const std::string &file, const std::string &solver, const double dt, const double time, const std::string &set)
  {
    Bed                      bed(read_grain_table(file, density), read_width(file));
    const GrainArrays        before = bed.grains;
    dealii::ParameterHandler prm;
    bed.stepper.add_parameters(prm);
    if (!solver.empty())
      prm.set("Contact solver", solver);
    prm.parse_input_from_string("set Steps to rest = 0\n" + set);
    const int          steps   = std::max(1, static_cast<int>(std::lround(time / dt)));
    const double       start   = cpu_seconds();
    unsigned long long sweeps  = 0;
    double             carried = 0., first = 0., lowest = 1., highest = 1.;
    for (int s = 0; s < steps; ++s)
      {
        const ContactReport report = bed.step(dt);
        const double        share  = support(report, bed.weight);
        carried += share / steps;
        lowest  = std::min(lowest, share);
        highest = std::max(highest, share);
        sweeps += report.n_sweeps;
        if (s == 0)
          first = cpu_seconds() - start;
      }
    const double seconds = cpu_seconds() - start;
    double       square = 0., farthest = 0.;
    int          n_moved = 0;
    for (std::size_t k = 0; k < before.n(); ++k)
      {
        const double moved = std::hypot(bed.grains.position[0][k] - before.position[0][k],
                                        bed.grains.position[1][k] - before.position[1][k]) /
                             bed.diameter;
        square += moved * moved;
        farthest = std::max(farthest, moved);
        n_moved += moved > 1e-3;
      }
    std::printf("{\"discs\": %zu, \"moved_rms_d\": %.2e, \"moved_farthest_d\": %.2e, \"moved_above_1e-3_d\": %d, "
                "\"support\": %.6f, \"support_lowest\": %.6f, \"support_highest\": %.6f, \"speed_over_g_dt\": %.2e, "
                "\"cpu_s\": %.3f, \"cpu_s_first_step\": %.3f, \"sweeps\": %llu}\n",
                before.n(),
                std::sqrt(square / before.n()),
                farthest,
                n_moved,
                carried,
                lowest,
                highest,
                bed.speed() / (gravity * dt),
                seconds,
                first,
                sweeps);
  }

  void
  hold(const std::string &file, const std::string &solver, const double dt, const double time, const std::string &set)
  {
    Bed                      bed(read_grain_table(file, density), read_width(file));
    dealii::ParameterHandler prm;
    bed.stepper.add_parameters(prm);
    if (!solver.empty())
      prm.set("Contact solver", solver);
    prm.parse_input_from_string(set);

    const int run_up = static_cast<int>(std::lround(warm_up / dt)), steps = static_cast<int>(std::lround(time / dt)),
              per_window      = std::max(1, static_cast<int>(std::lround(window / dt)));
    unsigned long long sweeps = 0, updates = 0;
    unsigned int       unconverged = 0, contacts = 0;
    double             mean = 0., largest = 0., seconds = 0., square = 0., carried = 0., in_window = 0., speed = 0.;
    for (int s = -run_up; s < steps; ++s)
      {
        const double        start  = cpu_seconds();
        const ContactReport report = bed.step(dt);
        if (s < 0)
          continue;
        seconds += cpu_seconds() - start;
        sweeps += report.n_sweeps;
        updates += report.n_updates;
        unconverged += report.n_unconverged;
        contacts = report.n_contacts;
        mean += report.mean_penetration / steps;
        largest            = std::max(largest, report.max_penetration);
        const double share = support(report, bed.weight);
        carried += share / steps;
        in_window += share / per_window;
        speed += bed.speed() / steps;
        if ((s + 1) % per_window == 0)
          {
            square += (in_window - 1.) * (in_window - 1.);
            in_window = 0.;
          }
      }
    std::printf(
      "{\"cpu_s_per_10_ms\": %.6g, \"mean_penetration_d\": %.4g, \"max_penetration_d\": %.4g, \"support\": %.8f, "
      "\"support_error\": %.4g, \"speed_m_per_s\": %.4g, \"sweeps_per_step\": %.4g, \"ns_per_update\": %.4g, "
      "\"unconverged\": %u, \"contacts\": %u}\n",
      seconds * 0.01 / time,
      mean / bed.diameter,
      largest / bed.diameter,
      carried,
      std::sqrt(square / (steps / per_window)),
      speed,
      double(sweeps) / steps,
      1e9 * seconds / std::max(1ull, updates),
      unconverged,
      contacts);
  }
} // namespace

int main(int argc, char **argv)
{
  std::string file, solver, set;
  double      dt = 1e-4, time = 0.05;
  int         n     = 0;
  bool        stays = false;
  for (int k = 1; k < argc; ++k)
    {
      const std::string a    = argv[k];
      const auto        next = [&]() -> std::string {
        if (k + 1 >= argc)
          fail(a + " wants a value.");
        return argv[++k];
      };
      if (a == "--list")
        {
          for (const auto &entry : Registry<ContactSolver>::entries())
            std::printf("%s\n", entry.first.c_str());
          return 0;
        }
      else if (a == "--make")
        n = std::atoi(next().c_str());
      else if (a == "--solver")
        solver = next();
      else if (a == "--stay")
        stays = true;
      else if (a == "--dt")
        dt = std::atof(next().c_str());
      else if (a == "--time")
        time = std::atof(next().c_str());
      else if (a == "--set")
        set += "set " + next() + "\n";
      else if (a[0] == '-')
        fail("there is no option " + a + ".");
      else
        file = a;
    }
  if (file.empty())
    fail("name a bed.");
  try
    {
      if (n > 0)
        make(n, file, set);
      else if (stays)
        stay(file, solver, dt, time, set);
      else
        hold(file, solver, dt, time, set);
    }
  catch (const UserError &e)
    {
      fail(e.what());
    }
}
