#include <alluvium/contacts/solvers/coarse_correction.h>
#include <alluvium/utilities/reproducible_sum.h>

#include <algorithm>
#include <cmath>

namespace alluvium::contacts
{
  namespace
  {
    constexpr double preference = 1e-2; // for small changes, relative to the diagonal
    constexpr double accuracy   = 1e-2; // of the coarse problem: its solution is rough anyway
    constexpr int    max_steps  = 200;
    constexpr double smallest = 0.2, largest = 5.; // factors
  }                                                // namespace

  CoarseCorrection::CoarseCorrection(const ContactProblem &problem, const DiscPlaces &places)
    : places(places)
  {
    const DiscExtent bed      = measure_extent(problem, places);
    const double     diameter = bed.diameter;
    const double     lx = bed.upper[0] - bed.lower[0] + 2. * diameter, ly = bed.upper[1] - bed.lower[1] + 2. * diameter;
    left   = bed.lower[0] - diameter;
    bottom = bed.lower[1] - diameter;
    extent = std::sqrt(lx * ly) / diameter;
    size   = std::max(8. * diameter, 0.1 * std::sqrt(lx * ly));
    // One disc that lies far away must not cost the memory of all the blocks in between.
    size      = std::max(size, 1e-2 * std::max(lx, ly));
    n_columns = static_cast<std::size_t>(lx / size) + 2;
    n_rows    = static_cast<std::size_t>(ly / size) + 2;
  }

  CoarseCorrection::Hats CoarseCorrection::hats_at(const double x, const double y) const
  {
    const double u = (x - left) / size, v = (y - bottom) / size;
    Hats         hats;
    hats.column    = std::clamp(static_cast<std::ptrdiff_t>(u), std::ptrdiff_t(0), std::ptrdiff_t(n_columns) - 2);
    hats.row       = std::clamp(static_cast<std::ptrdiff_t>(v), std::ptrdiff_t(0), std::ptrdiff_t(n_rows) - 2);
    const double s = std::clamp(u - hats.column, 0., 1.), t = std::clamp(v - hats.row, 0., 1.);
    hats.value = {{(1. - s) * (1. - t), s * (1. - t), (1. - s) * t, s * t}};
    return hats;
  }

  std::array<double, CoarseCorrection::n_families> CoarseCorrection::families(const Contact &contact)
  {
    // Three directions 60 degrees apart: (1 + cos 2 (angle to each)) / 3, which sum to one
    const double cosine = (contact.nx * contact.nx - contact.ny * contact.ny) / 3.;
    const double sine   = 2. * contact.nx * contact.ny / 3.;
    const double third = 1. / 3., half_root = 0.86602540378443865;
    return {{third + cosine, third - 0.5 * cosine + half_root * sine, third - 0.5 * cosine - half_root * sine}};
  }

  double CoarseCorrection::unbalanced(const ContactProblem &problem)
  {
    double largest_terms[2] = {0., 0.};
    for (std::size_t k = 0; k < problem.n_owned_discs; ++k)
      if (const Disc &d = problem.discs[k]; d.inverse_mass > 0.)
        {
          largest_terms[0] = std::max(largest_terms[0], 1. / d.inverse_mass);
          largest_terms[1] = std::max(largest_terms[1], (std::abs(d.x) + std::abs(d.y)) / d.inverse_mass);
        }
    if (problem.communicator != nullptr)
      problem.communicator->max(largest_terms, 2);
    const double mass_shift     = ReproducibleSum(most_terms * largest_terms[0]).unit_shift();
    const double momentum_shift = ReproducibleSum(most_terms * largest_terms[1]).unit_shift();

    std::vector<double> sums(3 * n_nodes(), 0.);
    for (std::size_t k = 0; k < problem.n_owned_discs; ++k)
      if (const Disc &d = problem.discs[k]; d.inverse_mass > 0.)
        {
          const Hats hats = hats_at(places.x[k], places.y[k]);
          for (unsigned int corner = 0; corner < 4; ++corner)
            {
              double *const sum  = sums.data() + 3 * node(hats, corner);
              const double  mass = hats.value[corner] / d.inverse_mass;
              sum[0] += (mass * d.x + momentum_shift) - momentum_shift;
              sum[1] += (mass * d.y + momentum_shift) - momentum_shift;
              sum[2] += (mass + mass_shift) - mass_shift;
            }
        }
    if (problem.communicator != nullptr)
      problem.communicator->sum(sums.data(), sums.size());

    double heaviest = 0.;
    for (std::size_t k = 0; k < n_nodes(); ++k)
      heaviest = std::max(heaviest, sums[3 * k + 2]);
    momentum.resize(2 * n_nodes());
    weight.resize(n_nodes());
    double square = 0.;
    for (std::size_t k = 0; k < n_nodes(); ++k)
      {
        // Nearly empty blocks do not count for more than others.
        weight[k] = sums[3 * k + 2] > 0. ? 1. / std::sqrt(sums[3 * k + 2] + 0.01 * heaviest) : 0.;
        for (unsigned int c = 0; c < 2; ++c)
          {
            momentum[2 * k + c] = weight[k] * sums[3 * k + c];
            square += momentum[2 * k + c] * momentum[2 * k + c];
          }
      }
    return std::sqrt(square);
  }

