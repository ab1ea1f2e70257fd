#include <alluvium/contacts/solvers/hydrostatic_guess.h>
#include <alluvium/utilities/reproducible_sum.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::contacts
{
  namespace
  {
    constexpr double growth  = 1.5; // of the lengths of the cycles
    constexpr double falling = 0.3; // this part of the free momentum left: the bed is not at rest

    /** Each balance disturbs what sweeps have achieved in the small: shallow beds need fewer. */
    unsigned int choose_n_cycles(const double bed_size)
    {
      constexpr double discs_a_cycle = 3200.;
      return 2 + static_cast<unsigned int>(std::min(3., bed_size * bed_size / discs_a_cycle));
    }

    /** The weight above every disc's width, from columns of cells two mean diameters high and twice as wide. */
    std::vector<double> weight_above(const ContactProblem &problem, const DiscPlaces &places, const BedWeight &weight)
    {
      const auto depth = [&](const std::size_t k) {
        return places.x[k] * weight.down[0] + places.y[k] * weight.down[1];
      };
      const auto across = [&](const std::size_t k) {
        return places.y[k] * weight.down[0] - places.x[k] * weight.down[1];
      };
      constexpr double none    = std::numeric_limits<double>::lowest();
      double           ends[6] = {none, none, none, none, 0., 0.};
      for (std::size_t k = 0; k < problem.n_owned_discs; ++k)
        {
          ends[0] = std::max(ends[0], -depth(k));
          ends[1] = std::max(ends[1], depth(k));
          ends[2] = std::max(ends[2], -across(k));
          ends[3] = std::max(ends[3], across(k));
          ends[4] = std::max(ends[4], places.radius[k]);
          ends[5] = std::max(ends[5], std::abs(weight.impulse[k]));
        }
      if (problem.communicator != nullptr)
        problem.communicator->max(ends, 6);
      const double top = -ends[0], left = -ends[2], height = ends[1] - top, breadth = ends[3] - left;
      // One disc that lies far away must not cost the memory of all the cells in between.
      const double row_size       = std::max(4. * ends[4], 1e-3 * height),
                   column_size    = std::max(8. * ends[4], 1e-3 * breadth);
      const std::size_t n_rows    = static_cast<std::size_t>(height / row_size) + 1,
                        n_columns = static_cast<std::size_t>(breadth / column_size) + 1;
      const auto cell             = [&](const std::size_t k) {
        const auto row    = std::clamp((depth(k) - top) / row_size, 0., n_rows - 1.);
        const auto column = std::clamp((across(k) - left) / column_size, 0., n_columns - 1.);
        return static_cast<std::size_t>(row) * n_columns + static_cast<std::size_t>(column);
      };

      const double        shift = ReproducibleSum(most_terms * ends[5]).unit_shift();
      std::vector<double> cells(n_rows * n_columns, 0.);
      for (std::size_t k = 0; k < problem.n_owned_discs; ++k)
        cells[cell(k)] += (weight.impulse[k] + shift) - shift;
      if (problem.communicator != nullptr)
        problem.communicator->sum(cells.data(), cells.size());
      // From the weights of the cells to those above their middles, per length
      for (std::size_t column = 0; column < n_columns; ++column)
        {
          double sum = 0.;
          for (std::size_t row = 0; row < n_rows; ++row)
            {
              double      &value = cells[row * n_columns + column];
              const double own   = value;
              value              = std::max(0., sum + 0.5 * own) / column_size;
              sum += own;
            }
        }
      std::vector<double> result(problem.n_discs);
      for (std::size_t k = 0; k < problem.n_discs; ++k)
        result[k] = 2. * places.radius[k] * cells[cell(k)];
      return result;
    }

    void guess(ContactProblem &problem, const DiscPlaces &places, const BedWeight &weight)
    {
      const std::vector<double> above = weight_above(problem, places, weight);
      for (Contact &c : problem.contacts)
        if (c.bias_n <= 0.)
          {
            const double n_down = c.nx * weight.down[0] + c.ny * weight.down[1];
            const double load   = c.j < problem.n_discs ? 0.5 * (above[c.i] + above[c.j]) : above[c.i];
            c.rn                = 0.6 * load * (1. + 0.4 * (2. * n_down * n_down - 1.));
            c.rt                = 0.;
          }
    }
  } // namespace

  ContactSolution solve_from_hydrostatic_guess(ContactProblem         &problem,
                                               const DiscPlaces       &places,
                                               const BedWeight        &weight,
                                               const ContactSolver    &solver,
                                               const ContactTolerance &tolerance)
  {
    const std::vector<Disc> free = problem.discs;
    CoarseCorrection        blocks(problem, places);
    const double            all = blocks.unbalanced(problem);
    guess(problem, places, weight);

    ContactSolution  solution;
    ContactTolerance part       = tolerance;
    part.at_rest                = true;
    const unsigned int n_cycles = choose_n_cycles(blocks.bed_size());
    double             sweeps   = 20. + 0.09 * blocks.bed_size(); // a block must come to rest inside, whatever its size
    for (unsigned int cycle = 0;; ++cycle)
      {
        const unsigned int before = solution.sweeps, left = tolerance.max_sweeps - before;
        part.max_sweeps = cycle < n_cycles ? std::min(left, static_cast<unsigned int>(sweeps)) : left;
        sweeps *= growth;
        solution = solver.solve(problem, part);
        solution.sweeps += before;
        if (solution.converged || solution.sweeps >= tolerance.max_sweeps)
          return solution;
        const double rest = blocks.unbalanced(problem);
        if (cycle > 0 && rest > falling * all)
          {
            cycle        = n_cycles;
            part.at_rest = false;
          }
        else
          blocks.balance(problem);
        problem.discs = free;
      }
  }
} // namespace alluvium::contacts
