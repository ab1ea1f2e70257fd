#pragma once

#include <alluvium/grains/grain_arrays.h>

#include <mpi.h>

#include <array>
#include <functional>
#include <memory>
#include <string>

namespace dealii
{
  template <int, int>
  class DataOutInterface;
  namespace Particles
  {
    template <int, int>
    class ParticleHandler;
  }
} // namespace dealii

namespace alluvium::grains
{
  /**
   * Owns the grains of a run, in two forms. Arrays of all grains, the same on every rank, are what a step computes on
   * and changes in place. Particles of a deal.II ParticleHandler, each on the rank that owns its cell of a coarse grid
   * of the grains' own, are their form for pictures and for whoever works on a rank's own grains; they follow the
   * arrays when they are asked for, so that steps in between do not pay for it.
   *
   * A cell of the grid is at least as wide as the largest grain plus the search skin, so that one layer of ghost cells
   * holds every contact partner; wider where there would be more than 4096 and an eighth a grain.
   */
  class GrainStore
  {
  public:
    explicit GrainStore(MPI_Comm communicator);
    ~GrainStore();

    /** All grains, sorted by id. Who changes them does so alike on all ranks. */
    GrainArrays       &grains();
    const GrainArrays &grains() const;

    /**
     * Lay the grid over the box from @p lower to @p upper [m], wider by one cell on all sides. @p skin [m] is that of
     * the contact search. Throws UserError for a grain outside the grid.
     */
    void initialize(const std::array<double, 2> &lower, const std::array<double, 2> &upper, double skin);

    /** Whether grains may be outside the grid: their particles wait in its nearest cell until they are taken out. */
    void let_leave(bool yes);

    /**
     * After a step of @p dt [s]: throws, on all ranks, if a position is not finite or outside the grid, and names it and
     * the grain. A UserError where a grain has drifted out, as no wall kept it; a Divergence where it has come farther
     * than its radius in the step.
     */
    void check_positions(double dt) const;

    /** The particles, up to date, with the columns but for the position as properties. Collective. */
    const dealii::Particles::ParticleHandler<2, 2> &particles();

    /** Particles of this rank, when they were last up to date. */
    std::size_t n_local_particles() const;

    /**
     * How many grains were put into their cells by hand when particles() last followed the arrays: they had jumped over
     * a whole cell, which deal.II cannot follow, or it lost them (on a vertex, before 9.6).
     */
    std::size_t n_rescued() const;

    /**
     * Give @p use the local grains as points for output, with fields id, displacement since t = 0 [m], and the columns
     * that belong into pictures. Collective.
     */
    void output(const std::function<void(dealii::DataOutInterface<0, 2> &)> &use);

  private:
    class Implementation;
    std::unique_ptr<Implementation> implementation;
  };
} // namespace alluvium::grains
