#include <alluvium/deposits/deposit_box.h>
#include <alluvium/deposits/deposit_fit.h>
#include <alluvium/deposits/deposit_room.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/plugin.h>

#include <cmath>

namespace alluvium::deposits
{
  /** Equal discs on a square lattice: the bed of drag tests, whose drag is known exactly. */
  class Lattice : public Deposit
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      using namespace dealii::Patterns;
      prm.add_parameter("Diameter", diameter, "Of all discs [m].", Double(0.));
      prm.add_parameter("Area fraction",
                        area_fraction,
                        "Disc area over area of a lattice cell [-], at most pi/4. Used if 'Spacing' is 0.",
                        Double(0., 0.785398163397449));
      prm.add_parameter("Spacing",
                        spacing,
                        "Distance of neighbouring centres [m]; a little more in the directions in which the domain is "
                        "periodic, so that "
                        "whole cells fill it. 0: what the area fraction makes it.",
                        Double(0.));
      prm.add_parameter("Box", box_text, deposit_box_prose);
    }

    void parse_parameters() override
    {
      check_diameter("lattice", "Diameter", diameter);
    }

    std::vector<NewGrain> make(const DepositContext &context) const override
    {
      const double a = spacing > 0. ? spacing : diameter * std::sqrt(M_PI / 4. / area_fraction);
      check_user(std::isfinite(a), "The deposit 'lattice' needs a positive 'Area fraction' or 'Spacing'.");
      check_user(a >= diameter * (1. - 1e-12),
                 "The deposit 'lattice' has a spacing of " + in_digits(a / diameter) +
                   " diameters: the discs overlap.");
      const DepositBox box = parse_deposit_box(box_text, context);

      check_number("lattice", box.width() / a * (box.height() / a), box, diameter);

      // As many whole cells as fit, centred in the box.
      const int nx = static_cast<int>(box.width() / a + 1e-9), ny = static_cast<int>(box.height() / a + 1e-9);
      check_user(nx > 0 && ny > 0, "The deposit 'lattice' has no grains: its box is smaller than one lattice cell.");
      // Across periodic boundaries it goes on evenly.
      const double          ax = box.periodic[0] ? box.width() / nx : a, ay = box.periodic[1] ? box.height() / ny : a;
      const DepositRoom     room(context, box, 0.5 * diameter, 0.5 * diameter);
      std::vector<NewGrain> new_grains;
      for (int row = 0; row < ny; ++row)
        for (int column = 0; column < nx; ++column)
          {
            const double x = 0.5 * (box.lower[0] + box.upper[0]) + (column - 0.5 * (nx - 1)) * ax,
                         y = 0.5 * (box.lower[1] + box.upper[1]) + (row - 0.5 * (ny - 1)) * ay;
            if (room.fits(x, y, 0.5 * diameter))
              new_grains.push_back({x, y, 0.5 * diameter, context.density});
          }
      check_user(!new_grains.empty(), "The deposit 'lattice' has no grains: walls leave no room in its box.");
      return new_grains;
    }

  private:
    double      diameter = 2e-4, area_fraction = 0.5, spacing = 0.;
    std::string box_text;
  };

  ALLUVIUM_REGISTER(Deposit, Lattice, "lattice", "equal discs on a square lattice, where walls leave room.")
} // namespace alluvium::deposits
