#include <alluvium/refinement/refinement_criterion.h>
#include <alluvium/utilities/plugin.h>

namespace alluvium::refinement
{
  namespace
  {
    /** The same size everywhere. */
    class UniformCriterion : public RefinementCriterion
    {
    public:
      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Cell size", size, "Size of all cells, in mean grain diameters (h/d).", dealii::Patterns::Double(1e-3));
      }

      double wanted_size(const mesh::Box &, const RefinementContext &context, const Purpose) const override
      {
        return coarsest_size(context);
      }

      double coarsest_size(const RefinementContext &context) const override
      {
        return context.grain_diameter > 0. ? size * context.grain_diameter : no_wish;
      }

      bool is_uniform() const override { return true; }

    private:
      double size = 2.;
    };
  } // namespace

  ALLUVIUM_REGISTER(RefinementCriterion, UniformCriterion, "uniform", "cells of one size everywhere.")
} // namespace alluvium::refinement
