#include <alluvium/contacts/ranks/contact_work.h>
#include <alluvium/contacts/solvers/contact_problem.h>
#include <alluvium/contacts/solvers/contact_reductions.h>

namespace alluvium::contacts
{
  void ContactWork::set_communicator(const MPI_Comm communicator)
  {
    set_shared(false);
    share = std::make_unique<ContactShare>(communicator);
  }

  void ContactWork::set_shared(const bool now)
  {
    if (shared && !now)
      neighbours.set_archive(archive());
    shared = now;
  }

  void ContactWork::begin(grains::GrainArrays &all, const grains::GrainLoads &all_loads, const bool sharing)
  {
    this->all       = &all;
    this->all_loads = &all_loads;
    set_shared(sharing);
    if (shared && share->fits(all))
      share->load(all, all_loads);
    else if (shared)
      share->divide(all, all_loads, {}, 0);
  }

  void ContactWork::end()
  {
    if (shared)
      share->collect(*all, all_touched);
  }

  void ContactWork::update_ghosts()
  {
    if (shared)
      share->update_ghosts();
  }

  bool ContactWork::known()
  {
    return !any_over_ranks(communicator(), !neighbours.known(grains()));
  }

  double ContactWork::slack()
  {
    return neighbours.slack(grains(), geometry.periodicity, communicator());
  }

  void ContactWork::repeat_search(grains::GrainArrays &all_now, const grains::GrainLoads &loads_now, const bool sharing)
  {
    if (!to_repeat.known)
      return;
    const ContactSearchRecord last = std::move(to_repeat);
    to_repeat                      = {};
    set_shared(sharing);
    grains::GrainArrays then        = all_now;
    then.position[0]                = last.x;
    then.position[1]                = last.y;
    const std::vector<double> walls = geometry.walls.positions();
    geometry.walls.place(last.wall_positions);
    neighbours.repeat(last, then, geometry);
    if (shared)
      {
        ContactCandidates mine = share->divide(then, loads_now, neighbours.pairs, neighbours.n_colours);
        neighbours.keep(std::move(mine), share->grains, share->n_owned());
      }
    geometry.walls.place(walls);
  }

  void ContactWork::search(const double skin)
  {
    if (!shared)
      {
        neighbours.search(*all, geometry, skin);
        return;
      }
    share->collect(*all, all_touched);
    neighbours.set_archive(archive());
    neighbours.search(*all, geometry, skin);
    ContactCandidates mine = share->divide(*all, *all_loads, neighbours.pairs, neighbours.n_colours);
    neighbours.keep(std::move(mine), share->grains, share->n_owned());
    for (std::size_t k = 0; k < share->touched.size(); ++k)
      share->touched[k] = all_touched[share->number_of(k)];
  }

  void ContactWork::search(const double skin, std::vector<Disc> &discs)
  {
    std::vector<double> velocity;
    if (shared)
      {
        for (std::size_t k = 0; k < n_owned(); ++k)
          velocity.insert(velocity.end(), {discs[k].x, discs[k].y});
        velocity = share->collect_rows(velocity, 2);
      }
    search(skin);
    if (shared)
      {
        discs.resize(share->grains.n());
        for (std::size_t k = 0; k < discs.size(); ++k)
          {
            discs[k].x = velocity[2 * share->number_of(k)];
            discs[k].y = velocity[2 * share->number_of(k) + 1];
          }
      }
  }
} // namespace alluvium::contacts
