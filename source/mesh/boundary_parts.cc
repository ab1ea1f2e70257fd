#include <alluvium/mesh/boundary_parts.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/expression.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::mesh
{
  namespace
  {
    const std::string where = "Domain/Named parts";

    /** Read `low < x < high`, `x < high` or `x > low` into @p part. */
    void parse_range(const std::string &item, const std::string &range, geometry::BoundaryPart &part)
    {
      const std::string expected = where + ": '" + item +
                                   "': expected a range such as `0.01 < x < 0.02`, `x < 0.02` or `y > 0.1`, got '" +
                                   range + "'.";
      std::vector<std::string> terms(1);
      std::string              signs;
      for (const char c : range)
        if (c == '<' || c == '>')
          {
            signs += c;
            terms.emplace_back();
          }
        else if (c != '=')
          terms.back() += c;
      check_user(signs == "<" || signs == ">" || signs == "<<" || signs == ">>", expected);
      part.low  = std::numeric_limits<double>::lowest();
      part.high = std::numeric_limits<double>::max();
      int axis  = -1;
      for (std::size_t i = 0; i < terms.size(); ++i)
        {
          const std::string term = dealii::Utilities::trim(terms[i]);
          if (term == "x" || term == "y")
            {
              check_user(axis < 0 && (terms.size() == 2 || i == 1), expected);
              axis = term == "y";
              continue;
            }
          check_user(!term.empty(), expected);
          const double value =
            parse_expressions(where + ": '" + item + "'", {term}, {{"pi", dealii::numbers::PI}})->value({});
          check_user(std::isfinite(value), expected);
          const bool below               = (i == 0) == (signs[0] == '<'); // is it the lower bound?
          (below ? part.low : part.high) = value;
        }
      check_user(axis >= 0, expected);
      check_user(part.low < part.high,
                 where + ": '" + item + "': the range '" + range + "' ends before it begins, or where it begins.");
      part.axis = axis;
    }

    /** A range with two ends that reaches beyond its side would bring less than its text says. */
    void
    check_reach(const std::string &item, const geometry::BoundaryPart &part, const std::vector<BoundarySide> &sides)
    {
      double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
      for (const auto &side : sides)
        if (side.id == part.side)
          for (const auto &end : {side.a, side.b})
            {
              low  = std::min(low, end[part.axis]);
              high = std::max(high, end[part.axis]);
            }
      const double tolerance = 1e-9 * (high - low);
      const bool   is_open   = part.low == std::numeric_limits<double>::lowest() ||
                           part.high == std::numeric_limits<double>::max(); // as `x < 1` for all of a side
      const std::string axis = part.axis == 0 ? "x" : "y";
      check_user(is_open || (part.low >= low - tolerance && part.high <= high + tolerance),
                 where + ": '" + item + "' reaches beyond '" + part.side_name + "', which goes from " + axis + " = " +
                   in_digits(low) + " to " + in_digits(high) + " m. For all of it from or up to a point write `" +
                   axis + " > ...` or `" + axis + " < ...`.");
    }

    double length_of(const std::vector<geometry::BoundaryPart> &parts,
                     const std::vector<BoundarySide>           &sides,
                     const unsigned int                         id)
    {
      double sum = 0.;
      for (const auto &side : sides)
        for (const auto &piece : geometry::divide_face(parts, side.id, side.a, side.b))
          if (piece.id == id)
            sum += (piece.end - piece.begin) * std::hypot(side.b[0] - side.a[0], side.b[1] - side.a[1]);
      return sum;
    }
  } // namespace


  std::vector<geometry::BoundaryPart> parse_boundary_parts(const std::string                   &text,
                                                           const std::vector<BoundarySide>     &sides,
                                                           std::map<std::string, unsigned int> &ids)
  {
    std::vector<geometry::BoundaryPart> parts;
    std::string                         known;
    unsigned int                        next = 0;
    for (const auto &[name, id] : ids)
      {
        known += (known.empty() ? "" : ", ") + name;
        next = std::max(next, id + 1);
      }
    const auto all_sides = ids;
    for (const auto &item : dealii::Utilities::split_string_list(text, ';'))
      {
        const auto equals = item.find('='), colon = item.find(':');
        check_user(equals != std::string::npos && colon != std::string::npos && equals < colon,
                   where + ": expected `name = side: low < x < high`, got '" + item + "'.");
        geometry::BoundaryPart part;
        part.name              = dealii::Utilities::trim(item.substr(0, equals));
        const std::string side = dealii::Utilities::trim(item.substr(equals + 1, colon - equals - 1));
        check_user(!part.name.empty() && part.name.find_first_of(" ,;:|<>") == std::string::npos,
                   where + ": '" + item + "': '" + part.name + "' is no name; expected a word without spaces.");
        check_user(ids.count(part.name) == 0, where + ": there already is a boundary named '" + part.name + "'.");
        check_user(all_sides.count(side) == 1,
                   where + ": '" + item + "': there is no boundary named '" + side +
                     "'. The domain's boundaries are: " + known + ".");
        part.side_name = side;
        part.id        = next++;
        part.side      = all_sides.at(side);
        parse_range(item, dealii::Utilities::trim(item.substr(colon + 1)), part);
        check_user(length_of({part}, sides, part.id) > 0.,
                   where + ": '" + item + "': no point of '" + side + "' lies there.");
        check_reach(item, part, sides);
        for (const auto &other : parts)
          if (other.side == part.side)
            {
              const double all  = length_of({}, sides, part.side);
              const double each = length_of({part}, sides, part.id) + length_of({other}, sides, other.id) +
                                  length_of({part, other}, sides, part.side);
              check_user(each < (1. + 1e-9) * all,
                         where + ": '" + part.name + "' and '" + other.name + "' overlap on '" + side + "'.");
            }
        ids[part.name] = part.id;
        parts.push_back(part);
      }
    for (const auto &[name, id] : all_sides)
      if (!parts.empty() && !(length_of(parts, sides, id) > 0.))
        ids.erase(name);
    return parts;
  }
} // namespace alluvium::mesh
