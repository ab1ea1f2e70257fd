#pragma once

// Fluid alone in a channel, for tests of its boundaries.
#include "fixtures/boundary_kinds.h"

#include <alluvium/fluid/energy_balance.h>
#include <alluvium/fluid/vans_solver.h>

#include <deal.II/base/function_parser.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

namespace fluid_channel
{
  using namespace dealii;
  using namespace alluvium::fluid;
  constexpr int dim = 2;

  constexpr double width = 2e-3, length = 1e-2; // of a channel along y [m]
  constexpr double rho = 1000., eta = 1e-3;

  enum class Mesh
  {
    quadrilaterals,
    hanging_nodes,
    triangles
  };

  inline std::shared_ptr<Function<dim>> function(const std::string &text, const unsigned int n_components)
  {
    auto f = std::make_shared<FunctionParser<dim>>(n_components);
    f->initialize("x,y,t", text, {}, true);
    return f;
  }

  /** Fluid alone in a rectangle with a square mesh; ids 0 left, 1 right, 2 bottom, 3 top. */
  struct Channel
  {
    Channel(const Mesh mesh, const double cell, const double w = width, const double l = length)
    {
      const std::vector<unsigned int> n = {static_cast<unsigned int>(std::lround(w / cell)),
                                           static_cast<unsigned int>(std::lround(l / cell))};
      if (mesh == Mesh::triangles)
        {
          Triangulation<dim> quadrilaterals;
          GridGenerator::subdivided_hyper_rectangle(quadrilaterals, n, Point<dim>(), Point<dim>(w, l), true);
          GridGenerator::convert_hypercube_to_simplex_mesh(quadrilaterals, serial);
        }
      else
        {
          GridGenerator::subdivided_hyper_rectangle(serial, n, Point<dim>(), Point<dim>(w, l), true);
          if (mesh == Mesh::hanging_nodes)
            {
              for (const auto &c : serial.active_cell_iterators())
                if (c->center()[0] < 0.3 * w || (c->center()[1] > 0.4 * l && c->center()[1] < 0.6 * l))
                  c->set_refine_flag();
              serial.execute_coarsening_and_refinement();
            }
        }
    }

    void set(const unsigned int id, const boundary_kinds::Kind &kind, const std::string &value = "")
    {
      conditions.set(id,
                     {kind, "side " + std::to_string(id), value.empty() ? nullptr : function(value, kind->n_values())});
    }

    void start()
    {
      space.attach(serial);
      space.reinit(conditions);
      solver                          = std::make_unique<VansSolver<dim>>(space);
      solver->properties              = {rho, eta};
      solver->linear_solver.tolerance = 1e-10;
      ParameterHandler prm;
      if (!terms.empty())
        {
          solver->add_parameters(prm);
          prm.enter_subsection("Fluid");
          prm.set("Open boundary terms", terms);
        }
      solver->reinit();
      eps = space.make_nodal_field();
      eps = 1.;
      eps.update_ghost_values();
      problem.void_fraction = &eps;
      problem.solid         = &no_solid;
      conditions.set_time(0.);
      solver->choose_datum(conditions);
    }

    void step(const double dt)
    {
      problem.dt = dt;
      time += dt;
      conditions.set_time(time);
      solver->accept();
      solver->begin_step(conditions, problem);
      solver->solve();
    }

    /** Largest distance of a velocity component from @p exact(x) [m/s]. */
    template <typename Exact>
    double error(const unsigned int component, const Exact &exact) const
    {
      double largest = 0.;
      for (const auto &cell : space.cells())
        for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
          largest = std::max(
            largest,
            std::abs(solver->solution().block(0).local_element(cell.velocity[v][component]) - exact(cell.vertex[v])));
      return largest;
    }

    double largest(const unsigned int component) const
    {
      return error(component, [](const Point<dim> &) { return 0.; });
    }

    EnergyBalance balance() const { return energy_balance(space, solver->problem(), solver->solution()); }

    Triangulation<dim>               serial;
    BoundaryConditions<dim>          conditions;
    FluidSpace<dim>                  space;
    std::unique_ptr<VansSolver<dim>> solver;
    alluvium::fluid::Vector          eps;
    InterphaseTerms<dim>             no_solid;
    VansProblem<dim>                 problem{};
    double                           time = 0.;
    std::string                      terms;
  };

  /** For INSTANTIATE_TEST_SUITE_P. */
  inline std::string name_of(const testing::TestParamInfo<Mesh> &info)
  {
    return info.param == Mesh::quadrilaterals  ? "Quadrilaterals"
           : info.param == Mesh::hanging_nodes ? "HangingNodes"
                                               : "Triangles";
  }
} // namespace fluid_channel
