#include <alluvium/grains/deposit_box.h>
#include <alluvium/grains/random_numbers.h>
#include <alluvium/utilities/plugin.h>

#include <algorithm>
#include <cmath>

namespace alluvium::grains
{
  /** Discs thrown one by one where there is room: random sequential adsorption. */
  class RandomSuspension : public Deposit
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      using namespace dealii::Patterns;
      prm.add_parameter("Smallest diameter", d_min, "[m]", Double(0.));
      prm.add_parameter(
        "Size ratio", ratio, "Largest over smallest diameter [-]; diameters are uniform in between.", Double(1.));
      prm.add_parameter("Area fraction",
                        area_fraction,
                        "Disc area over area of the box [-]. Throwing discs at random ends near 0.5.",
                        Double(0., 1.));
      prm.add_parameter("Smallest gap", gap, "Between any two discs, and between discs and the box [m].", Double(0.));
      prm.add_parameter("Seed", seed, "Of the random numbers.", Integer(0));
      prm.add_parameter("Box", box_text, deposit_box_prose);
    }

    std::vector<Seed> make(const DepositContext &context) const override
    {
      check_user(d_min > 0., "The deposit 'random suspension' needs a positive 'Smallest diameter'.");
      const DepositBox    box  = parse_deposit_box(box_text, context);
      const double        area = box.width() * box.height();
      RandomNumbers       random(seed);
      std::vector<double> radii;
      for (double filled = 0.;;)
        {
          const double r = 0.5 * d_min * random.uniform(1., ratio);
          filled += M_PI * r * r;
          if (filled > area_fraction * area)
            break;
          radii.push_back(r);
        }
      check_user(!radii.empty(), "The deposit 'random suspension' has no grains: not one disc fits its area fraction.");
      std::sort(radii.rbegin(), radii.rend()); // the large ones first, while there is room

      const double cell = d_min * ratio + gap;
      const int    nx = static_cast<int>(box.width() / cell) + 1, ny = static_cast<int>(box.height() / cell) + 1;
      std::vector<std::vector<std::size_t>> members(static_cast<std::size_t>(nx) * ny);
      std::vector<Seed>                     seeds;
      constexpr unsigned int                n_tries = 20000;
      for (const double r : radii)
        {
          const double margin = r + gap;
          check_user(box.width() > 2. * margin && box.height() > 2. * margin,
                     "The deposit 'random suspension': its box is smaller than a disc.");
          bool placed = false;
          for (unsigned int attempt = 0; attempt < n_tries && !placed; ++attempt)
            {
              const double x      = random.uniform(box.lower[0] + margin, box.upper[0] - margin);
              const double y      = random.uniform(box.lower[1] + margin, box.upper[1] - margin);
              const int    column = static_cast<int>((x - box.lower[0]) / cell),
                        row       = static_cast<int>((y - box.lower[1]) / cell);
              placed              = true;
              for (int q = std::max(0, row - 1); q <= std::min(ny - 1, row + 1) && placed; ++q)
                for (int p = std::max(0, column - 1); p <= std::min(nx - 1, column + 1) && placed; ++p)
                  for (const std::size_t k : members[static_cast<std::size_t>(q) * nx + p])
                    {
                      const double dx = seeds[k].x - x, dy = seeds[k].y - y, reach = seeds[k].radius + margin;
                      placed = placed && dx * dx + dy * dy >= reach * reach;
                    }
              if (placed)
                {
                  members[static_cast<std::size_t>(row) * nx + column].push_back(seeds.size());
                  seeds.push_back({x, y, r, context.density});
                }
            }
          check_user(placed,
                     "The deposit 'random suspension' found no room for disc " + std::to_string(seeds.size() + 1) +
                       " of " + std::to_string(radii.size()) + ": lower its area fraction or its smallest gap.");
        }
      return seeds;
    }

  private:
    double       d_min = 2e-4, ratio = 1.2, area_fraction = 0.3, gap = 0.;
    unsigned int seed = 1;
    std::string  box_text;
  };

  ALLUVIUM_REGISTER(Deposit, RandomSuspension, "random suspension", "discs at random places that do not touch.")
} // namespace alluvium::grains
