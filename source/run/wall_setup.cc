#include <alluvium/run/wall_setup.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/expression.h>
#include <alluvium/utilities/magnitudes.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/function.h>
#include <deal.II/base/numbers.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace alluvium::run
{
  using namespace dealii;

  namespace
  {
    const std::string extra_name = "Grains/Extra walls", motion_name = "Grains/Motion of walls",
                      presence_name = "Grains/Presence of walls";

    bool read_number(const std::string &text, double &x)
    {
      try
        {
          std::size_t length = 0;
          x                  = std::stod(text, &length);
          return length == text.size() && std::abs(x) <= magnitudes::largest;
        }
      catch (const std::exception &)
        {
          return false;
        }
    }

    /** Read numbers separated by commas; false if they are none. */
    bool read_numbers(const std::string &text, std::vector<double> &numbers)
    {
      for (const std::string &item : Utilities::split_string_list(text, ','))
        {
          numbers.push_back(0.);
          if (!read_number(item, numbers.back()))
            return false;
        }
      return true;
    }

    /** Whether a part of @p wall is in the domain's bounding box, or on its sides. */
    bool reaches_into(const mesh::Domain<2> &domain, const grains::WallSegment &wall)
    {
      double first = 0., last = 1.; // the part of the wall between both pairs of sides
      for (unsigned int d = 0; d < 2; ++d)
        {
          const double tolerance = 1e-9 * (domain.upper()[d] - domain.lower()[d]);
          const double low = domain.lower()[d] - tolerance, high = domain.upper()[d] + tolerance;
          const double a = wall.a[d], e = wall.b[d] - wall.a[d];
          if (e == 0. && (a < low || a > high))
            return false;
          if (e != 0.)
            {
              first = std::max(first, std::min((low - a) / e, (high - a) / e));
              last  = std::min(last, std::max((low - a) / e, (high - a) / e));
            }
        }
      return first <= last;
    }

    /** What follows the first of the words that may end an entry: `rigid`, `from 0.1`, `to 0.2`. */
    struct Words
    {
      std::string before; // them
      bool        rigid = false;
      double      from = -grains::WallMotion::for_ever, to = grains::WallMotion::for_ever;
      bool        good = true;
    };

    Words read_words(const std::string &text)
    {
      Words              result;
      std::istringstream in(text);
      bool               begun = false;
      for (std::string word; in >> word;)
        {
          while (!word.empty() && word.back() == ',' && begun)
            word.pop_back();
          const bool time = word == "from" || word == "to" || word == "until";
          if (!begun && word != "rigid" && !time)
            {
              result.before += (result.before.empty() ? "" : " ") + word;
              continue;
            }
          begun = true;
          if (word == "rigid")
            result.rigid = true;
          else if (std::string value; time && in >> value)
            {
              while (!value.empty() && value.back() == ',')
                value.pop_back();
              result.good = result.good && read_number(value, word == "from" ? result.from : result.to);
            }
          else if (!word.empty())
            result.good = false;
        }
      while (!result.before.empty() && (result.before.back() == ',' || result.before.back() == ' '))
        result.before.pop_back();
      result.good = result.good && result.from < result.to;
      return result;
    }
  } // namespace


  void WallSetup::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Extra walls",
                      extra_walls,
                      "Walls inside the domain that only the grains see, as `x1, y1 -> x2, y2; ...` [m], or with names "
                      "as `name: x1, y1 -> x2, y2; ...`; several may share a name.");
    prm.add_parameter(
      "Motion of walls",
      wall_motion,
      "Walls that move, by name, as `name: vx, vy; ...` [m/s], or `name: vx, vy, spin, x, y; ...` for one "
      "that turns at `spin` [rad/s], anticlockwise, about the point (x, y) [m], which moves along. A wall that does "
      "not turn moves by the part of its velocity across it; the part along it is that of a belt, unless `rigid` "
      "follows: `gate: 0, 0.2 rigid` lifts a gate. `from` and `to` limit a motion to an interval [s]: "
      "`gate: 0, 0.2 rigid from 0.1 to 0.15`; several entries for a wall add up. Formulas in t take `|` in place of "
      "commas: `piston: 0.01*sin(20*pi*t) | 0`. The fluid sees nothing of this.");
    prm.add_parameter("Presence of walls",
                      wall_presence,
                      "When walls are there, by name, as `name: to t; ...`, `name: from t; ...` or `name: from t1 to "
                      "t2; ...` [s]; others always are. A side of the domain vanishes only if it is named in "
                      "Domain/Open to grains, too: grains leave through it then. The fluid sees nothing of this.");
  }


  std::vector<grains::WallSegment> WallSetup::read_extra_walls() const
  {
    std::vector<grains::WallSegment> extra;
    for (const std::string &item : Utilities::split_string_list(extra_walls, ';'))
      {
        const auto          colon = item.find(':');
        const std::string   ends  = colon == std::string::npos ? item : item.substr(colon + 1);
        const auto          arrow = ends.find("->");
        std::vector<double> a, b;
        check_user(arrow != std::string::npos && read_numbers(ends.substr(0, arrow), a) &&
                     read_numbers(ends.substr(arrow + 2), b) && a.size() == 2 && b.size() == 2,
                   extra_name + ": expected `x1, y1 -> x2, y2; ...` or `name: x1, y1 -> x2, y2; ...` in metres, got '" +
                     item + "'.");
        check_user(colon == std::string::npos || !Utilities::trim(item.substr(0, colon)).empty(),
                   extra_name + ": '" + item + "' has no name before its ':'.");
        const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
        check_user(length >= magnitudes::smallest_length && length <= magnitudes::largest_length,
                   extra_name + ": the wall '" + item + "' " +
                     (length == 0. ? "has no length: its ends are the same point."
                                   : "is " + in_digits(length) + " m long; expected from " +
                                       in_digits(magnitudes::smallest_length) + " to " +
                                       in_digits(magnitudes::largest_length) + " m."));
        extra.push_back({{{a[0], a[1]}},
                         {{b[0], b[1]}},
                         {{0., 0.}},
                         colon == std::string::npos ? "extra wall " + std::to_string(extra.size() + 1)
                                                    : Utilities::trim(item.substr(0, colon))});
      }
    return extra;
  }


  void WallSetup::read_motion(const std::string &item, std::map<std::string, Motion> &motions) const
  {
    const auto        colon    = item.find(':');
    const std::string expected = motion_name +
                                 ": expected `name: vx, vy; ...` or `name: vx, vy, spin, x, y; ...`, "
                                 "with `rigid`, `from t`, `to t` after it if wanted, got '" +
                                 item + "'.";
    check_user(colon != std::string::npos, expected);
    const Words words = read_words(item.substr(colon + 1));
    check_user(words.good, expected);
    const std::string name = Utilities::trim(item.substr(0, colon));
    Motion           &m    = motions[name];
    m.written_in           = motion_name;
    m.rigid                = m.rigid || words.rigid;
    grains::WallMotion::Phase phase;
    phase.from = words.from;
    phase.to   = words.to;

    std::vector<double> x;
    bool                turns = false;
    if (words.before.find('|') == std::string::npos)
      {
        check_user(read_numbers(words.before, x) && (x.size() == 2 || x.size() == 5), expected);
        turns          = x.size() == 5;
        phase.velocity = {{x[0], x[1], turns ? x[2] : 0.}};
        for (unsigned int d = 0; d < 2; ++d)
          m.may_go[d] = m.may_go[d] || x[d] != 0.;
      }
    else
      {
        auto texts = Utilities::split_string_list(words.before, '|');
        turns      = texts.size() == 5;
        x.resize(5);
        check_user(texts.size() == 2 || (turns && read_number(texts[3], x[3]) && read_number(texts[4], x[4])),
                   motion_name +
                     ": expected `name: vx | vy; ...` or `name: vx | vy | spin | x | y; ...`, of which x "
                     "and y are numbers, got '" +
                     item + "'.");
        texts.resize(turns ? 3 : 2);
        if (!turns)
          texts.push_back("0");
        for (const auto &text : texts)
          check_user(!mentions(text, "x") && !mentions(text, "y"),
                     motion_name + ": a wall moves as a whole, its velocity may depend on t only, got '" + item + "'.");
        const auto function = parse_expressions(motion_name, texts, {{"pi", numbers::PI}});
        phase.text          = words.before;
        phase.at_time       = [function, name, text = phase.text](const double t) {
          grains::WallMotion::Velocity v;
          function->set_time(t);
          for (unsigned int d = 0; d < 3; ++d)
            {
              v[d] = function->value(Point<2>(), d);
              check_user(std::isfinite(v[d]),
                         motion_name + ": '" + name + "': '" + text + "' is " + in_digits(v[d]) +
                           " at t = " + in_digits(t) + " s; expected finite numbers while it moves.");
            }
          return v;
        };
        phase.at_time(std::max(0., phase.from));
        for (unsigned int d = 0; d < 2; ++d)
          m.may_go[d] = m.may_go[d] || texts[d] != "0";
      }
    if (turns)
      {
        const std::array<double, 2> centre = {{x[3], x[4]}};
        check_user(!m.turns || centre == m.centre,
                   motion_name + ": a wall turns about one point, which moves along, got another one in '" + item +
                     "'.");
        m.turns  = true;
        m.centre = centre;
      }
    m.motion.phases.push_back(std::move(phase));
  }


  void WallSetup::read_presence(const std::string &item, std::map<std::string, Motion> &motions) const
  {
    const auto        colon = item.find(':');
    const std::string expected =
      presence_name + ": expected `name: to t; ...`, `name: from t; ...` or `name: from t1 to t2; ...`, got '" + item +
      "'.";
    check_user(colon != std::string::npos, expected);
    const Words words = read_words(item.substr(colon + 1));
    check_user(words.good && !words.rigid && words.before.empty() &&
                 (std::isfinite(words.from) || std::isfinite(words.to)),
               expected);
    const std::string name = Utilities::trim(item.substr(0, colon));
    Motion           &m    = motions[name];
    check_user(!m.motion.comes_or_goes(), presence_name + ": '" + name + "' stands there twice.");
    if (m.written_in.empty())
      m.written_in = presence_name;
    m.motion.present_from = words.from;
    m.motion.present_to   = words.to;
  }


  std::map<std::string, WallSetup::Motion> WallSetup::read_motions() const
  {
    std::map<std::string, Motion> motions;
    for (const std::string &item : Utilities::split_string_list(wall_motion, ';'))
      read_motion(item, motions);
    for (const std::string &item : Utilities::split_string_list(wall_presence, ';'))
      read_presence(item, motions);
    return motions;
  }


  std::vector<grains::WallSegment> WallSetup::walls(const mesh::Domain<2> &domain) const
  {
    const std::vector<grains::WallSegment> extra   = read_extra_walls();
    const std::map<std::string, Motion>    motions = read_motions();
    for (const grains::WallSegment &wall : extra)
      {
        check_user(domain.boundary_ids().count(wall.name) == 0,
                   extra_name + ": '" + wall.name +
                     "' is the name of a boundary of the domain; what is said of it would hold for both. Choose "
                     "another one.");
        const auto m = motions.find(wall.name);
        check_user(reaches_into(domain, wall) || (m != motions.end() && m->second.motion.ever_acts()),
                   extra_name + ": '" + wall.name + "' from (" + in_digits(wall.a[0]) + ", " + in_digits(wall.a[1]) +
                     ") to (" + in_digits(wall.b[0]) + ", " + in_digits(wall.b[1]) +
                     ") m is outside the domain, which reaches from (" + in_digits(domain.lower()[0]) + ", " +
                     in_digits(domain.lower()[1]) + ") to (" + in_digits(domain.upper()[0]) + ", " +
                     in_digits(domain.upper()[1]) + ") m. Lengths are in metres.");
      }
    const auto            periodicity = domain.periodicity();
    const auto           &open        = domain.open_to_grains_names();
    std::set<std::string> always;
    for (const auto &wall : domain.walls())
      always.insert(wall.name);

    // Positions are kept in the box: its own walls end where it does, only what stands in it shows again beside it.
    std::vector<grains::WallSegment> result = domain.walls();
    for (const auto &side : domain.sides()) // open at some times only
      if (const auto m = motions.find(side.name);
          m != motions.end() && m->second.motion.comes_or_goes() && std::count(open.begin(), open.end(), side.name) > 0)
        result.push_back(side);
    for (const auto &wall : grains::with_images(extra, periodicity))
      result.push_back(wall);

    for (const auto &[name, m] : motions)
      {
        const auto  motion = std::make_shared<const grains::WallMotion>(m.motion);
        bool        found  = false;
        std::string known;
        for (auto &wall : result)
          {
            if (known.find("'" + wall.name + "'") == std::string::npos)
              known += (known.empty() ? "'" : ", '") + wall.name + "'";
            if (wall.name != name)
              continue;
            found              = true;
            wall.motion        = motion;
            wall.rigid         = m.rigid;
            wall.centre        = m.centre;
            wall.present       = motion->is_present(0.);
            const bool along_x = wall.a[1] == wall.b[1], along_y = wall.a[0] == wall.b[0];
            const bool belt = !m.turns && !m.rigid &&
                              (std::all_of(m.motion.phases.begin(), m.motion.phases.end(), [&](const auto &phase) {
                                return phase.at_time ? (!m.may_go[0] || along_x) && (!m.may_go[1] || along_y)
                                                     : (wall.b[0] - wall.a[0]) * phase.velocity[1] ==
                                                         (wall.b[1] - wall.a[1]) * phase.velocity[0];
                              }));
            check_user(!periodicity.any() || belt ||
                         (!m.turns && (!m.may_go[0] || periodicity.length[0] == 0.) &&
                          (!m.may_go[1] || periodicity.length[1] == 0.)),
                       motion_name + ": '" + name + "' would leave a domain that is periodic; belts do not.");
          }
        check_user(found, m.written_in + ": there is no wall '" + name + "'. The walls are " + known + ".");
        check_user(!m.motion.comes_or_goes() || always.count(name) == 0,
                   presence_name + ": '" + name +
                     "' is a side of the domain: where it is not, grains leave. Name it "
                     "in Domain/Open to grains, too.");
      }
    return result;
  }
} // namespace alluvium::run
