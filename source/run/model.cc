#include <alluvium/run/model.h>
#include <alluvium/utilities/magnitudes.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/grid/tria.h>

#include <cmath>

namespace alluvium::run
{
  using namespace dealii;

  Model::Model(MPI_Comm communicator)
    : communicator(communicator)
    , is_root(Utilities::MPI::this_mpi_process(communicator) == 0)
    , solver(space)
    , coupling(space, solver)
    , store(communicator)
    , warnings(is_root)
    , coupled_step(solver, coupling, contacts, timers)
  {}


  void Model::add_parameters(ParameterHandler &prm)
  {
    constexpr double g = magnitudes::largest_acceleration;
    prm.add_parameter("Gravity",
                      gravity_text,
                      "Acceleration of gravity, x and y [m/s^2].",
                      Patterns::List(Patterns::Double(-g, g), 2, 2));
    prm.enter_subsection("Fluid");
    prm.add_parameter(
      "Model",
      fluid_model,
      "`volume-averaged`: the volume-averaged Navier-Stokes equations between and around the grains; `none`: dry "
      "grains, for which no mesh and no matrix is made.",
      Patterns::Selection("volume-averaged|none"));
    prm.leave_subsection();
    domain.add_parameters(prm);
    adaptivity.add_parameters(prm);
    solver.add_parameters(prm);
    boundary_conditions.add_parameters(prm);
    coupling.add_parameters(prm);
    grain_setup.add_parameters(prm);
    prm.enter_subsection("Contacts");
    contacts.add_parameters(prm);
    prm.leave_subsection();
  }


  void Model::parse_parameters()
  {
    const auto g = Utilities::string_to_double(Utilities::split_string_list(gravity_text));
    for (unsigned int d = 0; d < dim; ++d)
      solver.gravity[d] = gravity[d] = g[d];
    has_fluid   = fluid_model != "none";
    grains_move = !grain_setup.fixed();
    grain_setup.parse_parameters();
    contacts.parse_parameters();
    coupling.parse_parameters();
    if (!has_fluid)
      return;
    adaptivity.parse_parameters();
    boundary_conditions.parse_parameters();
  }


  double Model::gravity_size() const
  {
    return std::hypot(gravity[0], gravity[1]);
  }


  refinement::RefinementContext Model::refinement_context() const
  {
    const auto length  = domain.periodicity().length;
    auto       context = refinement::make_refinement_context(
      grains, {{{domain.lower()[0], domain.lower()[1]}}, {{domain.upper()[0], domain.upper()[1]}}}, upright());
    context.periodic         = {{length[0] > 0., length[1] > 0.}};
    context.initial_diameter = initial_diameter;
    if (grain_setup.unit_length() > 0.)
      context.grain_diameter = initial_diameter;
    context.time    = time;
    context.gravity = gravity_size();
    return context;
  }


  void Model::drop_caches()
  {
    contacts.forget_search();
    if (!has_fluid)
      return;
    solver.linear_solver.clear();
    coupling.reinit();
  }
} // namespace alluvium::run
