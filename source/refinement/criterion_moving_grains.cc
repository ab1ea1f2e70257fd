#include <alluvium/refinement/marked_criterion.h>
#include <alluvium/utilities/plugin.h>

#include <cmath>

namespace alluvium::refinement
{
  namespace
  {
    /** Fine around the grains that move: boils, fingers and slides, and not the bed that still stands. */
    class MovingGrainsCriterion : public MarkedCriterion
    {
    public:
      MovingGrainsCriterion()
        : MarkedCriterion(false)
      {}

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter("Cell size",
                          size,
                          "Size of the cells around moving grains, in mean grain diameters (h/d).",
                          dealii::Patterns::Double(1e-3));
        prm.add_parameter("Speed",
                          threshold,
                          "A grain moves if it is faster than this times sqrt(g d); one that moved is let go at 0.7 "
                          "of it.",
                          dealii::Patterns::Double(0.));
        marks.add_parameters(prm, 4.);
      }

    private:
      void mark(const RefinementContext &context) override
      {
        const double scale  = threshold * std::sqrt(context.gravity * context.grain_diameter);
        const auto  &grains = *context.grains;
        for (std::size_t i = 0; i < grains.n(); ++i)
          {
            const double    speed = std::hypot(grains.velocity[0][i], grains.velocity[1][i]);
            const mesh::Box box   = mesh::widened(
              {{{grains.position[0][i], grains.position[1][i]}}, {{grains.position[0][i], grains.position[1][i]}}},
              grains.radius[i]);
            marks.add_if_above(speed, scale, box, size * context.grain_diameter);
          }
      }

      double size = 1., threshold = 0.05;
    };
  } // namespace

  ALLUVIUM_REGISTER(RefinementCriterion,
                    MovingGrainsCriterion,
                    "moving grains",
                    "fine where grains move (boils, fingers, slides), coarse where they stand.")
} // namespace alluvium::refinement
