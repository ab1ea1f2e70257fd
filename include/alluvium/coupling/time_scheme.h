#pragma once

#include <alluvium/coupling/coupling_state.h>
#include <alluvium/coupling/grain_sums.h>
#include <alluvium/utilities/plugin.h>

namespace alluvium::coupling
{
  /**
   * Interface of the coupling schemes: they say how the velocity of a piece (the intersection of a grain and a cell)
   * depends on the fluid during the step, solve by solve, and what acts on the grains afterwards.
   */
  class TimeScheme : public Plugin
  {
  public:
    /** Whether the grains' acceleration that the fluid sees is the one they take: added mass needs that. */
    virtual bool predicts_acceleration() const { return false; }

    /** Whether the fluid is solved with the grains' velocity of t^n: stable only at time steps below their relaxation.
     */
    virtual bool keeps_grain_velocity() const { return false; }

    /** Solves of the fluid a step; from the second on only the known terms change, the matrix stays. */
    virtual unsigned int n_sub_iterations() const { return 1; }

    /** How often fluid and contacts may be repeated with each other's result, and until when; see ContactIteration. */
    struct IterationLimit
    {
      unsigned int largest_number = 0;
      double       tolerance      = 0.; // of Coupling::momentum_defect(), see the parameter
    };
    virtual IterationLimit iteration_limit() const { return {}; }

    /**
     * Fill the exchange terms of all pieces for @p sub_iteration = 0, 1, ... Reference field 0 is none, 1 the velocity
     * at t^n, 2 that of the latest solve. Collective.
     */
    virtual void exchange_terms(const CouplingState                  &state,
                                const unsigned int                    sub_iteration,
                                std::vector<fluid::PieceExchange<2>> &exchange) const = 0;

    /** How many sums over the pieces of a grain loads() needs. */
    virtual unsigned int n_load_sums() const { return 0; }

    /** Add this rank's part of them, from the final state (state.latest), to the columns from @p first on. */
    virtual void add_load_sums(const CouplingState &, GrainSums &, const unsigned int /*first*/) const {}

    /**
     * Loads of the grains from @p force, what the fluid gave each grain [N/m], and from the columns of @p sums from
     * @p first on: by default the submerged weight plus that force, drag explicit.
     */
    virtual void loads(const CouplingState                      &state,
                       const std::vector<std::array<double, 2>> &force,
                       const GrainSums                          &sums,
                       const unsigned int                        first,
                       grains::GrainLoads                       &loads) const;
  };
} // namespace alluvium::coupling

/** Register a time scheme under the name that parameter files use. */
#define ALLUVIUM_REGISTER_TIME_SCHEME(Class, name, prose)                                                              \
  ALLUVIUM_REGISTER(::alluvium::coupling::TimeScheme, Class, name, prose)
