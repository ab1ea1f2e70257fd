#include <alluvium/run/checkpoint.h>
#include <alluvium/run/good_state.h>
#include <alluvium/run/model.h>

#include <deal.II/grid/tria.h>

namespace alluvium::run
{
  void GoodState::keep(const Model &m, const std::function<void(nlohmann::ordered_json &)> &save)
  {
    state = m;
    if (m.has_fluid)
      {
        field  = m.solver.solution();
        before = m.solver.old();
      }
    grains = m.grains;
    if (m.grains_move)
      contacts = m.contacts.archive();
    more = {};
    if (m.is_root)
      save(more);
    exists = true;
  }


  void GoodState::write(const std::string &folder, Model &m)
  {
    m.drop_caches(); // what modules have kept from steps since then is not part of that state
    static_cast<State &>(m) = state;
    m.grains                = grains;
    if (m.grains_move)
      m.contacts.set_archive(contacts);
    if (m.has_fluid)
      {
        m.solver.set_solution(field);
        m.solver.old() = before;
        m.solver.old().update_ghost_values();
        m.coupling.update_void_fraction(m.grains);
      }
    Checkpoint::write(folder, m, [&](nlohmann::ordered_json &state) { state.update(more); });
  }
} // namespace alluvium::run
