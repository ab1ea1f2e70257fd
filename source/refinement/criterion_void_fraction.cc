#include <alluvium/refinement/marked_criterion.h>
#include <alluvium/utilities/plugin.h>

#include <cmath>

namespace alluvium::refinement
{
  namespace
  {
    /** As fine as it takes to let the void fraction change by little over a cell. */
    class VoidFractionCriterion : public MarkedCriterion
    {
    public:
      VoidFractionCriterion()
        : MarkedCriterion(true)
      {}

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter("Change",
                          change,
                          "By how much the filtered void fraction may change over a cell, [-]. Sizes are let go at 0.7 "
                          "of it. With `Filter radius = grain` the void fraction of a fine mesh shows every single "
                          "grain, and this refines the whole bed.",
                          dealii::Patterns::Double(1e-3));
        marks.add_parameters(prm, 1.);
      }

    private:
      void mark(const RefinementContext &context) override
      {
        const fluid::FluidSpace<2> &space = context.fluid->space;
        const unsigned int          n     = space.n_nodes_per_cell();
        for (const auto &cell : space.cells())
          {
            // by the extreme values, not the gradient at the centre, which an alternating field hides from
            double low = 1., high = 0.;
            for (unsigned int v = 0; v < n; ++v)
              {
                const double eps = context.fluid->void_fraction.local_element(cell.node[v]);
                low              = std::min(low, eps);
                high             = std::max(high, eps);
              }
            const mesh::Box box = box_around(cell, n);
            marks.add(box, cell.size * change / (high - low + 1e-12));
          }
      }

      double change = 0.1;
    };
  } // namespace

  ALLUVIUM_REGISTER(RefinementCriterion,
                    VoidFractionCriterion,
                    "void fraction",
                    "fine where the filtered void fraction changes: at the faces of beds, in bubbles and channels.")
} // namespace alluvium::refinement
