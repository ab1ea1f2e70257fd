// A manufactured solution of the stationary VANS equations with a varying void fraction: L2(u) converges with order 2,
// H1(u) with 1, L2(p) with 1.5 or more, on quadrilaterals with hanging nodes and on triangles.
#include "fixtures/boundary_kinds.h"

#include <alluvium/fluid/cell_order.h>
#include <alluvium/fluid/vans_solver.h>

#include <deal.II/base/convergence_table.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/numerics/vector_tools.h>

#include <gtest/gtest.h>

namespace
{
  using namespace dealii;
  using namespace alluvium::fluid;
  constexpr int    dim = 2;
  constexpr double pi = numbers::PI, rho = 2., eta = 0.3;

  // eps in [.4,.9]; w = eps u + (1-eps) v is divergence free with v a given field, so that (1) holds without a source
  double eps(const Point<dim> &x)
  {
    return 0.65 + 0.25 * std::sin(pi * x[0]) * std::sin(pi * x[1]);
  }
  Tensor<1, dim> solid_velocity(const Point<dim> &x)
  {
    Tensor<1, dim> v;
    v[0] = 0.3 * std::sin(pi * x[0]) * std::cos(pi * x[1]); // no solid crosses the boundary
    v[1] = 0.2 * std::sin(pi * x[1]);
    return v;
  }
  Tensor<1, dim> velocity(const Point<dim> &x)
  {
    Tensor<1, dim> w; // curl of sin(pi x) sin(pi y) / pi plus a constant
    w[0] = std::sin(pi * x[0]) * std::cos(pi * x[1]) + 0.5;
    w[1] = -std::cos(pi * x[0]) * std::sin(pi * x[1]);
    return (w - (1. - eps(x)) * solid_velocity(x)) / eps(x);
  }
  double pressure(const Point<dim> &x)
  {
    return std::cos(pi * x[0]) * std::sin(2. * x[1]);
  }

  class Exact : public Function<dim>
  {
  public:
    Exact()
      : Function<dim>(dim + 1)
    {}
    double value(const Point<dim> &x, const unsigned int c) const override
    {
      return c < dim ? velocity(x)[c] : pressure(x);
    }
    Tensor<1, dim> gradient(const Point<dim> &x, const unsigned int c) const override
    {
      Tensor<1, dim> g;
      const double   h = 1e-6;
      for (unsigned int d = 0; d < dim; ++d)
        {
          Point<dim> a = x, b = x;
          a[d] -= h;
          b[d] += h;
          g[d] = (value(b, c) - value(a, c)) / (2. * h);
        }
      return g;
    }
  };

  // f = eps rho u.grad u + grad p - div(eps eta (grad u + grad u^T)) + (1-eps) (gamma (u - v) - grad p)
  class Force : public Function<dim>
  {
  public:
    explicit Force(const double gamma)
      : Function<dim>(dim)
      , gamma(gamma)
    {}
    double value(const Point<dim> &x, const unsigned int c) const override
    {
      const double h     = 1e-4;
      const auto   shear = [&](const Point<dim> &y, const unsigned int d) {
        return eps(y) * eta * (exact.gradient(y, c)[d] + exact.gradient(y, d)[c]);
      };
      double f = eps(x) * rho * (velocity(x) * exact.gradient(x, c)) + eps(x) * exact.gradient(x, dim)[c] +
                 (1. - eps(x)) * gamma * (velocity(x) - solid_velocity(x))[c];
      for (unsigned int d = 0; d < dim; ++d)
        {
          Point<dim> a = x, b = x;
          a[d] -= h;
          b[d] += h;
          f -= (shear(b, d) - shear(a, d)) / (2. * h);
        }
      return f;
    }

  private:
    Exact  exact;
    double gamma;
  };

  struct Errors
  {
    double       l2_u, h1_u, l2_p;
    unsigned int iterations;
  };

