#pragma once

#include <alluvium/coupling/coupling_state.h>
#include <alluvium/coupling/drag_law.h>
#include <alluvium/coupling/drag_regularisation.h>
#include <alluvium/fluid/vans_problem.h>
#include <alluvium/utilities/plugin.h>

namespace alluvium::coupling
{
  /** The drag of each piece, the intersection of a grain and a cell, from the law and the regularisation that the user
   * has chosen. */
  class PieceDrag
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm);
    void parse_parameters();

    /** Fill the drag per volume of all pieces of @p state from its fluid at t^n and the void fraction @p eps. */
    void find(const fluid::FluidSpace<2>   &space,
              const fluid::Vector          &eps,
              const fluid::FluidProperties &fluid,
              CouplingState                &state);

    /** Of the latest find(): sums over each grain's pieces on this rank, A eps and A Re, grain by grain [m^2]. */
    const std::vector<double> &sums_of_conditions() const { return conditions; }

    const DragLaw     &law() const { return law_choice.get(); }
    const std::string &law_name() const { return law_choice.name(); }

  private:
    PluginChoice<DragLaw>            law_choice;
    PluginChoice<DragRegularisation> regularisation_choice;
    std::vector<double>              conditions;
  };
} // namespace alluvium::coupling
