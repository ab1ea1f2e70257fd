#include <alluvium/coupling/time_scheme.h>

#include <deal.II/base/parameter_handler.h>

namespace alluvium::coupling
{
  namespace
  {
    /**
     * The semi-implicit scheme per grain, repeated with what the contacts made of it (ContactIteration) where the
     * velocities that the fluid saw are not those that the grains take.
     */
    class Iterated : public TimeScheme, public Composite<TimeScheme>
    {
    public:
      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Coupling iterations",
          limit.largest_number,
          "How often fluid and contacts are solved again in a step at most, with each other's result. They are not "
          "once that does not help any more, which is where contacts are solved to a larger tolerance: between fast "
          "grains.",
          dealii::Patterns::Integer(0, 1000));
        prm.declare_alias("Coupling iterations", "Repetitions");
        prm.add_parameter(
          "Tolerance",
          limit.tolerance,
          "A step is repeated while the forces that the grains feel and the fluid does not, because "
          "grains do not take the velocities that were predicted, are larger than this: root mean "
          "square over the grains, over the mean submerged weight or force of the fluid on a grain. Their "
          "sum shall be less than a tenth of this times the force of the fluid on all grains, and a "
          "step that is not repeated at all has a tenth of both tolerances.",
          dealii::Patterns::Double(0.));
      }

      // the second one is the first coupling iteration, which knows more
      unsigned int   n_sub_iterations() const override { return 1; }
      bool           predicts_acceleration() const override { return true; }
      IterationLimit iteration_limit() const override { return limit; }

      void exchange_terms(const CouplingState                  &state,
                          const unsigned int                    sub_iteration,
                          std::vector<fluid::PieceExchange<2>> &exchange) const override
      {
        once().exchange_terms(state, sub_iteration, exchange);
      }

      unsigned int n_load_sums() const override { return once().n_load_sums(); }

      void add_load_sums(const CouplingState &state, GrainSums &sums, const unsigned int first) const override
      {
        once().add_load_sums(state, sums, first);
      }

      void loads(const CouplingState                      &state,
                 const std::vector<std::array<double, 2>> &force,
                 const GrainSums                          &sums,
                 const unsigned int                        first,
                 grains::GrainLoads                       &loads) const override
      {
        once().loads(state, force, sums, first, loads);
      }

      std::vector<std::string> parts() const override { return {scheme}; }

    private:
      static constexpr const char *scheme = "semi-implicit per grain";

      TimeScheme &once() const { return part(scheme); }

      IterationLimit limit{10, 1e-2};
    };
  } // namespace

  ALLUVIUM_REGISTER_TIME_SCHEME(
    Iterated,
    "iterated",
    "The semi-implicit scheme per grain, repeated with the new contact forces until fluid and grains agree on the "
    "grains' velocities: right from the first step in jammed beds whose load jumps, and where grains begin to move the "
    "fluid gets the momentum that they got. A bed at rest is not repeated; one that moves costs half as much again.")
} // namespace alluvium::coupling
