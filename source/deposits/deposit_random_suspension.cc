#include <alluvium/deposits/deposit_box.h>
#include <alluvium/deposits/deposit_fit.h>
#include <alluvium/deposits/deposit_room.h>
#include <alluvium/grains/grain_arrays.h>
#include <alluvium/utilities/plugin.h>
#include <alluvium/utilities/random_numbers.h>

#include <algorithm>
#include <cmath>

namespace alluvium::deposits
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
      prm.add_parameter(
        "Area fraction",
        area_fraction,
        "Disc area over area of the box, as far as it is in the domain [-]. Throwing discs at random ends near 0.5.",
        Double(0., 1.));
      prm.add_parameter(
        "Smallest gap", gap, "Between any two discs, and between discs and the box or walls [m].", Double(0.));
      prm.add_parameter("Seed", seed, "Of the random numbers.", Integer(0));
      prm.add_parameter("Box", box_text, deposit_box_prose);
    }

    void parse_parameters() override
    {
      check_diameter("random suspension", "Smallest diameter", d_min);
    }

    std::vector<NewGrain> make(const DepositContext &context) const override
    {
      const DepositBox  box = parse_deposit_box(box_text, context);
      const DepositRoom room(context, box, 0.5 * d_min, 0.5 * d_min * ratio + gap);
      const double      area = room.area();
      check_number("random suspension", area_fraction * area / uniform_disc_area(d_min, ratio), box, d_min * ratio);
      RandomNumbers       random(seed);
      std::vector<double> radii;
      for (double filled = 0.;;)
        {
          const double r = 0.5 * d_min * random.uniform(1., ratio);
          filled += grains::disc_volume(r);
          if (filled > area_fraction * area)
            break;
          radii.push_back(r);
        }
      check_user(!radii.empty(), "The deposit 'random suspension' has no grains: not one disc fits its area fraction.");
      std::sort(radii.rbegin(), radii.rend()); // the large ones first, while there is room

      // Few discs in a wide box need few cells.
      double cell = d_min * ratio + gap;
      while (area / (cell * cell) > 1e4 + 8. * radii.size())
        cell *= 1.5;
      // In a periodic direction the cells fill the box.
      const auto n_cells = [&](const double length, const bool periodic) {
        return periodic ? std::max(1, static_cast<int>(length / cell)) : static_cast<int>(length / cell) + 1;
      };
      const int    nx = n_cells(box.width(), box.periodic[0]), ny = n_cells(box.height(), box.periodic[1]);
      const double width                                = box.periodic[0] ? box.width() / nx : cell,
                   height                               = box.periodic[1] ? box.height() / ny : cell;
      const grains::Periodicity             periodicity = box.periodicity();
      std::vector<std::vector<std::size_t>> members(static_cast<std::size_t>(nx) * ny);
      std::vector<NewGrain>                 new_grains;
      const std::vector<std::size_t>        nobody;
      const auto                            members_at = [&](int p, int q) -> const std::vector<std::size_t>                            &{
        if (box.periodic[0])
          p = (p + nx) % nx;
        if (box.periodic[1])
          q = (q + ny) % ny;
        return p < 0 || p >= nx || q < 0 || q >= ny ? nobody : members[static_cast<std::size_t>(q) * nx + p];
      };
      constexpr unsigned int n_tries = 20000;
      for (const double r : radii)
        {
          const double margin = r + gap, margin_x = box.periodic[0] ? 0. : margin,
                       margin_y = box.periodic[1] ? 0. : margin;
          check_user(box.width() > 2. * margin && box.height() > 2. * margin,
                     "The deposit 'random suspension': its box is smaller than a disc.");
          bool placed = false;
          for (unsigned int attempt = 0; attempt < n_tries && !placed; ++attempt)
            {
              const double x      = random.uniform(box.lower[0] + margin_x, box.upper[0] - margin_x);
              const double y      = random.uniform(box.lower[1] + margin_y, box.upper[1] - margin_y);
              const int    column = std::min(nx - 1, static_cast<int>((x - box.lower[0]) / width)),
                        row       = std::min(ny - 1, static_cast<int>((y - box.lower[1]) / height));
              placed              = room.fits(x, y, margin);
              for (int q = row - 1; q <= row + 1 && placed; ++q)
                for (int p = column - 1; p <= column + 1 && placed; ++p)
                  for (const std::size_t k : members_at(p, q))
                    {
                      double       dx = new_grains[k].x - x, dy = new_grains[k].y - y;
                      const double reach = new_grains[k].radius + margin;
                      periodicity.shorten(dx, dy);
                      placed = placed && dx * dx + dy * dy >= reach * reach;
                    }
              if (placed)
                {
                  members[static_cast<std::size_t>(row) * nx + column].push_back(new_grains.size());
                  new_grains.push_back({x, y, r, context.density});
                }
            }
          check_user(placed,
                     "The deposit 'random suspension' found no room for disc " + std::to_string(new_grains.size() + 1) +
                       " of " + std::to_string(radii.size()) + ": lower its area fraction or its smallest gap.");
        }
      return new_grains;
    }

  private:
    double       d_min = 2e-4, ratio = 1.2, area_fraction = 0.3, gap = 0.;
    unsigned int seed = 1;
    std::string  box_text;
  };

  ALLUVIUM_REGISTER(Deposit, RandomSuspension, "random suspension", "discs at random places that do not touch.")
} // namespace alluvium::deposits