  Errors solve(const Triangulation<dim> &tria, const double gamma, const bool lumped)
  {
    BoundaryConditions<dim> bc;
    struct Velocity : Function<dim>
    {
      Velocity()
        : Function<dim>(dim)
      {}
      double value(const Point<dim> &x, const unsigned int c) const override { return velocity(x)[c]; }
    };
    struct Pressure : Function<dim>
    {
      double value(const Point<dim> &x, const unsigned int) const override { return pressure(x); }
    };
    for (const auto id : tria.get_boundary_ids())
      bc.set(id, {boundary_kinds::velocity, "side", std::make_shared<Velocity>()});
    bc.pin(true);
    bc.give_interstitial_velocity();

    FluidSpace<dim> space(tria);
    space.reinit(bc);
    VansSolver<dim> solver(space);
    solver.properties                 = {rho, eta};
    solver.discretisation.lumped_drag = lumped;
    solver.linear_solver.tolerance    = 1e-7;
    solver.reinit();

    alluvium::fluid::Vector eps_field = space.make_nodal_field();
    struct Eps : Function<dim>
    {
      double value(const Point<dim> &x, const unsigned int) const override { return eps(x); }
    };
    VectorTools::interpolate(space.mapping(), space.nodal_dof_handler(), Eps(), eps_field);
    space.interpolate_hanging_nodes(eps_field);

    // the solid as pieces at the points of a fine quadrature
    InterphaseTerms<dim>  solid;
    const bool            simplex = space.n_nodes_per_cell() == 3;
    const Quadrature<dim> quadrature =
      simplex ? Quadrature<dim>(QGaussSimplex<dim>(3)) : Quadrature<dim>(QGauss<dim>(3));
    FEValues<dim> values(space.mapping(),
                         space.nodal_dof_handler().get_fe(),
                         quadrature,
                         update_values | update_JxW_values | update_quadrature_points);
    solid.begin.push_back(0);
    for (const auto &cell : ordered_cells(space.nodal_dof_handler()))
      {
        values.reinit(cell);
        for (unsigned int q = 0; q < quadrature.size(); ++q)
          {
            PieceShape<dim> s{};
            s.area = (1. - eps(values.quadrature_point(q))) * values.JxW(q);
            for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
              s.phi[v] = values.shape_value(v, q);
            PieceExchange<dim> x;
            x.gamma = gamma;
            for (unsigned int d = 0; d < dim; ++d)
              x.a[d] = solid_velocity(values.quadrature_point(q))[d];
            solid.shape.push_back(s);
            solid.exchange.push_back(x);
          }
        solid.begin.push_back(solid.shape.size());
      }
    const Force      force(gamma);
    VansProblem<dim> problem{};
    problem.dt            = 0.02; // towards the stationary state, from near it
    problem.void_fraction = &eps_field;
    problem.solid         = &solid;
    problem.body_force    = &force;
    Errors                       result{};
    alluvium::fluid::BlockVector start = space.make_field();
    VectorTools::interpolate(space.mapping(), space.dof_handler(), Exact(), start);
    solver.set_solution(start);
    for (unsigned int k = 0; k < 25; ++k)
      {
        solver.begin_step(bc, problem);
        solver.solve();
        result.iterations = std::max(result.iterations, solver.last_report().n_iterations);
        solver.accept();
      }

    // errors, the pressure up to its mean
    Quadrature<dim> fine = simplex ? Quadrature<dim>(QGaussSimplex<dim>(4)) : Quadrature<dim>(QGauss<dim>(4));
    FEValues<dim>   fe(space.mapping(),
                     space.nodal_dof_handler().get_fe(),
                     fine,
                     update_values | update_gradients | update_JxW_values | update_quadrature_points);
    Exact           exact;
    double          mean = 0., area = 0.;
    for (int pass = 0; pass < 2; ++pass)
      {
        unsigned int index = 0;
        for (const auto &cell : ordered_cells(space.nodal_dof_handler()))
          {
            fe.reinit(cell);
            const auto &data = space.cells()[index++];
            for (unsigned int q = 0; q < fine.size(); ++q)
              {
                const Point<dim> x = fe.quadrature_point(q);
                double           p = -pressure(x);
                Tensor<1, dim>   e;
                Tensor<2, dim>   ge;
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    e[d]  = -velocity(x)[d];
                    ge[d] = -exact.gradient(x, d);
                  }
                for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
                  {
                    p += solver.solution().block(1).local_element(data.pressure[v]) * fe.shape_value(v, q);
                    for (unsigned int d = 0; d < dim; ++d)
                      {
                        const double u = solver.solution().block(0).local_element(data.velocity[v][d]);
                        e[d] += u * fe.shape_value(v, q);
                        ge[d] += u * fe.shape_grad(v, q);
                      }
                  }
                if (pass == 0)
                  {
                    mean += p * fe.JxW(q);
                    area += fe.JxW(q);
                  }
                else
                  {
                    result.l2_u += e.norm_square() * fe.JxW(q);
                    result.h1_u += ge.norm_square() * fe.JxW(q);
                    result.l2_p += (p - mean / area) * (p - mean / area) * fe.JxW(q);
                  }
              }
          }
      }
    result.l2_u = std::sqrt(result.l2_u);
    result.h1_u = std::sqrt(result.h1_u);
    result.l2_p = std::sqrt(result.l2_p);
    return result;
  }

  void check_orders(const std::string &name, const std::vector<Errors> &e)
  {
    for (unsigned int i = 0; i < e.size(); ++i)
      std::printf("%s %u: L2(u) %.3e  H1(u) %.3e  L2(p) %.3e  iterations %u\n",
                  name.c_str(),
                  i,
                  e[i].l2_u,
                  e[i].h1_u,
                  e[i].l2_p,
                  e[i].iterations);
    const auto order = [&](auto member) { return std::log2(e[e.size() - 2].*member / e.back().*member); };
    std::printf("%s orders: L2(u) %.2f  H1(u) %.2f  L2(p) %.2f\n",
                name.c_str(),
                order(&Errors::l2_u),
                order(&Errors::h1_u),
                order(&Errors::l2_p));
    EXPECT_GE(order(&Errors::l2_u), 1.85);
    EXPECT_GE(order(&Errors::h1_u), 0.95);
    EXPECT_GE(order(&Errors::l2_p), 1.5);
  }
} // namespace

