#include <alluvium/contacts/solvers/contact_relax.h>
#include <alluvium/contacts/solvers/moment_correction.h>
#include <alluvium/utilities/reproducible_sum.h>

#include <algorithm>
#include <cmath>

namespace alluvium::contacts
{
  namespace
  {
    constexpr double       cell_size       = 20.;  // mean diameters
    constexpr std::size_t  most_cells      = 100;  // in a direction: a disc that lies far away must not cost memory
    constexpr double       regularisation  = 1e-6; // of the diagonal: hats whose impulses load nothing
    constexpr double       least_gain      = 0.25; // of the kinetic energy, or the discs really move
    constexpr double       smallest_factor = 0.7, largest_factor = 1.1;
    constexpr unsigned int first_sweeps = 5;

    using Vector = std::array<double, 3>; // x, y, s

    double product(const Vector &a, const Vector &b)
    {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    /** Inverse masses of a disc, one for each component of its velocity. */
    Vector inverse_masses(const Disc &d)
    {
      return {{d.inverse_mass, d.inverse_mass, d.inverse_rotation}};
    }

    double twice_energy(const Disc &d)
    {
      return (d.x * d.x + d.y * d.y) / d.inverse_mass + (d.inverse_rotation > 0. ? d.s * d.s / d.inverse_rotation : 0.);
    }

    /** The symmetric positive definite system @p matrix x = @p x, rows of the lower band of @p width beside the
     * diagonal, by Cholesky. */
    void solve_band(std::vector<double> &matrix, const std::size_t width, std::vector<double> &x)
    {
      const std::size_t n = x.size(), row = width + 1;
      const auto        entry = [&](const std::size_t i, const std::size_t j) -> double        &{
        return matrix[i * row + (j + width - i)];
      };
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i > width ? i - width : 0; j <= i; ++j)
          {
            const std::size_t first = std::max(i > width ? i - width : 0, j > width ? j - width : 0);
            double            sum   = entry(i, j);
            for (std::size_t k = first; k < j; ++k)
              sum -= entry(i, k) * entry(j, k);
            if (j < i)
              entry(i, j) = sum / entry(j, j);
            else // what round-off has left of a hat that others can do without keeps its coefficient at 0
              entry(i, i) = sum > 1e-14 * entry(i, i) ? std::sqrt(sum) : 1e100;
          }
      for (std::size_t i = 0; i < n; ++i)
        {
          for (std::size_t k = i > width ? i - width : 0; k < i; ++k)
            x[i] -= entry(i, k) * x[k];
          x[i] /= entry(i, i);
        }
      for (std::size_t i = n; i-- > 0;)
        {
          x[i] /= entry(i, i);
          for (std::size_t k = i > width ? i - width : 0; k < i; ++k)
            x[k] -= entry(i, k) * x[i];
        }
    }
  } // namespace


  void MomentCorrection::begin(const ContactProblem        &problem,
                               const DiscPlaces            &new_places,
                               const std::array<double, 2> &period)
  {
    places.emplace(new_places);
    const DiscExtent bed = measure_extent(problem, *places);
    n_all                = bed.n;
    mass                 = bed.mass;
    grid.set(bed.lower, bed.upper, period, cell_size * bed.diameter, most_cells);
    due           = first_sweeps;
    latest_sweeps = never;
    next_look     = 0;
    n_done        = 0;
  }


  void MomentCorrection::add_moments(const ContactProblem &problem)
  {
    moments.assign(problem.n_owned_discs, {});
    const auto add = [&](const std::size_t disc, const Vector &f, const double x, const double y) {
      if (disc >= problem.n_owned_discs)
        return;
      Moments &m = moments[disc];
      for (unsigned int c = 0; c < 3; ++c)
        {
          m.force[c] += f[c];
          m.along_x[c] += x * f[c];
          m.along_y[c] += y * f[c];
        }
    };
    for (std::size_t k = 0; k < problem.contacts.size(); ++k)
      if (const Contact &c = problem.contacts[k]; c.rn > 0.)
        {
          const double px = c.rn * c.nx - c.rt * c.ny, py = c.rn * c.ny + c.rt * c.nx, r_i = places->radius[c.i];
          Vector       on_i = {{-px, -py, -c.rt}}, on_j = {{px, py, -c.rt}};
          if (!problem.rolling.empty())
            {
              const RollingFriction &r = problem.rolling[k];
              on_i[2] -= r.lever_i * r.impulse;
              on_j[2] += r.lever_j * r.impulse;
            }
          add(c.i, on_i, r_i * c.nx, r_i * c.ny);
          if (c.j < problem.n_owned_discs)
            add(c.j, on_j, -places->radius[c.j] * c.nx, -places->radius[c.j] * c.ny);
        }
  }


