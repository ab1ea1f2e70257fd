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
   * Owns the grains: a deal.II ParticleHandler on a coarse uniform grid of the grains' own, distributed over the ranks.
   * A cell is at least as wide as the largest grain plus the search skin, so that one layer of ghost cells holds every
   * contact partner; wider where there would be more than 4096 and an eighth a grain.
   *
   * Computing is done on replicated arrays: gather(), change them, scatter().
   */
  class GrainStore
  {
  public:
    explicit GrainStore(MPI_Comm communicator);
    ~GrainStore();

    /**
     * Build the grid over the box from @p lower to @p upper [m], wider by one cell on all sides, and put @p grains in,
     * which are the same on all ranks, sorted by id. @p skin [m] is that of the contact search. Replaces what
     * was there. Collective. Throws UserError for a grain outside the grid.
     */
    void initialize(const GrainArrays           &grains,
                    const std::array<double, 2> &lower,
                    const std::array<double, 2> &upper,
                    double                       skin);

    /** Whether grains may be outside the grid: they wait in its nearest cell until they are taken out. */
    void let_leave(bool yes);

    /** Go on with other @p grains on the same grid. Collective. */
    void replace(const GrainArrays &grains);

    std::size_t n_grains() const;       // on all ranks
    std::size_t n_local_grains() const; // on this one

    /** All grains on all ranks, sorted by id, the same bits everywhere. Collective. */
    GrainArrays gather() const;

    /**
     * Take over positions and properties from @p grains, the same on all ranks and with the same ids as gather() gave,
     * and send grains that have moved to the ranks that own their cells. Collective. Throws UserError, on all
     * ranks, naming grain and position, if a position is not finite or outside the grid.
     */
    void scatter(const GrainArrays &grains);

    /** Move the grid's cells between ranks so that each has about as many grains. Collective. */
    void rebalance();

    /**
     * How many grains the last scatter() put into their cells by hand: they jumped over a whole cell, which deal.II
     * cannot follow, or it lost them (on a vertex, before 9.6).
     */
    std::size_t n_rescued() const;

    /**
     * Give @p use the local grains as points for output, with fields id, radius [m], displacement since t = 0 [m],
     * velocity [m/s], angular_velocity [rad/s], contact_force [N/m]. Collective if @p use is.
     */
    void output(const std::function<void(dealii::DataOutInterface<0, 2> &)> &use) const;

    /** Write them as one compressed .vtu for ParaView. Collective. */
    void write_vtu(const std::string &file_name) const;

    const dealii::Particles::ParticleHandler<2, 2> &particles() const;

  private:
    class Implementation;
    std::unique_ptr<Implementation> implementation;
  };
} // namespace alluvium::grains
