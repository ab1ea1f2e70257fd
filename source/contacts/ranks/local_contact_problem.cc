#include <alluvium/contacts/ranks/local_contact_problem.h>
#include <alluvium/contacts/solvers/contact_problem.h>
#include <alluvium/contacts/solvers/contact_reductions.h>

namespace alluvium::contacts
{
  void LocalContactProblem::set_communicator(const MPI_Comm communicator)
  {
    set_partitioned(false);
    subdomain = std::make_unique<ContactSubdomain>(communicator);
  }

  void LocalContactProblem::set_partitioned(const bool now)
  {
    if (partitioned && !now)
      neighbours.set_archive(archive());
    partitioned = now;
  }

  void
  LocalContactProblem::begin(grains::GrainArrays &all, const grains::GrainLoads &all_loads, const bool in_subdomains)
  {
    this->all       = &all;
    this->all_loads = &all_loads;
    set_partitioned(in_subdomains);
    if (partitioned && subdomain->fits(all))
      subdomain->load(all, all_loads);
    else if (partitioned)
      subdomain->divide(all, all_loads, {}, 0);
  }

  void LocalContactProblem::end()
  {
    if (partitioned)
      subdomain->collect(*all, all_touched);
  }

  void LocalContactProblem::update_ghosts()
  {
    if (partitioned)
      subdomain->update_ghosts();
  }

  bool LocalContactProblem::known()
  {
    return !any_over_ranks(communicator(), !neighbours.known(grains()));
  }

  double LocalContactProblem::slack()
  {
    return neighbours.slack(grains(), geometry.periodicity, communicator());
  }

  void LocalContactProblem::repeat_search(grains::GrainArrays      &all_now,
                                          const grains::GrainLoads &loads_now,
                                          const bool                in_subdomains)
  {
    if (!to_repeat.known)
      return;
    const ContactSearchRecord last = std::move(to_repeat);
    to_repeat                      = {};
    set_partitioned(in_subdomains);
    grains::GrainArrays then        = all_now;
    then.position[0]                = last.x;
    then.position[1]                = last.y;
    const std::vector<double> walls = geometry.walls.positions();
    geometry.walls.place(last.wall_positions);
    neighbours.repeat(last, then, geometry);
    if (partitioned)
      {
        ContactCandidates mine = subdomain->divide(then, loads_now, neighbours.pairs, neighbours.n_colours);
        neighbours.keep(std::move(mine), subdomain->grains, subdomain->n_owned());
      }
    geometry.walls.place(walls);
  }

  void LocalContactProblem::search(const double skin)
  {
    if (!partitioned)
      {
        neighbours.search(*all, geometry, skin);
        return;
      }
    subdomain->collect(*all, all_touched);
    neighbours.set_archive(archive());
    neighbours.search(*all, geometry, skin);
    ContactCandidates mine = subdomain->divide(*all, *all_loads, neighbours.pairs, neighbours.n_colours);
    neighbours.keep(std::move(mine), subdomain->grains, subdomain->n_owned());
    for (std::size_t k = 0; k < subdomain->touched.size(); ++k)
      subdomain->touched[k] = all_touched[subdomain->number_of(k)];
  }

  void LocalContactProblem::search(const double skin, std::vector<Disc> &discs)
  {
    std::vector<double> velocity;
    if (partitioned)
      {
        for (std::size_t k = 0; k < n_owned(); ++k)
          velocity.insert(velocity.end(), {discs[k].x, discs[k].y});
        velocity = subdomain->collect_rows(velocity, 2);
      }
    search(skin);
    if (partitioned)
      {
        discs.resize(subdomain->grains.n());
        for (std::size_t k = 0; k < discs.size(); ++k)
          {
            discs[k].x = velocity[2 * subdomain->number_of(k)];
            discs[k].y = velocity[2 * subdomain->number_of(k) + 1];
          }
      }
  }
} // namespace alluvium::contacts