  void CoarseCorrection::add_contact(
    const Hats &hats, const Contact &contact, const Hats &test, const std::array<double, 4> &value, const double shift)
  {
    const auto   family = families(contact);
    const double px     = contact.rn * contact.nx - contact.rt * contact.ny,
                 py     = contact.rn * contact.ny + contact.rt * contact.nx;
    double push[block_size];
    for (unsigned int m = 0; m < n_families; ++m)
      {
        push[2 * m]     = family[m] * px;
        push[2 * m + 1] = family[m] * py;
      }
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int b = 0; b < 4; ++b)
        {
          const std::size_t dx     = test.column + b % 2 + reach - (hats.column + a % 2);
          const std::size_t dy     = test.row + b / 2 + reach - (hats.row + a / 2);
          double *const     entry  = matrix.data() + ((node(hats, a) * width + dy) * width + dx) * block_size;
          const double      factor = hats.value[a] * value[b];
          for (unsigned int m = 0; m < block_size; ++m)
            entry[m] += (factor * push[m] + shift) - shift;
        }
  }

  template <class Function>
  void CoarseCorrection::for_each_neighbour(const Function &f) const
  {
    for (std::size_t row = 0; row < n_rows; ++row)
      for (std::size_t column = 0; column < n_columns; ++column)
        for (unsigned int s = 0; s < width * width; ++s)
          {
            const std::size_t node = row * n_columns + column;
            const std::size_t r = row + s / width - reach, c = column + s % width - reach; // wrap around below zero
            if (r < n_rows && c < n_columns)
              f((node * width * width + s) * block_size, node, r * n_columns + c);
          }
  }

  void CoarseCorrection::assemble(const ContactProblem &problem)
  {
    matrix.assign(n_nodes() * width * width * block_size, 0.);
    double largest_impulse = 0.;
    for (const Contact &c : problem.contacts)
      largest_impulse = std::max(largest_impulse, std::abs(c.rn) + std::abs(c.rt));
    if (problem.communicator != nullptr)
      problem.communicator->max(&largest_impulse, 1);
    const double shift = ReproducibleSum(most_terms * largest_impulse).unit_shift();

    for (const Contact &c : problem.contacts)
      if (c.rn > 0. && problem.counts(c))
        {
          const double x = places.x[c.i], y = places.y[c.i], r = places.radius[c.i];
          const bool   moves_i = problem.discs[c.i].inverse_mass > 0., moves_j = problem.discs[c.j].inverse_mass > 0.;
          const double length = r + (moves_j ? places.radius[c.j] : 0.); // j may be a periodic image
          const Hats   hats = hats_at(x + r * c.nx, y + r * c.ny), hats_i = hats_at(x, y),
                     hats_j = hats_at(x + length * c.nx, y + length * c.ny);
          std::array<double, 4> value{};
          if (moves_j)
            value = hats_j.value;
          if (hats_i.column == hats_j.column && hats_i.row == hats_j.row)
            {
              for (unsigned int b = 0; b < 4 && moves_i; ++b)
                value[b] -= hats_i.value[b];
              add_contact(hats, c, hats_i, value, shift);
              continue;
            }
          if (moves_j)
            add_contact(hats, c, hats_j, value, shift);
          if (moves_i)
            {
              for (unsigned int b = 0; b < 4; ++b)
                value[b] = -hats_i.value[b];
              add_contact(hats, c, hats_i, value, shift);
            }
        }
    if (problem.communicator != nullptr)
      problem.communicator->sum(matrix.data(), matrix.size());

    // Weigh the rows, which are the test nodes. Blocks beyond the grid are never asked for.
    for_each_neighbour([&](const std::size_t block, std::size_t, const std::size_t test) {
      for (unsigned int m = 0; m < block_size; ++m)
        matrix[block + m] *= weight[test];
    });
  }

  void CoarseCorrection::multiply(const std::vector<double> &c, std::vector<double> &result) const
  {
    std::fill(result.begin(), result.end(), 0.);
    for_each_neighbour([&](const std::size_t block, const std::size_t node, const std::size_t test) {
      for (unsigned int m = 0; m < n_families; ++m)
        for (unsigned int d = 0; d < 2; ++d)
          result[2 * test + d] += matrix[block + 2 * m + d] * c[n_families * node + m];
    });
  }

  void CoarseCorrection::multiply_transposed(const std::vector<double> &test_values, std::vector<double> &result) const
  {
    std::fill(result.begin(), result.end(), 0.);
    for_each_neighbour([&](const std::size_t block, const std::size_t node, const std::size_t test) {
      for (unsigned int m = 0; m < n_families; ++m)
        result[n_families * node + m] +=
          matrix[block + 2 * m] * test_values[2 * test] + matrix[block + 2 * m + 1] * test_values[2 * test + 1];
    });
  }

  std::vector<double> CoarseCorrection::solve() const
  {
    // Conjugate gradients for the least squares, scaled by the diagonal of the normal matrix
    const std::size_t   n = n_families * n_nodes();
    std::vector<double> diagonal(n, 0.);
    for_each_neighbour([&](const std::size_t block, const std::size_t node, std::size_t) {
      for (unsigned int m = 0; m < n_families; ++m)
        {
          const double *const entry = matrix.data() + block + 2 * m;
          diagonal[n_families * node + m] += entry[0] * entry[0] + entry[1] * entry[1];
        }
    });
    std::vector<double> c(n, 0.), gradient(n), direction(n, 0.), rest(2 * n_nodes()), image(2 * n_nodes());
    for (std::size_t k = 0; k < rest.size(); ++k)
      rest[k] = -momentum[k];
    double first = 0., last = 1.;
    for (int step = 0; step < max_steps; ++step)
      {
        multiply_transposed(rest, gradient);
        double product = 0.;
        for (std::size_t k = 0; k < n; ++k)
          if (diagonal[k] > 0.)
            {
              gradient[k] = gradient[k] / diagonal[k] - preference * c[k];
              product += diagonal[k] * gradient[k] * gradient[k];
            }
        if (step == 0)
          first = product;
        if (product <= accuracy * accuracy * first)
          break;
        double square = 0.;
        for (std::size_t k = 0; k < n; ++k)
          {
            direction[k] = gradient[k] + (step == 0 ? 0. : product / last) * direction[k];
            square += preference * diagonal[k] * direction[k] * direction[k];
          }
        last = product;
        multiply(direction, image);
        for (const double v : image)
          square += v * v;
        const double length = product / square;
        for (std::size_t k = 0; k < n; ++k)
          c[k] += length * direction[k];
        for (std::size_t k = 0; k < rest.size(); ++k)
          rest[k] -= length * image[k];
      }
    return c;
  }

  void CoarseCorrection::balance(ContactProblem &problem)
  {
    assemble(problem);
    const std::vector<double> change = solve();
    for (std::size_t k = 0; k < problem.contacts.size(); ++k)
      if (Contact &c = problem.contacts[k]; c.rn > 0.)
        {
          const double r      = places.radius[c.i];
          const Hats   hats   = hats_at(places.x[c.i] + r * c.nx, places.y[c.i] + r * c.ny);
          const auto   family = families(c);
          double       factor = 1.;
          for (unsigned int corner = 0; corner < 4; ++corner)
            for (unsigned int m = 0; m < n_families; ++m)
              factor += hats.value[corner] * family[m] * change[n_families * node(hats, corner) + m];
          factor = std::clamp(factor, smallest, largest);
          c.rn *= factor;
          c.rt *= factor;
          if (!problem.rolling.empty())
            problem.rolling[k].impulse *= factor;
        }
  }
} // namespace alluvium::contacts
