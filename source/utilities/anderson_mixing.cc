#include <alluvium/utilities/anderson_mixing.h>

#include <cmath>
#include <cstddef>

namespace alluvium
{
  namespace
  {
    double dot(const std::vector<double> &a, const std::vector<double> &b)
    {
      double sum = 0.;
      for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
      return sum;
    }

    void add_to(std::vector<double> &a, const double factor, const std::vector<double> &b)
    {
      for (std::size_t i = 0; i < a.size(); ++i)
        a[i] += factor * b[i];
    }
  } // namespace


  void AndersonMixing::add(std::vector<double> residual)
  {
    residuals.push_back(std::move(residual));
    if (residuals.size() > depth)
      residuals.erase(residuals.begin());
  }


  std::vector<double> AndersonMixing::weights() const
  {
    constexpr double          alike  = 1e-3; // of its size, what a difference must have that others have not
    const std::vector<double> latest = residuals.back();
    std::vector<double>       result(n(), 0.), rest = latest;
    result.back() = 1.;
    // latest + sum of x_i (r_i - latest): Gram-Schmidt from the newest on, keeping what each direction is made of
    std::vector<std::vector<double>> directions, parts;
    for (unsigned int i = n() - 1; i-- > 0;)
      {
        std::vector<double> direction = residuals[i], part(n(), 0.);
        add_to(direction, -1., latest);
        part[i]           = 1.;
        part.back()       = -1.;
        const double size = std::sqrt(dot(direction, direction));
        for (std::size_t k = 0; k < directions.size(); ++k)
          {
            const double x = dot(directions[k], direction);
            add_to(direction, -x, directions[k]);
            add_to(part, -x, parts[k]);
          }
        const double left = std::sqrt(dot(direction, direction));
        if (!(left > alike * size))
          continue;
        for (double &x : direction)
          x /= left;
        for (double &x : part)
          x /= left;
        const double x = dot(direction, rest);
        add_to(rest, -x, direction);
        add_to(result, -x, part);
        directions.push_back(std::move(direction));
        parts.push_back(std::move(part));
      }
    return result;
  }
} // namespace alluvium