  void MomentCorrection::assemble(const ContactProblem &problem)
  {
    add_moments(problem);
    const std::size_t n_cells = grid.n_cells();

    // Bounds of the terms: of each cell those of A, then of the energy
    std::vector<double> bound(n_cells + 1, 0.);
    for (std::size_t k = 0; k < problem.n_owned_discs; ++k)
      if (const Disc &d = problem.discs[k]; d.inverse_mass > 0.)
        {
          const HatGrid::Hats hats = grid.at(places->x[k], places->y[k]);
          const Moments      &m    = moments[k];
          const Vector        w    = inverse_masses(d);
          Vector              f; // of any of the four hats, at most
          for (unsigned int c = 0; c < 3; ++c)
            f[c] = std::abs(m.force[c]) +
                   std::max(std::abs(hats.dx[0]), std::abs(hats.dx[2])) * std::abs(m.along_x[c]) +
                   std::max(std::abs(hats.dy[0]), std::abs(hats.dy[1])) * std::abs(m.along_y[c]);
          double &a      = bound[hats.cell];
          a              = std::max(a, w[0] * f[0] * f[0] + w[1] * f[1] * f[1] + w[2] * f[2] * f[2]);
          bound[n_cells] = std::max(bound[n_cells], twice_energy(d));
        }
    if (problem.communicator != nullptr)
      problem.communicator->max(bound.data(), bound.size());
    std::vector<std::array<double, 2>> shift(n_cells + 1);
    for (std::size_t k = 0; k < bound.size(); ++k)
      shift[k] = {{ReproducibleSum(2. * n_all * bound[k]).unit_shift(),
                   ReproducibleSum(2. * n_all * std::sqrt(bound[k] * bound[n_cells])).unit_shift()}};

    const auto round = [](const double term, const double unit) { return (term + unit) - unit; };
    sums.assign(n_entries * n_cells + 1, 0.);
    for (std::size_t k = 0; k < problem.n_owned_discs; ++k)
      if (const Disc &d = problem.discs[k]; d.inverse_mass > 0.)
        {
          const HatGrid::Hats hats  = grid.at(places->x[k], places->y[k]);
          const Moments      &m     = moments[k];
          const Vector        w     = inverse_masses(d);
          const auto         &units = shift[hats.cell];
          double             *entry = sums.data() + n_entries * hats.cell;
          const bool          spins = d.inverse_rotation > 0.;
          const Vector        v     = {{d.x, d.y, spins ? d.s : 0.}};
          Vector              f[4], wf[4];
          for (unsigned int a = 0; a < 4; ++a)
            for (unsigned int c = 0; c < 3; ++c)
              {
                f[a][c]  = hats.value[a] * m.force[c] + hats.dx[a] * m.along_x[c] + hats.dy[a] * m.along_y[c];
                f[a][c]  = c == 2 && !spins ? 0. : f[a][c];
                wf[a][c] = w[c] * f[a][c];
              }
          for (unsigned int a = 0; a < 4; ++a)
            for (unsigned int b = a; b < 4; ++b)
              *entry++ += round(product(f[a], wf[b]), units[0]);
          for (unsigned int a = 0; a < 4; ++a)
            *entry++ += round(product(f[a], v), units[1]);
          sums[n_entries * n_cells] += round(twice_energy(d), shift[n_cells][0]);
        }
    if (problem.communicator != nullptr)
      problem.communicator->sum(sums.data(), sums.size());
  }


