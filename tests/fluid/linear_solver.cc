// The fluid's linear solver where it is hard: strong convection, the last resort, and equations that nothing solves.
// two_ranks.cmake runs all of it on 2, 3 and 4 ranks as well.
#include "fixtures/boundary_kinds.h"

#include <alluvium/fluid/sparse_product.h>
#include <alluvium/fluid/vans_solver.h>
#include <alluvium/utilities/divergence.h>

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
        bc.set(side, {boundary_kinds::slip, "side", nullptr});
      bc.set(2, {boundary_kinds::velocity, "bottom", std::make_shared<Inflow>()});
      bc.set(3, {boundary_kinds::pressure, "top", std::make_shared<Functions::ConstantFunction<dim>>(0.)});
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

  std::string message_of(const std::function<void()> &action)
  {
    try
      {
        action();
      }
    catch (const std::exception &error)
      {
        return error.what();
      }
    return "";
  }

  /** The equations of a jet's first step, and a solver for them alone. */
  struct System
  {
    explicit System(Jet &jet)
      : assembler(jet.space)
      , x(jet.space.make_field())
      , residual(jet.space.make_field())
      , constraints(jet.space.constraints())
    {
      BlockVector iterate = jet.space.make_field(), old = jet.space.make_field(), known = jet.space.make_field();
      given.update(jet.space, jet.bc, jet.void_fraction);
      jet.problem.boundary_conditions = &jet.bc;
      jet.problem.given_fluxes        = &given.face_fluxes();
      jet.space.boundary().apply_boundary_values(jet.bc, Tensor<1, dim>(), 0., {}, given.node_values(), iterate);
      for (BlockVector *field : {&iterate, &old, &known})
        field->update_ghost_values();
      jet.problem.old = &old;
      assembler.reinit();
      known.zero_out_ghost_values();
      assembler.assemble(jet.problem, iterate, residual, known);
      matrix.reinit(2, 2);
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int j = 0; j < 2; ++j)
          matrix.block(i, j).copy_from(assembler.matrix().block(i, j));
      matrix.collect_sizes();
      solver.scales = jet.solver.linear_solver.scales;
    }

    LinearSolverReport solve()
    {
      return solver.solve(
        matrix, residual, {{residual.block(0).l2_norm(), residual.block(1).l2_norm()}}, constraints, 1., x);
    }

    GivenVelocity<dim>                  given;
    VansAssembler<dim>                  assembler;
    TrilinosWrappers::BlockSparseMatrix matrix;
    LinearSolver                        solver;
    BlockVector                         x, residual;
    const AffineConstraints<double>    &constraints;
  };

  TEST(LinearSolver, ProductsOfMatricesAreThoseOfTheirVectors)
  {
    Jet                     jet;
    const System            system(jet);
    const auto             &B = system.matrix.block(0, 1), &C = system.matrix.block(1, 0);
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
          EXPECT_NEAR(out[i], z.block(1).local_element(i), 1e-12 * size);
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
        EXPECT_FALSE(report.direct);
        most = std::max(most, report.n_iterations);
        alone.step();
      }
    EXPECT_GT(most, 60u); // more than the first preconditioner may take: it was the second
    expect_same(shared, alone);
  }

  TEST(LinearSolver, DirectSolverIsTheLastResort)
  {
    Jet jet, reference;
    jet.solver.linear_solver.max_iterations = 1;
    for (unsigned int k = 0; k < 2; ++k)
      {
        const LinearSolverReport report = jet.step();
        EXPECT_TRUE(report.direct);
        EXPECT_FALSE(report.loose);
        EXPECT_LE(report.residual, jet.solver.linear_solver.tolerance);
        EXPECT_LE(report.n_iterations, 20u); // kept factors are a good preconditioner
        reference.step();
      }
    expect_same(jet, reference);
    // none for larger systems: that is said
    jet.solver.linear_solver.clear();
    jet.solver.linear_solver.direct_up_to = 100;
    const std::string message             = message_of([&] { jet.step(); });
    EXPECT_NE(message.find("has not converged in 1 iterations"), std::string::npos) << message;
    EXPECT_NE(message.find("Direct solver up to"), std::string::npos) << message;
  }

  TEST(LinearSolver, OtherPreconditionersHaveATryAgain)
  {
    Jet jet(MPI_COMM_WORLD, 8);
    jet.solver.linear_solver.max_iterations = 1;
    EXPECT_TRUE(jet.step().direct);
    jet.solver.linear_solver.max_iterations = 300;
    unsigned int n_direct                   = 0;
    for (unsigned int k = 0; k < 60; ++k)
      n_direct += jet.step().direct;
    EXPECT_GT(n_direct, 10u);
    EXPECT_LT(n_direct, 55u);
  }

  TEST(LinearSolver, FactorsForFewAndForManyUnknownsAreThoseOfTheMatrix)
  {
    Jet    jet;
    System system(jet);
    for (const types::global_dof_index many : {0u, 1000000u})
      {
        const DirectSolver factors(system.matrix, many);
        ASSERT_FALSE(factors.is_singular());
        BlockVector back = jet.space.make_field();
        factors.vmult(system.x, system.residual, 2.);
        system.matrix.vmult(back, system.x);
        back.block(1) *= 2.;
        back -= system.residual;
        EXPECT_LE(back.l2_norm(), 1e-10 * system.residual.l2_norm()) << many;
      }
  }

  TEST(LinearSolver, SingularEquationsEndWithAMessage)
  {
    Jet    jet;
    System system(jet);
    EXPECT_FALSE(system.solve().direct);
    system.solver.clear();
    // a pressure that stands in no equation of its own, but on the right-hand side
    const auto row = jet.space.owned()[1].size() / 2;
    if (jet.space.owned()[1].is_element(row))
      {
        for (const unsigned int block : {0, 1})
          {
            const Epetra_CrsMatrix &rows  = system.matrix.block(1, block).trilinos_matrix();
            int                     n     = 0;
            double                 *value = nullptr;
            rows.ExtractMyRowView(system.residual.block(1).get_partitioner()->global_to_local(row), n, value);
            std::fill(value, value + n, 0.);
          }
        system.residual.block(1)(row) = 1.;
      }
    const std::string message = message_of([&] { system.solve(); });
    EXPECT_NE(message.find("has not converged"), std::string::npos) << message;
    EXPECT_NE(message.find("singular"), std::string::npos) << message;
  }

  TEST(LinearSolver, ARightHandSideThatIsNotFiniteIsDivergence)
  {
    Jet    jet;
    System system(jet);
    if (system.residual.block(0).locally_owned_size() > 0)
      system.residual.block(0).local_element(0) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(system.solver.solve(system.matrix, system.residual, {{1., 1.}}, system.constraints, 1., system.x),
                 alluvium::Divergence);
  }

  TEST(LinearSolver, SavedFactorsOfADirectSolverAreMadeAgain)
  {
    Jet    jet;
    System system(jet), again(jet);
    system.solver.max_iterations = again.solver.max_iterations = 1;
    EXPECT_TRUE(system.solve().direct);
    alluvium::ByteWriter writer;
    system.solver.save(writer);
    alluvium::ByteReader reader(writer.bytes);
    again.solver.load(reader, again.matrix);
    EXPECT_TRUE(reader.at_end());
    system.residual *= 2.;
    again.residual *= 2.;
    EXPECT_TRUE(system.solve().direct);
    EXPECT_TRUE(again.solve().direct);
    system.x -= again.x;
    EXPECT_EQ(system.x.linfty_norm(), 0.);
  }
} // namespace
