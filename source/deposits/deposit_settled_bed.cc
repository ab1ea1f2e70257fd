#include <alluvium/deposits/deposit_box.h>
#include <alluvium/deposits/deposit_cache.h>
#include <alluvium/deposits/deposit_fit.h>
#include <alluvium/deposits/deposit_pour.h>
#include <alluvium/deposits/deposit_room.h>
#include <alluvium/deposits/deposit_settle.h>
#include <alluvium/deposits/deposit_table.h>
#include <alluvium/grains/grain_arrays.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/plugin.h>
#include <alluvium/utilities/random_numbers.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>
#include <tuple>

namespace alluvium::deposits
{
  namespace
  {
    std::string exact(const double value)
    {
      char text[32];
      std::snprintf(text, sizeof text, "%a", value);
      return text;
    }
  } // namespace

  /**
   * A random bed at rest on the floor of its box, and on and between the walls in it: poured geometrically as if there
   * were none, without the discs that they leave no room or no way for, then let go under gravity with the contact
   * solver until it stands still and the walls carry its weight. Made once and kept in the cache folder.
   */
  class SettledBed : public Deposit
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      using namespace dealii::Patterns;
      prm.add_parameter("Box", box_text, deposit_box_prose);
      prm.add_parameter("Number of grains", n_wanted, "How many. 0: as many as 'Bed height' takes.", Integer(0));
      prm.add_parameter(
        "Bed height",
        height,
        "Height of the bed [m], used if the number of grains is 0: grains whose top is above it are taken away.",
        Double(0.));
      prm.add_parameter("Smallest diameter", d_min, "[m]", Double(0.));
      prm.add_parameter(
        "Size ratio", ratio, "Largest over smallest diameter [-]; diameters are uniform in between.", Double(1.));
      prm.add_parameter("Seed", seed, "Of the random numbers: another seed gives another bed.", Integer(0));
      prm.add_parameter(
        "Friction while settling",
        friction,
        "Coulomb friction between grains and with the walls while the bed is made [-]. A bed stands only where "
        "friction is at least as large later. Poured beds have a packing near 0.81; below 0.3, friction makes them "
        "denser.",
        Double(0.));
      prm.add_parameter(
        "Packing fraction",
        packing,
        "If above 0, pour loosely and look for the friction while settling that gives this packing fraction inside "
        "the bed: about 0.78 (friction 1) to 0.83 (0.03). Beds of more than 4,000 grains, and beds by height, take "
        "what "
        "fits one of 2,000, and may be off by 0.01; so do beds among walls.",
        Double(0., 0.91));
      prm.add_parameter(
        "Cache folder",
        cache,
        "Where settled beds are kept, relative to the parameter file, under a name that depends on everything "
        "that made them; not where it cannot be written. Empty: settle anew every time.");
    }

    bool falls() const override { return true; }

    void parse_parameters() override
    {
      check_diameter("settled bed", "Smallest diameter", d_min);
      check_user(n_wanted > 0 || height > 0.,
                 "The deposit 'settled bed' has no grains: set its 'Number of grains' or 'Bed height'.");
    }

    std::vector<NewGrain> make(const DepositContext &context) const override
    {
      const DepositBox box = parse_deposit_box(box_text, context);
      check_user(box.width() > 2. * d_min * ratio, "The deposit 'settled bed': its box is narrower than two grains.");
      check_user(!box.periodic[0] || box.width() > 4. * d_min * ratio,
                 "The deposit 'settled bed': its box is periodic and narrower than four grains.");
      check_fits(box);
      if (context.warnings && !has_floor(context, box))
        context.warnings->push_back("The deposit 'settled bed' is made on a floor at the lower end of its box, but in "
                                    "the run no wall is there: the bed will fall. See Grains/Extra walls.");
      const DepositRoom room(context, box, 0.5 * d_min, 0.5 * d_min * ratio);

      // The bed settles along the axis nearest to gravity, whatever way the scene is tilted.
      const double g_scene = std::hypot(context.gravity[0], context.gravity[1]), g = g_scene > 0. ? g_scene : 9.81;
      if (cache.empty())
        return checked(settle(context, box, room, g).first, box);

      const DepositCache    kept(path_from(context.directory, cache), write_recipe(context, box, room, g));
      std::vector<NewGrain> new_grains;
      std::string           remark;
      if (kept.read(new_grains, remark))
        return checked(new_grains, box);
      if (!remark.empty() && context.warnings)
        context.warnings->push_back(remark);
      SettledState state;
      std::tie(new_grains, state) = settle(context, box, room, g);
      if (context.may_write)
        try
          {
            kept.write(new_grains, describe(state));
          }
        catch (const UserError &error)
          {
            if (context.warnings)
              context.warnings->push_back(std::string("The settled bed is not kept for other runs. ") + error.what());
          }
      return checked(new_grains, box);
    }

  private:
    /** Is there a wall below the box, where nothing else could bear the bed? */
    static bool has_floor(const DepositContext &context, const DepositBox &box)
    {
      // other boundaries, and walls that lie aslant, may bear it, too
      if (!context.moves || !context.sides.empty() || !(context.gravity[1] < 0.))
        return true;
      const double tolerance = 1e-6 * box.height();
      return std::any_of(context.walls.begin(), context.walls.end(), [&](const grains::WallSegment &wall) {
        const bool below = std::min(wall.a[1], wall.b[1]) <= box.lower[1] + tolerance &&
                           std::max(wall.a[1], wall.b[1]) >= box.lower[1] - tolerance;
        return below && wall.a[0] != wall.b[0] && std::max(wall.a[0], wall.b[0]) > box.lower[0] &&
               std::min(wall.a[0], wall.b[0]) < box.upper[0];
      });
    }

    /** Refuse what cannot fit before anything is poured. */
    void check_fits(const DepositBox &box) const
    {
      const double area = uniform_disc_area(d_min, ratio), n = n_wanted > 0 ? n_wanted : most_grains(box, height);
      check_number(what, n, box, d_min * ratio);
      if (n_wanted > 0)
        check_area(what, n, area, box);
      else
        check_user(height <= box.height() + 2. * d_min * ratio,
                   "The deposit '" + std::string(what) + "' is to be " + in_digits(height) +
                     " m high, its box is only " + in_digits(box.height()) + " m.");
    }

    /** Grains of a dense bed of @p height. */
    double most_grains(const DepositBox &box, const double height) const
    {
      return 0.84 * box.width() * (height + 2. * d_min * ratio) / uniform_disc_area(d_min, ratio);
    }

    static constexpr const char *what = "settled bed";

    unsigned int n_wanted = 2000, seed = 1;
    double       height = 0., d_min = 2e-4, ratio = 1.2, friction = 0.4, packing = 0.;
    std::string  cache = "deposits", box_text;

    /** Everything that makes the bed what it is; versions stand for the code. */
    std::string
    write_recipe(const DepositContext &context, const DepositBox &box, const DepositRoom &room, const double g) const
    {
      std::string recipe = "settled bed, version 3, settled by version " + std::to_string(settling_version) + "\n";
      for (const auto &[name, value] : {std::make_pair("x0", box.lower[0]),
                                        std::make_pair("y0", box.lower[1]),
                                        std::make_pair("x1", box.upper[0]),
                                        std::make_pair("number", double(n_wanted)),
                                        std::make_pair("height", n_wanted > 0 ? 0. : height),
                                        std::make_pair("d_min", d_min),
                                        std::make_pair("ratio", ratio),
                                        std::make_pair("seed", double(seed)),
                                        std::make_pair("friction", packing > 0. ? 0. : friction),
                                        std::make_pair("packing", packing),
                                        std::make_pair("periodic", double(box.periodic[0])),
                                        std::make_pair("density", context.density),
                                        std::make_pair("gravity", g)})
        recipe += std::string(name) + " = " + exact(value) + "\n";
      if (!room.empty())
        recipe += "walls: " + room.in_digits() + "\n";
      return recipe;
    }

    /** What was measured when the bed was made, for whoever opens its file. */
    static std::string describe(const SettledState &state)
    {
      std::ostringstream text;
      text << "measured: packing fraction " << state.packing << ", " << state.n_steps << " steps, speed left "
           << state.speed << " m/s, support over weight " << state.support << ", mean penetration "
           << state.mean_penetration << " m\n";
      return text.str();
    }

    static std::vector<NewGrain> checked(std::vector<NewGrain> new_grains, const DepositBox &box)
    {
      double top = box.lower[1];
      for (const NewGrain &s : new_grains)
        top = std::max(top, s.y + s.radius);
      check_user(top <= box.upper[1],
                 "The deposit 'settled bed' is " + in_digits(top - box.lower[1]) + " m high, its box only " +
                   in_digits(box.upper[1] - box.lower[1]) + " m.");
      return new_grains;
    }

    std::vector<NewGrain>
    pour(const DepositContext &context, const DepositBox &box, const double looseness, const unsigned int n) const
    {
      return pour(context, box, looseness, n, height);
    }

    /** Pour discs until there are @p n of them or, if n is 0, enough for a bed of @p height [m]. */
    std::vector<NewGrain> pour(const DepositContext &context,
                               const DepositBox     &box,
                               const double          looseness,
                               const unsigned int    n,
                               const double          height) const
    {
      RandomNumbers         random(seed);
      Pour                  pour(box, 0.5 * d_min * ratio, looseness);
      std::vector<NewGrain> new_grains;
      double                area = 0.;
      // By height: as many as a bed of packing 0.84 would have, and two layers more.
      const double enough = 0.84 * box.width() * (height + 2. * d_min * ratio);
      while (n > 0 ? new_grains.size() < n : area < enough)
        {
          const double r = 0.5 * d_min * random.uniform(1., ratio);
          const auto   p = pour.add(r, random);
          new_grains.push_back({p[0], p[1], r, context.density});
          area += grains::disc_volume(r);
          // Rolled discs lie nearly as dense as they will: a tenth of the height is more than settling gains.
          check_user(looseness > 0. || n == 0 || p[1] < box.lower[1] + 1.15 * box.height() + 4. * d_min * ratio,
                     "The deposit 'settled bed' cannot fit: " + std::to_string(new_grains.size()) + " of its " +
                       std::to_string(n) + " grains fill its box of " + in_digits(box.width()) + " m x " +
                       in_digits(box.height()) + " m.");
        }
      return new_grains;
    }

    /**
     * The same among walls: discs that lie in them, or where none gets to from above, are left out. Where they were,
     * others will sink in: two layers more.
     */
    std::vector<NewGrain>
    pour(const DepositContext &context, const DepositBox &box, const DepositRoom &room, const double looseness) const
    {
      if (room.empty())
        return pour(context, box, looseness, n_wanted);
      const double          layers = 4. * d_min * ratio;
      std::vector<NewGrain> new_grains;
      for (unsigned int n = n_wanted;;)
        {
          // the same random numbers: what there was before is poured again, and more
          const std::vector<NewGrain> poured =
            n_wanted > 0 ? pour(context, box, looseness, n) : pour(context, box, looseness, 0, height + layers);
          const std::vector<bool> reachable = room.reachable(poured);
          new_grains.clear();
          for (std::size_t k = 0; k < poured.size(); ++k)
            if (reachable[k])
              new_grains.push_back(poured[k]);
          if (n_wanted == 0)
            break;
          if (new_grains.size() >= n_wanted)
            {
              std::stable_sort(
                new_grains.begin(), new_grains.end(), [](const NewGrain &a, const NewGrain &b) { return a.y < b.y; });
              new_grains.resize(n_wanted);
              break;
            }
          n += std::max<unsigned int>(1.1 * (n_wanted - new_grains.size()), n / 20 + 1);
          check_user(n < 100. * n_wanted + 1e4,
                     "The deposit 'settled bed' finds no way into its box from above: walls close it.");
        }
      check_user(!new_grains.empty(), "The deposit 'settled bed' has no grains: walls leave no room in its box.");
      return new_grains;
    }

    std::pair<std::vector<NewGrain>, SettledState>
    settle(const DepositContext &context, const DepositBox &box, const DepositRoom &room, const double g) const
    {
      const double   looseness = packing > 0. ? loose : 0.;
      const Settling settling{
        box, g, packing > 0. ? find_friction(context, box, room, g) : friction, packing > 0., room.walls()};
      std::vector<NewGrain> new_grains = pour(context, box, room, looseness);
      SettledState          state      = bring_to_rest(settling, new_grains);
      if (n_wanted == 0)
        {
          const double top = box.lower[1] + height;
          new_grains.erase(std::remove_if(new_grains.begin(),
                                          new_grains.end(),
                                          [top](const NewGrain &s) { return s.y + s.radius > top; }),
                           new_grains.end());
          check_user(!new_grains.empty(),
                     "The deposit 'settled bed' has no grains: its 'Bed height' is less than one.");
          state = bring_to_rest({box, g, settling.friction, false, room.walls()}, new_grains);
        }
      return {new_grains, state};
    }

    /**
     * Friction that gives the wanted packing to this bed if it is small, to a small one of the same grains otherwise:
     * bisection, since friction makes beds looser; then the best that was seen, since chance has its part too.
     */
    double
    find_friction(const DepositContext &context, const DepositBox &box, const DepositRoom &room, const double g) const
    {
      const bool         small  = n_wanted > 0 && n_wanted <= 4000 && room.empty();
      const unsigned int n      = small ? n_wanted : 2000; // without walls
      const double       width  = small ? box.width() : 45. * d_min * ratio;
      const DepositBox   sample = {
          box.lower, {{box.lower[0] + width, box.lower[1] + 1e3 * width}}, {{box.periodic[0], false}}};
      double     best = 0., best_off = std::numeric_limits<double>::max();
      const auto packing_at = [&](const double mu) {
        std::vector<NewGrain> new_grains = pour(context, sample, loose, n);
        const double          now        = bring_to_rest({sample, g, mu, true, {}}, new_grains).packing;
        if (std::abs(now - packing) < best_off)
          {
            best     = mu;
            best_off = std::abs(now - packing);
          }
        return now;
      };
      double       low = 0.03, high = 1.;
      const double densest = packing_at(low), loosest = packing_at(high);
      check_user(packing <= densest && packing >= loosest,
                 "The deposit 'settled bed' cannot have the packing fraction " + in_digits(packing) +
                   ": friction gives it " + in_digits(loosest) + " to " + in_digits(densest) + ".");
      for (unsigned int k = 0; k < 6 && best_off > 2e-3; ++k)
        {
          const double mu                         = std::sqrt(low * high);
          (packing_at(mu) > packing ? low : high) = mu;
        }
      return best;
    }

    static constexpr double loose = 0.3; // share of discs that do not roll when poured for a wanted packing
  };

  ALLUVIUM_REGISTER(Deposit,
                    SettledBed,
                    "settled bed",
                    "a random bed at rest on the floor of the domain, among the walls that stand in it.")
} // namespace alluvium::deposits
