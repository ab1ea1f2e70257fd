#include <alluvium/fluid/cell_order.h>
#include <alluvium/fluid/largest_speed.h>
#include <alluvium/refinement/marked_criterion.h>
#include <alluvium/utilities/plugin.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/component_mask.h>
#include <deal.II/grid/tria.h>
#include <deal.II/numerics/error_estimator.h>

#include <cmath>

namespace alluvium::refinement
{
  namespace
  {
    /**
     * The estimator of Kelly et al. (1983) for the velocity: jumps of its gradient over the faces. With linear elements
     * it falls like h^2 where the velocity is smooth, so the size that meets a tolerance is h sqrt(tolerance/estimate).
     */
    class VelocityJumpCriterion : public MarkedCriterion
    {
    public:
      VelocityJumpCriterion()
        : MarkedCriterion(true)
      {}

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter("Tolerance",
                          tolerance,
                          "Kelly's estimate of a cell's error in the velocity may be this much of the largest "
                          "velocity, [-]. Sizes are let go at 0.7 of what would do.",
                          dealii::Patterns::Double(1e-6));
        marks.add_parameters(prm, 0.);
      }

    private:
      void mark(const RefinementContext &context) override
      {
        const fluid::FluidSpace<2> &space   = context.fluid->space;
        const double                largest = fluid::largest_speed(space, context.fluid->solution.block(0));
        if (largest == 0.)
          return;
        dealii::Vector<float> estimate(space.triangulation().n_active_cells());
        dealii::KellyErrorEstimator<2>::estimate(space.mapping(),
                                                 space.dof_handler(),
                                                 dealii::QGauss<1>(2),
                                                 {},
                                                 context.fluid->solution,
                                                 estimate,
                                                 dealii::ComponentMask({true, true, false}));
        unsigned int c = 0;
        for (const auto &cell : fluid::ordered_cells(space.dof_handler())) // as space.cells()
          if (cell->is_locally_owned())
            {
              const auto     &data   = space.cells()[c++];
              const double    error  = estimate[cell->active_cell_index()] / largest;
              const double    wanted = data.size * std::sqrt(tolerance / std::max(error, 1e-12));
              const mesh::Box box    = box_around(data, space.n_nodes_per_cell());
              marks.add(box, wanted);
            }
      }

      double tolerance = 0.02;
    };
  } // namespace

  ALLUVIUM_REGISTER(
    RefinementCriterion,
    VelocityJumpCriterion,
    "velocity jump",
    "as fine as Kelly's estimator of the velocity's error asks for: jets, shear layers, boundary layers.")
} // namespace alluvium::refinement
