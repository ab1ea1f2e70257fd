#pragma once

#include <alluvium/fluid/fluid_space.h>

#include <string>
#include <utility>
#include <vector>

namespace alluvium::observers
{
  /**
   * Writes the fluid for ParaView: velocity [m/s], total pressure [Pa] and void fraction on the mesh, one .vtu file (or HDF5 with
   * XDMF) an output whatever the number of ranks, and the .pvd (.xdmf) file that lists them with their times.
   */
  class FluidOutput
  {
  public:
    /** Files go into @p folder; @p hdf5 chooses HDF5/XDMF. */
    FluidOutput(const std::string &folder, const bool hdf5)
      : folder(folder)
      , hdf5(hdf5)
    {}

    /** The total pressure is the reduced one + @p reference_gradient.x + @p datum, rho g [Pa/m] and [Pa]. Collective. */
    void write(const fluid::FluidSpace<2>        &space,
               const fluid::BlockVector          &solution,
               const fluid::Vector               &void_fraction,
               const dealii::Tensor<1, 2>        &reference_gradient,
               const double datum,
               const double                       time,
               const unsigned int                 number);

    /** Continue the list of an interrupted run, up to @p time. */
    void resume(const std::vector<std::pair<double, std::string>> &written, const double time);
    const std::vector<std::pair<double, std::string>> &written() const { return files; }

  private:
    const std::string                           folder;
    const bool                                  hdf5;
    std::vector<std::pair<double, std::string>> files;
    std::vector<std::string>                    xdmf_entries;
  };
} // namespace alluvium::observers
