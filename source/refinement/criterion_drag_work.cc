#include <alluvium/refinement/marked_criterion.h>
#include <alluvium/utilities/plugin.h>

#include <deal.II/base/mpi.h>

#include <cmath>

namespace alluvium::refinement
{
  namespace
  {
    /**
     * Fine where the flow works hardest on the grains. The power per area that drag takes is -u . grad p, p the reduced
     * pressure, wherever the flow is slow enough for drag to balance it.
     */
    class DragWorkCriterion : public MarkedCriterion
    {
    public:
      DragWorkCriterion()
        : MarkedCriterion(true)
      {}

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter("Cell size",
                          size,
                          "Size of the cells where the power is high, in mean grain diameters (h/d).",
                          dealii::Patterns::Double(1e-3));
        prm.add_parameter("Threshold",
                          threshold,
                          "The power per area is high above this times its mean over the cells with grains, [-]. A "
                          "place is let go at 0.7 of it.",
                          dealii::Patterns::Double(0.));
        marks.add_parameters(prm, 2.);
      }

    private:
      void mark(const RefinementContext &context) override
      {
        const fluid::FluidSpace<2> &space = context.fluid->space;
        std::vector<double>         power;
        std::array<double, 2>       sums{}; // power, area
        for (const auto &cell : space.cells())
          {
            power.push_back(power_in(context, cell));
            double eps = 0.;
            for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
              eps += context.fluid->void_fraction.local_element(cell.node[v]) / space.n_nodes_per_cell();
            if (eps < 0.95)
              {
                sums[0] += power.back() * cell.measure;
                sums[1] += cell.measure;
              }
          }
        for (double &sum : sums)
          sum = dealii::Utilities::MPI::sum(sum, space.communicator());
        const double mean = sums[1] > 0. ? sums[0] / sums[1] : 0.;
        for (std::size_t c = 0; c < power.size(); ++c)
          {
            const mesh::Box box = box_around(space.cells()[c], space.n_nodes_per_cell());
            marks.add_if_above(power[c], threshold * mean, box, size * context.grain_diameter);
          }
      }

      /** |u . grad p| [W/m^2], mean velocity times mean gradient. */
      double power_in(const RefinementContext &context, const fluid::CellData<2> &cell) const
      {
        const fluid::FluidSpace<2> &space = context.fluid->space;
        const unsigned int          n     = space.n_nodes_per_cell();
        std::array<double, 2>       u{}, gradient{};
        for (unsigned int v = 0; v < n; ++v)
          for (unsigned int d = 0; d < 2; ++d)
            {
              u[d] += context.fluid->solution.block(0).local_element(cell.velocity[v][d]) / n;
              for (unsigned int q = 0; q < space.n_q_points(); ++q)
                gradient[d] += cell.jxw[q] / cell.measure * cell.grad[q][v][d] *
                               context.fluid->solution.block(1).local_element(cell.pressure[v]);
            }
        return std::abs(u[0] * gradient[0] + u[1] * gradient[1]);
      }

      double size = 1., threshold = 3.;
    };
  } // namespace

  ALLUVIUM_REGISTER(
    RefinementCriterion,
    DragWorkCriterion,
    "drag work",
    "fine where the flow gives much more power to the grains than on average: constrictions, outlets, the "
    "tip of a pipe.")
} // namespace alluvium::refinement
