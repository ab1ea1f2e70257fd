// The fluid's linear solver where it is hard: strong convection.
// two_ranks.cmake runs all of it on 2, 3 and 4 ranks as well.
#include <alluvium/fluid/sparse_product.h>
#include <alluvium/fluid/vans_solver.h>

#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

namespace
{
  using namespace dealii;
  using namespace alluvium::fluid;
  using alluvium::fluid::BlockVector;
  constexpr int dim = 2;

  /** A jet from below into a box of water that is open above: it crosses seven cells a step. */
  class Jet
  {
  public:
    explicit Jet(const MPI_Comm comm = MPI_COMM_WORLD, const unsigned int n = 32, const double dt = 5e-3)
      : tria(comm)
    {
      using Kind = BoundaryConditions<dim>::Kind;
      struct Inflow : Function<dim>
      {
        Inflow()
          : Function<dim>(dim)
        {}
        double value(const Point<dim> &x, const unsigned int c) const override
        {
          return c == 0 ? 0. : 0.3 * (1. + 0.5 * std::sin(1e3 * x[0]));
        }
      };
      GridGenerator::subdivided_hyper_cube(tria, n, 0., 6e-3, true);
      for (const types::boundary_id side : {0, 1})
        bc.set(side, {Kind::slip, "side", nullptr});
      bc.set(2, {Kind::velocity, "bottom", std::make_shared<Inflow>()});
      bc.set(3, {Kind::pressure, "top", std::make_shared<Functions::ConstantFunction<dim>>(0.)});
      space.attach(tria);
      space.reinit(bc);
      solver.reinit();
      void_fraction = space.make_nodal_field();
      void_fraction = 1.;
      void_fraction.update_ghost_values();
      solid.begin.assign(space.cells().size() + 1, 0);
      problem.dt            = dt;
      problem.void_fraction = &void_fraction;
      problem.solid         = &solid;
    }

    LinearSolverReport step()
    {
      solver.begin_step(bc, problem);
      solver.solve();
      solver.accept();
      return solver.last_report();
    }

    parallel::distributed::Triangulation<dim> tria;
    BoundaryConditions<dim>                   bc;
    FluidSpace<dim>                           space;
    VansSolver<dim>                           solver{space};
    alluvium::fluid::Vector                   void_fraction;
    InterphaseTerms<dim>                      solid;
    VansProblem<dim>                          problem{};
  };

  void expect_same(const Jet &a, const Jet &b)
  {
    for (unsigned int block = 0; block < 2; ++block)
      {
        const double norm = b.solver.solution().block(block).l2_norm();
        EXPECT_GT(norm, 0.);
        EXPECT_NEAR(a.solver.solution().block(block).l2_norm(), norm, 1e-6 * norm);
      }
  }

  /** The matrix of a jet's first step. */
  struct System
  {
    explicit System(Jet &jet)
      : assembler(jet.space)
    {
      BlockVector iterate = jet.space.make_field(), old = jet.space.make_field(), known = jet.space.make_field(),
                  residual = jet.space.make_field();
      jet.space.apply_boundary_values(jet.bc, Tensor<1, dim>(), 0., {}, iterate);
      iterate.update_ghost_values();
      old.update_ghost_values();
      jet.problem.old = &old;
      assembler.reinit();
      assembler.assemble(jet.problem, iterate, residual, known);
    }

    VansAssembler<dim> assembler;
  };

  TEST(LinearSolver, ProductsOfMatricesAreThoseOfTheirVectors)
  {
    Jet                     jet;
    const System            system(jet);
    const auto             &B = system.assembler.matrix().block(0, 1), &C = system.assembler.matrix().block(1, 0);
    BlockVector             x = jet.space.make_field(), y = x, z = x;
    alluvium::fluid::Vector d(x.block(0));
    for (const auto i : d.locally_owned_elements())
      d(i) = 1. + std::sin(i);
    for (const auto i : x.block(1).locally_owned_elements())
      x.block(1)(i) = std::cos(7. * i);
    x.block(1).zero_out_ghost_values();
    for (const bool transposed : {false, true})
      {
        const auto product = transposed ? normal_product(B, d) : sparse_product(C, d, B);
        B.vmult(y.block(0), x.block(1));
        y.block(0).scale(d);
        if (transposed)
          B.Tvmult(z.block(1), y.block(0));
        else
          C.vmult(z.block(1), y.block(0));
        Epetra_Vector in(product->DomainMap()), out(product->RangeMap());
        for (int i = 0; i < in.MyLength(); ++i)
          in[i] = x.block(1).local_element(i);
        product->Apply(in, out);
        const double size = z.block(1).linfty_norm();
        for (int i = 0; i < out.MyLength(); ++i)
          EXPECT_NEAR(out[i], z.block(1).local_element(i), 1e-12 * size) << transposed;
      }
  }

  TEST(LinearSolver, StrongConvectionOnRanksIsThatOnOne)
  {
    Jet          shared, alone(MPI_COMM_SELF);
    unsigned int most = 0;
    for (unsigned int k = 0; k < 2; ++k)
      {
        const LinearSolverReport report = shared.step();
        EXPECT_FALSE(report.loose);
        most = std::max(most, report.n_iterations);
        alone.step();
      }
    EXPECT_GT(most, 60u); // more than the first preconditioner may take: it was the second
    expect_same(shared, alone);
  }
} // namespace
