#include <alluvium/deposits/deposit_box.h>
#include <alluvium/utilities/user_error.h>

#include <cmath>
#include <sstream>

namespace alluvium::deposits
{
  namespace
  {
    DepositBox with_periodicity(DepositBox box, const grains::Periodicity &periodicity)
    {
      for (unsigned int d = 0; d < 2; ++d)
        {
          const double length = periodicity.length[d];
          box.periodic[d]     = length > 0. && std::abs(box.lower[d] - periodicity.lower[d]) <= 1e-12 * length &&
                            std::abs(box.upper[d] - box.lower[d] - length) <= 1e-12 * length;
          if (box.periodic[d])
            {
              box.lower[d] = periodicity.lower[d];
              box.upper[d] = box.lower[d] + length;
            }
        }
      return box;
    }
  } // namespace


  DepositBox parse_deposit_box(const std::string &text, const DepositContext &context)
  {
    if (text.find_first_not_of(" \t") == std::string::npos)
      return with_periodicity({context.lower, context.upper}, context.periodicity);
    std::string spaced = text;
    for (char &c : spaced)
      if (c == ',')
        c = ' ';
    std::istringstream    in(spaced);
    std::array<double, 4> v{};
    std::string           rest;
    const bool            good = static_cast<bool>(in >> v[0] >> v[1] >> v[2] >> v[3]) && !(in >> rest);
    check_user(good, "Box = " + text + ": expected four numbers, xmin, ymin, xmax, ymax.");
    check_user(v[0] < v[2] && v[1] < v[3], "Box = " + text + ": it has no inside. Expected xmin, ymin, xmax, ymax.");
    std::array<double, 2> lower = {{v[0], v[1]}}, upper = {{v[2], v[3]}};
    context.upright.turn(lower, upper);
    return with_periodicity({lower, upper}, context.periodicity);
  }
} // namespace alluvium::deposits
