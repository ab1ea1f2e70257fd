// Contact problems without a stepper: a heap of discs, and ranks that are threads.
#pragma once

#include <alluvium/contacts/solvers/contact_solver.h>
#include <alluvium/contacts/solvers/disc_places.h>
#include <alluvium/utilities/plugin.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace alluvium::contacts::test
{
  /** A heap of discs of slightly different sizes on a floor between two walls, and its contacts. */
  struct Heap
  {
    std::vector<double> x, y, radius, weight;
    ContactProblem      problem;

    Heap(const int n_columns, const int n_rows)
    {
      constexpr double d = 1e-3, dt = 1e-4, g = 9.81;
      for (int row = 0; row < n_rows; ++row)
        for (int column = 0; column < n_columns; ++column)
          {
            x.push_back((column + 0.5 + 0.25 * (row % 2 == 0 ? -1 : 1)) * d + 1e-6 * std::sin(7. * row + 3. * column));
            y.push_back(0.5 * d + row * 0.5 * std::sqrt(3.) * d);
            radius.push_back(0.5 * d * (1. + 1e-3 * std::sin(5. * row + 11. * column)));
            weight.push_back(2500. * M_PI * radius.back() * radius.back() * g * dt);
          }
      const std::size_t n = x.size();
      problem.n_discs = problem.n_owned_discs = n;
      problem.discs.resize(n + 4);
      for (std::size_t k = 0; k < n; ++k)
        {
          problem.discs[k].y                = -g * dt;
          problem.discs[k].x                = 0.1 * g * dt * std::sin(1. * k);
          problem.discs[k].inverse_mass     = g * dt / weight[k];
          problem.discs[k].inverse_rotation = 2. * g * dt / weight[k];
        }
      problem.height        = y;
      problem.impulse_scale = weight[0];

      std::vector<std::vector<Contact>> colours;
      std::vector<std::uint64_t>        used(n, 0);
      const auto                        add = [&](const std::size_t i, const std::size_t j, Contact c) {
        c.i                       = i;
        c.j                       = j;
        c.friction                = 0.4;
        const std::uint64_t taken = used[i] | (j < n ? used[j] : 0);
        unsigned int        k     = 0;
        while ((taken >> k) & 1)
          ++k;
        used[i] |= std::uint64_t(1) << k;
        if (j < n)
          used[j] |= std::uint64_t(1) << k;
        colours.resize(std::max<std::size_t>(colours.size(), k + 1));
        colours[k].push_back(c);
      };
      const double width = (n_columns + 0.25) * d;
      for (std::size_t i = 0; i < n; ++i)
        {
          for (std::size_t j = i + 1; j < n && y[j] < y[i] + 1.1 * d; ++j)
            if (const double distance = std::hypot(x[j] - x[i], y[j] - y[i]); distance < 1.02 * d)
              {
                Contact c{};
                c.nx     = (x[j] - x[i]) / distance;
                c.ny     = (y[j] - y[i]) / distance;
                c.bias_n = std::max(0., distance - radius[i] - radius[j] - 5e-6) / dt;
                add(i, j, c);
              }
          if (y[i] < 0.6 * d)
            {
              Contact c{};
              c.ny = -1.;
              add(i, n, c);
            }
          if (x[i] < 0.6 * d || x[i] > width - 0.8 * d)
            {
              Contact c{};
              c.nx = x[i] < 0.6 * d ? -1. : 1.;
              add(i, n + 1, c);
            }
        }
      problem.colour_begin = {0};
      for (const auto &colour : colours)
        {
          problem.contacts.insert(problem.contacts.end(), colour.begin(), colour.end());
          problem.colour_begin.push_back(problem.contacts.size());
        }
    }

    DiscPlaces places() const { return {x, y, radius}; }

    double floor_support() const
    {
      double carried = 0., sum = 0.;
      for (const Contact &c : problem.contacts)
        if (c.j >= problem.n_discs)
          carried -= c.rn * c.ny + c.rt * c.nx;
      for (const double w : weight)
        sum += w;
      return carried / sum;
    }
  };

  inline std::unique_ptr<ContactSolver> make_solver(const std::string &name, const std::string &parameters = "")
  {
    auto                     solver = Registry<ContactSolver>::entries().at(name).create();
    dealii::ParameterHandler prm;
    solver->add_parameters(prm);
    prm.parse_input_from_string(parameters);
    return solver;
  }

  /** Threads that stand for ranks: all discs' velocities and a few sums, with a barrier. */
  class Team
  {
  public:
    Team(const int n_ranks, const std::size_t n_discs)
      : discs(n_discs)
      , n_ranks(n_ranks)
    {}

    void wait()
    {
      std::unique_lock<std::mutex> lock(mutex);
      const int                    mine = turn;
      if (++n_waiting == n_ranks)
        {
          n_waiting = 0;
          ++turn;
          condition.notify_all();
        }
      else
        condition.wait(lock, [&] { return turn != mine; });
    }

    /** Combine values of all ranks, in the order in which they happen to come. */
    template <typename Combine>
    void combine(double *const values, const unsigned int n, const Combine &how)
    {
      wait();
      {
        const std::lock_guard<std::mutex> lock(mutex);
        if (n_arrived++ == 0)
          all.assign(values, values + n);
        else
          for (unsigned int k = 0; k < n; ++k)
            all[k] = how(all[k], values[k]);
      }
      wait();
      std::copy(all.begin(), all.begin() + n, values);
      wait();
      n_arrived = 0;
      wait();
    }

    std::vector<Disc> discs;

  private:
    const int               n_ranks;
    int                     n_waiting = 0, turn = 0, n_arrived = 0;
    std::vector<double>     all;
    std::mutex              mutex;
    std::condition_variable condition;
  };

  class TeamMember : public ContactCommunicator
  {
  public:
    TeamMember(Team &team, const std::vector<std::size_t> &global, const std::size_t n_owned)
      : team(team)
      , global(global)
      , n_owned(n_owned)
    {}

    void after_colour(std::vector<Disc> &discs, unsigned int) override { update_ghosts(discs); }

    void update_ghosts(std::vector<Disc> &discs) override
    {
      team.wait();
      for (std::size_t k = 0; k < n_owned; ++k)
        team.discs[global[k]] = discs[k];
      team.wait();
      for (std::size_t k = n_owned; k < global.size(); ++k)
        {
          discs[k].x = team.discs[global[k]].x;
          discs[k].y = team.discs[global[k]].y;
          discs[k].s = team.discs[global[k]].s;
        }
    }

    void sum(double *values, unsigned int n) override
    {
      team.combine(values, n, [](const double a, const double b) { return a + b; });
    }

    void max(double *values, unsigned int n) override
    {
      team.combine(values, n, [](const double a, const double b) { return std::max(a, b); });
    }

  private:
    Team                          &team;
    const std::vector<std::size_t> global;
    const std::size_t              n_owned;
  };

  /** Call use(its part of @p heap, rank) on several ranks, dealt out by @p owner; velocities of all discs then. */
  template <class Use>
  std::vector<Disc> on_ranks(const Heap &heap, const int n_ranks, const std::vector<int> &owner, const Use &use)
  {
    const std::size_t        n = heap.x.size();
    Team                     team(n_ranks, n);
    std::vector<std::thread> threads;
    std::vector<Disc>        result(n);
    for (int rank = 0; rank < n_ranks; ++rank)
      threads.emplace_back([&, rank] {
        std::vector<std::size_t> global;
        for (std::size_t k = 0; k < n; ++k)
          if (owner[k] == rank)
            global.push_back(k);
        const std::size_t        n_owned = global.size();
        std::vector<std::size_t> local(n + 4, n);
        for (std::size_t k = 0; k < n_owned; ++k)
          local[global[k]] = k;
        const auto mine = [&](const Contact &c) { return owner[c.i] == rank || (c.j < n && owner[c.j] == rank); };
        for (const Contact &c : heap.problem.contacts)
          if (mine(c))
            for (const std::size_t d : {c.i, c.j})
              if (d < n && local[d] == n)
                {
                  local[d] = global.size();
                  global.push_back(d);
                }
        Heap            part    = heap;
        ContactProblem &problem = part.problem;
        TeamMember      member(team, global, n_owned);
        problem.communicator  = &member;
        problem.n_discs       = global.size();
        problem.n_owned_discs = n_owned;
        problem.discs.assign(global.size() + 4, {});
        for (auto *v : {&part.x, &part.y, &part.radius, &part.weight})
          v->resize(global.size());
        for (std::size_t k = 0; k < global.size(); ++k)
          {
            problem.discs[k] = heap.problem.discs[global[k]];
            part.x[k]        = heap.x[global[k]];
            part.y[k]        = heap.y[global[k]];
            part.radius[k]   = heap.radius[global[k]];
            part.weight[k]   = heap.weight[global[k]];
          }
        problem.contacts.clear();
        problem.rolling.clear();
        problem.colour_begin = {0};
        for (std::size_t colour = 0; colour + 1 < heap.problem.colour_begin.size(); ++colour)
          {
            for (std::size_t k = heap.problem.colour_begin[colour]; k < heap.problem.colour_begin[colour + 1]; ++k)
              if (Contact c = heap.problem.contacts[k]; mine(c))
                {
                  c.i = local[c.i];
                  c.j = c.j < n ? local[c.j] : problem.n_discs + (c.j - n);
                  problem.contacts.push_back(c);
                  if (!heap.problem.rolling.empty())
                    problem.rolling.push_back(heap.problem.rolling[k]);
                }
            problem.colour_begin.push_back(problem.contacts.size());
          }
        use(part, rank);
        for (std::size_t k = 0; k < n_owned; ++k)
          result[global[k]] = problem.discs[k];
      });
    for (std::thread &t : threads)
      t.join();
    return result;
  }
} // namespace alluvium::contacts::test
