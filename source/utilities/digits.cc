#include <alluvium/utilities/digits.h>

#include <sstream>

namespace alluvium
{
  std::string in_digits(const double x)
  {
    std::ostringstream text;
    text << x;
    return text.str();
  }


  std::string rounded(const double x)
  {
    std::ostringstream text;
    text.precision(3);
    text << x;
    return text.str();
  }
} // namespace alluvium