// Error against cost, a mesh and a drag a test: doc/lab/manufactured-solution runs them one by one.
struct Setting
{
  std::string  mesh;
  unsigned int n; // cells to a side
  double       gamma;
  bool         lumped;
};

class ManufacturedSolutionValidation : public ::testing::TestWithParam<Setting>
{
};

TEST_P(ManufacturedSolutionValidation, Error)
{
  const Setting &s = GetParam();
  Errors         e;
  if (s.mesh == "triangles")
    {
      Triangulation<dim> quads, tria;
      GridGenerator::subdivided_hyper_cube(quads, s.n);
      GridGenerator::convert_hypercube_to_simplex_mesh(quads, tria); // eight to a square
      e = solve(tria, s.gamma, s.lumped);
    }
  else
    {
      parallel::distributed::Triangulation<dim> tria(MPI_COMM_WORLD);
      GridGenerator::subdivided_hyper_cube(tria, s.n);
      e = solve(tria, s.gamma, s.lumped);
    }
  std::printf("errors %.6e %.6e %.6e\n", e.l2_u, e.h1_u, e.l2_p);
  // on any of these meshes it is of second order with a constant of order one
  const double h = 1. / s.n;
  EXPECT_LT(e.l2_u, 4. * h * h);
  EXPECT_GT(e.l2_u, 0.);
}

std::vector<Setting> settings()
{
  std::vector<Setting> all;
  for (const unsigned int n : {8, 16, 32, 64, 128})
    for (const double gamma : {1., 100.})
      {
        all.push_back({"quads", n, gamma, false});
        all.push_back({"quads", n, gamma, true});
        if (n <= 64)
          all.push_back({"triangles", n / 2, gamma, false}); // as many nodes
      }
  return all;
}

std::string name_of(const ::testing::TestParamInfo<Setting> &info)
{
  const Setting &s = info.param;
  return s.mesh + "_" + std::to_string(s.n) + "_drag_" + std::to_string(int(s.gamma)) + (s.lumped ? "_lumped" : "");
}

INSTANTIATE_TEST_SUITE_P(Charts, ManufacturedSolutionValidation, ::testing::ValuesIn(settings()), name_of);

TEST(ManufacturedSolution, QuadrilateralsWithHangingNodes)
{
  for (const double gamma : {1., 100.})
    {
      std::vector<Errors> errors;
      for (unsigned int level = 3; level < 6; ++level)
        {
          parallel::distributed::Triangulation<dim> tria(MPI_COMM_WORLD);
          GridGenerator::hyper_cube(tria, 0., 1., true);
          tria.refine_global(level);
          for (const auto &cell : tria.active_cell_iterators())
            if (cell->center().distance(Point<dim>(0.4, 0.6)) < 0.3)
              cell->set_refine_flag();
          tria.execute_coarsening_and_refinement();
          errors.push_back(solve(tria, gamma, false));
        }
      check_orders("quads gamma " + std::to_string(int(gamma)), errors);
    }
}

TEST(ManufacturedSolution, Triangles)
{
  for (const double gamma : {1., 10., 100.})
    {
      std::vector<Errors> errors;
      for (unsigned int n = 4; n < 40; n *= 2)
        {
          // eight triangles to a square: no direction is preferred
          Triangulation<dim> quads, tria;
          GridGenerator::subdivided_hyper_cube(quads, n);
          GridGenerator::convert_hypercube_to_simplex_mesh(quads, tria);
          errors.push_back(solve(tria, gamma, false));
        }
      check_orders("triangles gamma " + std::to_string(int(gamma)), errors);
    }
}
