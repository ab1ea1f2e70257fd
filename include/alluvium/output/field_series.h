#pragma once

#include <mpi.h>
#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace dealii
{
  template <int, int>
  class DataOutInterface;
  class ReferenceCell;
} // namespace dealii

namespace alluvium::output
{
  /**
   * Fields for ParaView over time: one .vtu file an output whatever the number of ranks, listed with their times in a
   * .pvd file; or HDF5 files listed in a .xdmf file, for big runs.
   */
  class FieldSeries
  {
  public:
    /** Files `<folder>/<name>-00000.vtu` and so on. */
    FieldSeries(const std::string &folder, const std::string &name, const bool hdf5, MPI_Comm communicator);

    /**
     * Write the patches of @p data, which are cells of kind @p cell. Throws UserError if the disk does not take them;
     * then nothing is listed that is not whole. Collective.
     */
    template <int dim>
    void write(dealii::DataOutInterface<dim, 2> &data, const dealii::ReferenceCell &cell, const double time);

    /** What a checkpoint keeps, and how an interrupted run goes on; collective. */
    nlohmann::ordered_json state() const;
    void                   resume(const nlohmann::ordered_json &state);

  private:
    struct Entry
    {
      double      time;
      std::string file, xdmf;
    };

    template <int dim>
    void write_hdf5(dealii::DataOutInterface<dim, 2> &data,
                    const dealii::ReferenceCell      &cell,
                    const double                      time,
                    const std::string                &file);
    void write_list() const;

    const std::string  folder, name;
    const bool         hdf5;
    const MPI_Comm     communicator;
    std::vector<Entry> entries;
  };
} // namespace alluvium::output
