#include <alluvium/refinement/refinement_criterion.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/expression.h>
#include <alluvium/utilities/plugin.h>

#include <deal.II/base/numbers.h>

#include <algorithm>

namespace alluvium::refinement
{
  namespace
  {
    /** The size that a formula gives. */
    class FunctionCriterion : public RefinementCriterion
    {
    public:
      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Cell size",
          text,
          "Size of the cells in mean grain diameters (h/d), a formula in x and y [m] and t [s], in which d is "
          "the mean grain diameter at t = 0 [m] and pi is known: for example `if(abs(x - 0.1 - 0.02*t) < 5*d, 1, "
          "8)`. It is looked at in nine points of a cell.",
          dealii::Patterns::Anything());
      }

      void parse_parameters() override { parse(1.); } // whether it can be understood, before grains take their time

      void prepare(const RefinementContext &context) override
      {
        if (!function)
          function = parse(context.initial_diameter);
        function->set_time(context.time);
      }

      double wanted_size(const mesh::Box &box, const RefinementContext &context, const Purpose) const override
      {
        double result = no_wish;
        for (const double a : {0., 0.5, 1.})
          for (const double b : {0., 0.5, 1.})
            {
              const dealii::Point<2> point(box.lower[0] + a * (box.upper[0] - box.lower[0]),
                                           box.lower[1] + b * (box.upper[1] - box.lower[1]));
              result = std::min(result, size_at(point) * context.grain_diameter);
            }
        return result;
      }

      void check_until(const double end_time, const RefinementContext &context) override
      {
        if (!mentions(text, "t"))
          return;
        prepare(context);
        constexpr unsigned int n_times = 100, n_points = 20;
        for (unsigned int k = 0; k <= n_times; ++k)
          {
            function->set_time(context.time + k * (end_time - context.time) / n_times);
            for (unsigned int i = 0; i <= n_points; ++i)
              for (unsigned int j = 0; j <= n_points; ++j)
                {
                  dealii::Point<2> point;
                  for (unsigned int d = 0; d < 2; ++d)
                    point[d] = context.domain.lower[d] + (d == 0 ? i : j) / double(n_points) *
                                                           (context.domain.upper[d] - context.domain.lower[d]);
                  size_at(point);
                }
          }
        function->set_time(context.time);
      }

    private:
      /** In mean grain diameters. */
      double size_at(const dealii::Point<2> &point) const
      {
        const double size = function->value(point);
        if (!(size > 0.)) // the message is expensive, and this is asked for every cell
          throw UserError("Mesh refinement/Criteria: function/Cell size: '" + text + "' is " + in_digits(size) +
                          " at x = " + in_digits(point[0]) + ", y = " + in_digits(point[1]) +
                          ", t = " + in_digits(function->get_time()) + "; sizes must be positive.");
        return size;
      }

      std::shared_ptr<dealii::Function<2>> parse(const double diameter) const
      {
        return parse_expressions(
          "Mesh refinement/Criteria: function/Cell size", {text}, {{"d", diameter}, {"pi", dealii::numbers::PI}});
      }

      std::string                          text = "4";
      std::shared_ptr<dealii::Function<2>> function;
    };
  } // namespace

  ALLUVIUM_REGISTER(RefinementCriterion, FunctionCriterion, "function", "the size that a formula gives.")
} // namespace alluvium::refinement
