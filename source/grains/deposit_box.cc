#include <alluvium/grains/deposit_box.h>
#include <alluvium/utilities/user_error.h>

#include <cmath>
#include <sstream>

namespace alluvium::grains
{
  DepositBox parse_deposit_box(const std::string &text, const DepositContext &context)
  {
    if (text.find_first_not_of(" \t") == std::string::npos)
      return {context.lower, context.upper};
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
    return {{{v[0], v[1]}}, {{v[2], v[3]}}};
  }
} // namespace alluvium::grains
