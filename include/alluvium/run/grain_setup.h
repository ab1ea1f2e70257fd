#pragma once

#include <alluvium/deposits/deposit.h>
#include <alluvium/grains/grain_arrays.h>
#include <alluvium/mesh/domain.h>
#include <alluvium/run/wall_setup.h>
#include <alluvium/utilities/plugin.h>

#include <mpi.h>

namespace alluvium::run
{
  /** Section "Grains" of the parameter file: where they are at t = 0, what they weigh, and what the fluid sees of them.
   */
  class GrainSetup
  {
  public:
    void add_parameters(dealii::ParameterHandler &prm);
    void parse_parameters() { deposit.parse_parameters(); }

    /** See WallSetup. */
    std::vector<grains::WallSegment> walls(const mesh::Domain<2> &domain) const;

    /**
     * Make the deposit (on one rank) and check it: every grain inside the domain, no overlap beyond the tolerance.
     * Throws UserError. Collective.
     */
    grains::GrainArrays make(MPI_Comm                                communicator,
                             const mesh::Domain<2>                  &domain,
                             const std::vector<grains::WallSegment> &walls,
                             const std::array<double, 2>            &gravity,
                             const std::string                      &directory) const;

    /** Write no files, such as the deposit's cache, when the grains are made. */
    void write_nothing() { may_write = false; }

    bool fixed() const { return fixed_grains; }
    bool mass_follows_fluid_radius() const { return mass_follows == "fluid radius"; }
    /** Where there shall be no grains, what sizes are measured in [m]; else 0. */
    double unit_length() const { return deposit.get().unit_length(); }
    /** Fluid radius over contact radius of the grains made last. */
    double radius_factor() const { return last_factor; }

  private:
    double find_radius_factor(const grains::GrainArrays &grains,
                              const mesh::Domain<2>     &domain,
                              const geometry::Upright   &upright) const;

    WallSetup                       wall_setup;
    PluginChoice<deposits::Deposit> deposit;
    double                          density = 2650., factor = 1., packing = 0., overlap_tolerance = 0.01;
    std::string                     mass_follows = "contact radius";
    bool                            fixed_grains = false, may_write = true;
    mutable double                  last_factor = 1.;
  };
} // namespace alluvium::run
