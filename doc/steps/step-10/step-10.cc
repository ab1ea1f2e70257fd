// A time loop of one's own from Alluvium's library: a closed box of water and grains that is turned about.
//
//   step-10 grains.csv statistics.csv TURNS [END]
//
// The box makes TURNS turns a second for END seconds (default: 0.4), anticlockwise. Seen from the box it stands still,
// and gravity turns: that is what no parameter file of the program can say. With TURNS = 0 it is the scene box.prm, and
// must give what the program gives. grains.csv is written for that: the grains at the start; statistics.csv-1 to -4 are
// those at quarters of the time. Runs on any number of ranks.

#include <alluvium/coupling/contact_iteration.h>
#include <alluvium/coupling/coupling.h>
#include <alluvium/fluid/boundary_conditions.h>
#include <alluvium/fluid/fluid_space.h>
#include <alluvium/fluid/vans_solver.h>
#include <alluvium/output/statistics.h>
#include <alluvium/utilities/failure.h>
#include <alluvium/utilities/mpi_environment.h>
#include <alluvium/utilities/timers.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

using namespace alluvium;
using namespace dealii;

// The box and what is in it, in SI units.
constexpr double       width = 0.01, height = 0.02; // of the box
constexpr double       diameter = 5e-4, density = 2630.;
constexpr unsigned int n_cells_across = 10; // cells of two diameters
constexpr double       dt             = 1e-3;
constexpr double       g              = 9.81;

// A block of grains on the floor, in rows that are a little apart. Everyone who computes with grains gets these plain
// arrays; a disc has one radius for what touches it and one for what the water sees.
grains::GrainArrays block_of_grains()
{
  grains::GrainArrays grains;
  const double        spacing = 1.05 * diameter;
  for (unsigned int row = 0; row < 12; ++row)
    for (unsigned int column = 0; column < 18; ++column)
      {
        const std::size_t k = grains.n();
        grains.resize(k + 1); // new ones have zeros: velocities, forces
        grains.id[k]           = k;
        grains.radius[k]       = 0.5 * diameter;
        grains.mass[k]         = grains::disc_mass(density, grains.radius[k]);
        grains.position[0][k]  = (column + 0.75 + 0.3 * (row % 2)) * spacing;
        grains.position[1][k]  = (row + 0.55) * spacing;
        grains.fluid_radius[k] = 0.8 * grains.radius[k]; // packed 0.84, discs would let no water through: see step 1
      }
  grains.initial_position = grains.position;
  return grains;
}

// With all digits, so that the program reads the same numbers.
void write_grains(const grains::GrainArrays &grains, const std::string &name)
{
  std::FILE *file = std::fopen(name.c_str(), "w");
  check_user(file != nullptr, "The file '" + name + "' cannot be written.");
  std::fprintf(file, "x,y,radius\n");
  for (std::size_t k = 0; k < grains.n(); ++k)
    std::fprintf(file, "%.17g,%.17g,%.17g\n", grains.position[0][k], grains.position[1][k], grains.radius[k]);
  std::fclose(file);
}

// Everything that takes part, in the order in which it depends on what stands above it. Members refer to each other, so
// it stays where it is.
class Box
{
public:
  Box()
    : solver(space)
    , coupling(space, solver)
    , iteration(coupling, contacts, timers)
    , grains(block_of_grains())
    , touched(grains.n(), 0)
  {
    make_mesh();
    set_parameters();
    set_conditions(); // walls are checked against the parameters of contacts

    // Numbers the unknowns, then makes matrices and the overlap map that belong to them: once for each mesh.
    space.attach(mesh);
    space.reinit(conditions);
    solver.reinit();
    coupling.reinit();
  }

