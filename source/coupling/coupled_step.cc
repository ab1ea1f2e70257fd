#include <alluvium/coupling/coupled_step.h>
#include <alluvium/fluid/vans_solver.h>

namespace alluvium::coupling
{
  CoupledStep::CoupledStep(fluid::VansSolver<2>     &solver,
                           Coupling                 &coupling,
                           contacts::ContactStepper &contacts,
                           Timers                   &timers)
    : solver(solver)
    , coupling(coupling)
    , contacts(contacts)
    , timers(timers)
    , contact_iteration(coupling, contacts, timers)
  {}


  void CoupledStep::prepare()
  {
    solver.accept();
  }


  bool CoupledStep::step(const fluid::BoundaryConditions<2> &boundary_conditions,
                         const Interval                     &interval,
                         const std::vector<std::uint8_t>    &touched,
                         grains::GrainArrays                &grains,
                         grains::GrainLoads                 &loads,
                         contacts::ContactReport            &report,
                         const std::function<bool()>        &accepts)
  {
    {
      const auto timer = timers.scope("fluid");
      coupling.step(boundary_conditions, grains, touched, interval.dt, interval.fixed, loads);
      if (!accepts())
        return false;
    }
    if (!interval.fixed)
      {
        contacts.set_time(interval.time);
        report = contact_iteration.advance(grains, loads, interval.dt, interval.gravity);
      }
    return true;
  }
} // namespace alluvium::coupling
