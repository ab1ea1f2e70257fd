#include <alluvium/observers/field_series.h>
#include <alluvium/utilities/compat.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <nlohmann/json.hpp>

#include <fstream>

namespace alluvium::observers
{
  using namespace dealii;

  FieldSeries::FieldSeries(const std::string &folder, const std::string &name, const bool hdf5, MPI_Comm communicator)
    : folder(folder)
    , name(name)
    , hdf5(hdf5)
    , communicator(communicator)
  {}


  template <int dim>
  void FieldSeries::write(DataOutInterface<dim, 2> &data, const ReferenceCell &cell, const double time)
  {
    const std::string base = name + "-" + Utilities::int_to_string(entries.size(), 5);
    if (hdf5)
      {
        DataOutBase::DataOutFilter filter(DataOutBase::DataOutFilterFlags(dim > 0, true));
        data.write_filtered_data(filter);
        data.write_hdf5_parallel(filter, folder + "/" + base + ".h5", communicator);
        const XDMFEntry entry = data.create_xdmf_entry(filter, base + ".h5", time, communicator);
        entries.push_back({time, base + ".h5", compat::xdmf_content(entry, 3, cell)});
      }
    else
      {
        DataOutBase::VtkFlags flags;
        flags.time              = time;
        flags.compression_level = decltype(flags.compression_level)::best_speed;
        data.set_flags(flags);
        data.write_vtu_in_parallel(folder + "/" + base + ".vtu", communicator);
        entries.push_back({time, base + ".vtu", ""});
      }
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      write_list();
  }


  void FieldSeries::write_list() const
  {
    if (hdf5)
      {
        std::ofstream xdmf(folder + "/" + name + ".xdmf");
        xdmf << "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n    <Grid Name=\"CellTime\" "
                "GridType=\"Collection\" CollectionType=\"Temporal\">\n";
        for (const auto &entry : entries)
          xdmf << entry.xdmf;
        xdmf << "    </Grid>\n  </Domain>\n</Xdmf>\n";
      }
    else
      {
        std::vector<std::pair<double, std::string>> files;
        for (const auto &entry : entries)
          files.emplace_back(entry.time, entry.file);
        std::ofstream pvd(folder + "/" + name + ".pvd");
        DataOutBase::write_pvd_record(pvd, files);
      }
  }


  nlohmann::ordered_json FieldSeries::state() const
  {
    nlohmann::ordered_json result = nlohmann::ordered_json::array();
    for (const auto &entry : entries)
      result.push_back({entry.time, entry.file, entry.xdmf});
    return result;
  }


  void FieldSeries::resume(const nlohmann::ordered_json &state)
  {
    entries.clear();
    for (const auto &entry : state)
      entries.push_back({entry.at(0), entry.at(1), entry.at(2)});
    if (!entries.empty() && Utilities::MPI::this_mpi_process(communicator) == 0)
      write_list(); // without what came after the checkpoint
  }


  template void FieldSeries::write<0>(DataOutInterface<0, 2> &, const ReferenceCell &, const double);
  template void FieldSeries::write<2>(DataOutInterface<2, 2> &, const ReferenceCell &, const double);
} // namespace alluvium::observers