  // One step to `time`. It is step 1 to 6 of doc/developer/architecture.md, "A step", for a mesh that stays and steps
  // of one length.
  void step(const double time, const Tensor<1, 2> &gravity)
  {
    // u^n is what the last step has found. Before this line its fluxes and forces can be asked for.
    solver.accept();

    // The fluid's pressure is the reduced one, p - rho g.x: gravity may turn without a change of it, as long as all
    // density is the fluid's. So the hydrostatic pressure turns along at once, as it does in water that cannot be
    // compressed.
    solver.gravity = gravity;
    conditions.set_time(time);

    // Cuts the grains, finds void fraction and drag, solves the fluid with the velocities that the grains are going to
    // have, as far as that is known without contacts, and says what acts on each grain: `loads`. Grains that are fixed
    // would stay where they are whatever acts on them.
    const bool fixed = false;
    coupling.step(conditions, grains, touched, dt, fixed, loads);

    // Weight is among the loads. Contacts ask for gravity only to know what is a small force. Where contacts keep
    // grains from the velocities that the fluid has seen, the time scheme may ask for another round of both; iteration
    // does that.
    contacts.set_time(time - dt);
    report  = iteration.advance(grains, loads, dt, {{gravity[0], gravity[1]}});
    touched = contacts.touched();
  }

  // What the grains have of kinetic energy [J/m], rotation included, and how high their centre of mass is along `up`
  // [m].
  double kinetic_energy() const
  {
    double sum = 0.;
    for (std::size_t k = 0; k < grains.n(); ++k)
      sum += 0.5 * grains.mass[k] *
               (grains.velocity[0][k] * grains.velocity[0][k] + grains.velocity[1][k] * grains.velocity[1][k]) +
             0.5 * grains::disc_inertia(grains.mass[k], grains.radius[k]) * grains.omega[k] * grains.omega[k];
    return sum;
  }

  double height_along(const Tensor<1, 2> &up) const
  {
    double sum = 0., mass = 0.;
    for (std::size_t k = 0; k < grains.n(); ++k)
      {
        sum += grains.mass[k] *
               (up[0] * (grains.position[0][k] - 0.5 * width) + up[1] * (grains.position[1][k] - 0.5 * height));
        mass += grains.mass[k];
      }
    return sum / mass;
  }

  double largest_fluid_velocity() const
  {
    // Block 0 is the velocity, with its components interleaved; each rank owns some of it.
    const auto &u       = solver.solution().block(0);
    double      largest = 0.;
    for (unsigned int i = 0; i + 1 < u.locally_owned_size(); i += 2)
      largest = std::max(largest, std::hypot(u.local_element(i), u.local_element(i + 1)));
    return Utilities::MPI::max(largest, MPI_COMM_WORLD);
  }

  const grains::GrainArrays     &all_grains() const { return grains; }
  const contacts::ContactReport &contact_report() const { return report; }

private:
  // Any triangulation of deal.II will do, of quadrilaterals or of triangles; one that is distributed lets ranks share
  // it. `true` gives the sides ids 0 to 3.
  void make_mesh()
  {
    GridGenerator::subdivided_hyper_rectangle(
      mesh, {n_cells_across, 2 * n_cells_across}, Point<2>(), Point<2>(width, height), true);
  }

  // Water and grains have walls of their own kind each. Those of the fluid are boundaries of the mesh; those of the
  // grains are segments from one point to another, solid on both sides, with a velocity and a name. In a closed box the
  // pressure is known up to a constant only.
  void set_conditions()
  {
    const auto        no_slip = fluid::boundary_kind<2>("No-slip walls");
    const std::string names[] = {"left", "right", "bottom", "top"};
    for (unsigned int id = 0; id < 4; ++id)
      conditions.set(id, {no_slip, names[id], nullptr});
    conditions.pin(true);
    contacts.set_walls({{{{0., height}}, {{0., 0.}}, {}, "left"},
                        {{{width, 0.}}, {{width, height}}, {}, "right"},
                        {{{0., 0.}}, {{width, 0.}}, {}, "bottom"},
                        {{{width, height}}, {{0., height}}, {}, "top"}});
    contacts.set_communicator(MPI_COMM_WORLD);
  }