  void MomentCorrection::solve()
  {
    const std::size_t   n = grid.n_nodes(), n_cells = grid.n_cells(), width = grid.band_width(), row = width + 1;
    std::vector<double> matrix(n * row, 0.), x(n, 0.);
    for (std::size_t cell = 0; cell < n_cells; ++cell)
      {
        std::array<std::size_t, 4> at = grid.nodes(cell);
        for (std::size_t &node : at)
          node = grid.position(node);
        const double *entry = sums.data() + n_entries * cell;
        for (unsigned int a = 0; a < 4; ++a)
          for (unsigned int b = a; b < 4; ++b)
            {
              const std::size_t i = std::max(at[a], at[b]), j = std::min(at[a], at[b]);
              matrix[i * row + (j + width - i)] += (a != b && i == j ? 2. : 1.) * *entry++;
            }
        for (unsigned int a = 0; a < 4; ++a)
          x[at[a]] -= *entry++;
      }
    for (std::size_t k = 0; k < n; ++k)
      {
        double &diagonal = matrix[k * row + width];
        diagonal         = diagonal > 0. ? (1. + regularisation) * diagonal : 1.;
      }
    const std::vector<double> rest = x;
    solve_band(matrix, width, x);
    latest = {0., 0.5 * sums[n_entries * n_cells], 0.};
    for (std::size_t k = 0; k < n; ++k)
      latest.gain += 0.5 * rest[k] * x[k];
    latest.velocity = mass > 0. ? std::sqrt(2. * std::max(0., latest.gain) / mass) : 0.;
    coefficient.resize(n);
    for (std::size_t node = 0; node < n; ++node)
      coefficient[node] = x[grid.position(node)];
  }


  const MomentCorrection::Estimate &MomentCorrection::estimate(const ContactProblem &problem, const unsigned int sweeps)
  {
    if (latest_sweeps != sweeps)
      {
        assemble(problem);
        solve();
        latest_sweeps = sweeps;
      }
    return latest;
  }


  double MomentCorrection::velocity(const ContactProblem &problem,
                                    const double          kinetic_energy,
                                    const unsigned int    sweeps,
                                    const double          limit)
  {
    const double all = mass > 0. ? std::sqrt(2. * kinetic_energy / mass) : 0.;
    return all <= limit ? all : estimate(problem, sweeps).velocity;
  }


  void MomentCorrection::disappoint(const unsigned int sweeps)
  {
    constexpr unsigned int few = 5;
    next_look                  = sweeps + few;
    due                        = std::min(due, sweeps);
  }


  bool MomentCorrection::correct(ContactProblem &problem, const unsigned int sweeps)
  {
    estimate(problem, sweeps);
    due = 2 * sweeps + 15;
    if (!(latest.gain > 0. && latest.gain >= least_gain * latest.kinetic_energy))
      return false;
    for (std::size_t k = 0; k < problem.contacts.size(); ++k)
      if (Contact &c = problem.contacts[k]; c.rn > 0.)
        {
          const double        r    = places->radius[c.i];
          const HatGrid::Hats hats = grid.at(places->x[c.i] + r * c.nx, places->y[c.i] + r * c.ny);
          double              a    = 0.;
          for (unsigned int corner = 0; corner < 4; ++corner)
            a += hats.value[corner] * coefficient[hats.node[corner]];
          const double factor = std::clamp(1. + a, smallest_factor, largest_factor);
          push(problem, c, (factor - 1.) * c.rn, (factor - 1.) * c.rt);
          c.rn *= factor;
          c.rt *= factor;
          if (!problem.rolling.empty())
            {
              RollingFriction &rolling = problem.rolling[k];
              roll(rolling, problem.discs[c.i], problem.discs[c.j], (factor - 1.) * rolling.impulse);
              rolling.impulse *= factor;
            }
        }
    if (problem.communicator != nullptr)
      problem.communicator->update_ghosts(problem.discs);
    latest_sweeps = never;
    ++n_done;
    return true;
  }


  bool correct_if_due(ContactProblem &problem, const unsigned int sweeps)
  {
    return problem.correction != nullptr && problem.correction->is_due(sweeps) &&
           problem.correction->correct(problem, sweeps);
  }
} // namespace alluvium::contacts
