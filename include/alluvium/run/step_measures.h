#pragma once

#include <mpi.h>

#include <array>
#include <vector>

namespace alluvium::run
{
  struct Model;

  /** Energy per depth in a step: what there is and where it may have come from. The same on all ranks. */
  struct StepEnergy
  {
    double kinetic   = 0.; // of fluid and grains at its end [J/m]
    double springs   = 0.; // held by the springs of soft spheres then [J/m]
    double change    = 0.; // of both since the last step [J/m]
    double sources   = 0.; // work done on them in it, at most [J/m]
    double remainder = 0.; // what neither explains; of a balance that knows its dissipation [J/m]
  };

  /** What a step came to, in the numbers that show first when it goes wrong. The same on all ranks. */
  struct StepMeasures
  {
    bool         finite         = true; // are all of the fluid's fields?
    double       fluid_velocity = 0.;   // the largest [m/s]
    double       courant        = 0.;   // the largest |u| dt / h of a cell
    double       solid_lost     = 0.;   // part of the grains' volume that the void fraction does not show
    unsigned int n_iterations   = 0;    // of the linear solver
    double       grain_velocity = 0.;   // the largest [m/s]
    StepEnergy   energy;
  };

  /**
   * Measures a step in one pass over the fluid's cells and one over the grains. Kinetic energy is that of the fluid at
   * the nodes and of the grains; the springs of soft spheres give back what they hold. Its sources are bounded from
   * above: pressure and velocity at open boundaries, grains that sink, walls and prescribed grains that push. A
   * pressure boundary supplies its pressure, and what flows in no more kinetic energy than the pressures on boundaries
   * differ by; dissipation is not looked at.
   */
  class StepMeter
  {
  public:
    /** Where the fluid stands now is what the next step changes. Collective. */
    void begin(const Model &model);

    /** The mesh is another one. */
    void forget_mesh() { faces_known = false; }

    /** Measure the step that @p model has just taken. Collective. */
    StepMeasures measure(const Model &model);

  private:
    /** A face on an open boundary: its cell, and the cell's nodes at both ends. */
    struct Face
    {
      unsigned int                cell;
      std::array<unsigned int, 2> node;
      std::array<double, 2>       normal; // outward, times length [m]
      bool                        given_pressure;
    };

    void   find_faces(const Model &model);
    double largest_shear_power(const Model &model, const Face &face) const;
    double boundary_work(const Model &model) const;
    double work_on_grains(const Model &model) const;
    void   remember(const Model &model, const StepEnergy &now);

    bool                faces_known = false;
    std::vector<Face>   faces;
    std::vector<double> x, y;        // of the grains before the step [m]
    double              energy = 0.; // kinetic, and of springs [J/m]
  };
} // namespace alluvium::run