  // The library's classes declare the program's parameters, and have its defaults when that is done. What one wants
  // otherwise is set by name, as in a scene; some of it by a member, which is shorter.
  void set_parameters()
  {
    ParameterHandler prm;
    solver.add_parameters(prm); // fluid and coupling enter their sections by themselves, contacts take the present one
    coupling.add_parameters(prm);
    prm.enter_subsection("Contacts");
    contacts.add_parameters(prm);
    prm.set("Friction coefficient", 0.4);
    prm.set("Wall friction coefficient", 0.4);
    prm.leave_subsection();
    prm.enter_subsection("Coupling");
    prm.set("Drag law", "disc");
    prm.leave_subsection();
    // When all is set: what depends on several parameters, and plug-ins by their names.
    contacts.parse_parameters();
    coupling.parse_parameters();
    solver.properties.density   = 1000.;
    solver.properties.viscosity = 1e-3;
  }

  parallel::distributed::Triangulation<2> mesh{MPI_COMM_WORLD};
  fluid::BoundaryConditions<2>            conditions;
  fluid::FluidSpace<2>                    space;
  fluid::VansSolver<2>                    solver;
  coupling::Coupling                      coupling;
  contacts::ContactStepper                contacts;
  Timers                                  timers;
  coupling::ContactIteration              iteration;

  grains::GrainArrays       grains;  // the same on all ranks, before and after a step
  std::vector<std::uint8_t> touched; // which had a contact in the last step: those do not move as they would alone
  grains::GrainLoads        loads;
  contacts::ContactReport   report;
};

void run(const std::vector<std::string> &arguments)
{
  const double turns = std::stod(arguments.at(2)), end = arguments.size() > 3 ? std::stod(arguments[3]) : 0.4;
  const bool   is_first_rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  Box          box;
  if (is_first_rank)
    write_grains(box.all_grains(), arguments[0]);

  output::Statistics statistics(arguments[1], MPI_COMM_WORLD);
  for (const std::string column :
       {"time_s", "kinetic_energy_J_per_m", "largest_fluid_velocity_m_per_s", "height_m", "contacts"})
    statistics.add_column(column);

  const auto n_steps = static_cast<unsigned int>(std::lround(end / dt));
  for (unsigned int n = 1; n <= n_steps; ++n)
    {
      // In the middle of the step, as the force of a step is a mean over it. Coriolis and centrifugal forces are left
      // out; they are as 4 pi turns v and (2 pi turns)^2 r to g.
      const double       time = n * dt, angle = 2. * numbers::PI * turns * (time - 0.5 * dt);
      const Tensor<1, 2> up({std::sin(angle), std::cos(angle)});
      box.step(time, -g * up);

      statistics.set("time_s", time);
      statistics.set("kinetic_energy_J_per_m", box.kinetic_energy());
      statistics.set("largest_fluid_velocity_m_per_s", box.largest_fluid_velocity());
      statistics.set("height_m", box.height_along(up));
      statistics.set("contacts", double(box.contact_report().n_contacts));
      statistics.write_row();
      if (is_first_rank && 4 * n % n_steps == 0) // for pictures
        write_grains(box.all_grains(), arguments[1] + "-" + std::to_string(4 * n / n_steps));
    }
}

int main(int argc, char **argv)
{
  const MpiEnvironment           mpi(argc, argv); // starts MPI, and what deal.II needs of it
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() < 3)
    {
      std::cerr << "step-10 grains.csv statistics.csv TURNS [END]" << std::endl;
      return 1;
    }
  // The library throws UserError for mistakes in its input and Divergence if a run comes to nothing.
  try
    {
      run(arguments);
    }
  catch (...)
    {
      std::cerr << "step-10: " << describe_failure(std::current_exception()).message << std::endl;
      return 1;
    }
  return 0;
}
