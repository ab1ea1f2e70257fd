#include <alluvium/deposits/deposit_fit.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/magnitudes.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace alluvium::deposits
{
  double uniform_disc_area(const double d_min, const double ratio)
  {
    return M_PI / 12. * d_min * d_min * (1. + ratio + ratio * ratio);
  }


  void check_diameter(const std::string &name, const std::string &parameter, const double d)
  {
    using namespace magnitudes;
    check_user(d >= smallest_length && d <= largest_length,
               "The deposit '" + name + "' cannot have a '" + parameter + "' of " + in_digits(d) +
                 " m; expected one from " + in_digits(smallest_length) + " to " + in_digits(largest_length) + " m.");
  }


  void check_area(const std::string &name, const double n, const double mean_area, const DepositBox &box)
  {
    constexpr double densest = 0.9069; // of equal discs, pi/(2 sqrt(3)); random ones lie looser
    const double     area = n * mean_area, room = box.width() * box.height();
    if (area * std::max(0., 1. - 2. / std::sqrt(n)) <= densest * room)
      return;
    std::ostringstream text;
    text << "The deposit '" << name << "' cannot fit: its " << n << " grains have an area of " << area
         << " m^2, and its box of " << box.width() << " m x " << box.height() << " m has " << room
         << " m^2, of which discs fill 0.82 or so. Ask for at most some " << std::floor(0.8 * room / mean_area)
         << " grains, or for a larger box.";
    throw UserError(text.str());
  }


  void check_number(const std::string &name, const double n, const DepositBox &box, const double largest)
  {
    constexpr double most = 5e6, many = 1e5, widest = 2e4;
    const double     across = std::max(box.width(), box.height()) / largest;
    if (n <= most && (n <= many || across <= widest))
      return;
    std::ostringstream text;
    text << "The deposit '" << name << "' would have " << n << " grains: its box is " << box.width() << " m x "
         << box.height() << " m, " << box.width() / largest << " x " << box.height() / largest
         << " of the largest diameters. Are lengths in mm? They must be in m.";
    throw UserError(text.str());
  }
} // namespace alluvium::deposits
