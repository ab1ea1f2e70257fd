#include <alluvium/run/checkpoint.h>
#include <alluvium/run/good_state.h>
#include <alluvium/run/model.h>

#include <deal.II/grid/tria.h>

namespace alluvium::run
{
  void GoodState::keep(const Model &m, const std::function<void(nlohmann::ordered_json &)> &save)
  {
    at_time = m.time;
    at_step = m.n_steps;
    if (m.has_fluid)
      {
        field  = m.solver.solution();
        before = m.solver.old();
      }
    grains  = m.grains;
    touched = m.touched;
    leavers = m.leavers;
    if (m.grains_move)
      contacts = m.contacts.archive();
    counts = m.counts;
    more   = {};
    if (m.speaks)
      save(more);
    exists = true;
  }


  void GoodState::write(const std::string &folder, Model &m)
  {
    m.time    = at_time;
    m.n_steps = at_step;
    m.counts  = counts;
    m.grains  = grains;
    m.touched = touched;
    m.leavers = leavers;
    // what modules have kept from steps since then is not part of that state
    if (m.grains_move)
      m.contacts.set_archive(contacts);
    if (m.has_fluid)
      {
        m.solver.set_solution(field);
        m.solver.old() = before;
        m.solver.old().update_ghost_values();
        m.solver.linear_solver.clear();
        m.coupling.reinit();
        m.coupling.update_void_fraction(m.grains);
      }
    Checkpoint::write(folder, m, [&](nlohmann::ordered_json &state) { state.update(more); });
  }
} // namespace alluvium::run
