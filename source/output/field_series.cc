#include <alluvium/output/field_series.h>
#include <alluvium/utilities/atomic_file.h>
#include <alluvium/utilities/compat.h>
#include <alluvium/utilities/user_error.h>
#include <alluvium/utilities/working_folder.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <sstream>

namespace alluvium::output
{
  using namespace dealii;

  namespace
  {
    /** As DataOutInterface::write_vtu_in_parallel(), with checks of what the disk takes. Collective. */
    template <int dim>
    void write_vtu(const MPI_Comm communicator, const std::string &file, const DataOutInterface<dim, 2> &data)
    {
      std::ostringstream whole;
      data.write_vtu(whole);
      const std::string text = whole.str(), open = "<UnstructuredGrid>\n", close = "</UnstructuredGrid>";
      const std::size_t begin = text.find(open) + open.size(), end = text.rfind(close);
      AssertThrow(begin < end && end != std::string::npos, ExcInternalError());
      // ParaView fails at an empty first piece; where all are empty, one stands for them
      const bool         has_cells = text.substr(begin, 1000).find("NumberOfCells=\"0\"") == std::string::npos;
      const unsigned int rank      = Utilities::MPI::this_mpi_process(communicator);
      const bool         none      = Utilities::MPI::max(int(has_cells), communicator) == 0;
      write_in_order(communicator,
                     file,
                     text.substr(0, begin),
                     has_cells || (none && rank == 0) ? text.substr(begin, end - begin) : "",
                     text.substr(end));
    }
  } // namespace

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
      write_hdf5(data, cell, time, base + ".h5");
    else
      {
        DataOutBase::VtkFlags flags;
        flags.time              = time;
        flags.compression_level = decltype(flags.compression_level)::best_speed;
        data.set_flags(flags);
        write_vtu(communicator, folder + "/" + base + ".vtu", data);
        entries.push_back({time, base + ".vtu", ""});
      }
    write_list(); // only of what is whole on the disk
  }


  template <int dim>
  void FieldSeries::write_hdf5(DataOutInterface<dim, 2> &data,
                               const ReferenceCell      &cell,
                               const double              time,
                               const std::string        &file)
  {
    DataOutBase::DataOutFilter filter(DataOutBase::DataOutFilterFlags(dim > 0, true));
    data.write_filtered_data(filter);

    // HDF5 does not take the empty arrays of a rank that has nothing to show
    const bool         has_data = filter.n_nodes() > 0;
    const unsigned int rank     = Utilities::MPI::this_mpi_process(communicator);
    const unsigned int n_ranks  = Utilities::MPI::n_mpi_processes(communicator);
    const unsigned int root     = Utilities::MPI::min(has_data ? rank : n_ranks, communicator);
    if (root == n_ranks)
      return; // nobody has

    // deal.II's filter knows the number of cells only where it has some; there are at most two of four corners a node
    double bytes = 0.;
    if (has_data)
      {
        bytes = (2. * 8. + 2. * 4. * 4.) * filter.n_nodes();
        for (unsigned int d = 0; d < filter.n_data_sets(); ++d)
          bytes += 8. * filter.n_nodes() * filter.get_data_set_dim(d);
      }
    check_room(communicator, folder + "/" + file, 1.1 * Utilities::MPI::sum(bytes, communicator) + 1e5);

    MPI_Comm those;
    MPI_Comm_split(communicator, has_data ? 0 : MPI_UNDEFINED, rank, &those);
    std::string       xdmf, complaint;
    const std::string unfinished = file + ".tmp";
    if (has_data)
      {
        try
          {
            const WorkingFolder here(folder);
            data.write_hdf5_parallel(filter, unfinished, those);
            xdmf = compat::xdmf_content(data.create_xdmf_entry(filter, file, time, those), 3, cell);
          }
        catch (const std::exception &)
          {
            complaint = "cannot write '" + folder + "/" + file + "': the HDF5 library has failed.";
          }
        MPI_Comm_free(&those);
      }
    const unsigned int failed = Utilities::MPI::min(complaint.empty() ? n_ranks : rank, communicator);
    if (failed == n_ranks && rank == 0)
      {
        std::error_code error;
        std::filesystem::rename(folder + "/" + unfinished, folder + "/" + file, error);
        if (error)
          complaint = "cannot write '" + folder + "/" + file + "': " + error.message() + ".";
      }
    complaint = Utilities::MPI::broadcast(communicator, complaint, failed == n_ranks ? 0 : failed);
    if (!complaint.empty() && rank == 0)
      std::remove((folder + "/" + unfinished).c_str());
    check_user(complaint.empty(), complaint);
    entries.push_back({time, file, Utilities::MPI::broadcast(communicator, xdmf, root)});
  }


  void FieldSeries::write_list() const
  {
    std::ostringstream list;
    if (hdf5)
      {
        list << "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n    <Grid Name=\"CellTime\" "
                "GridType=\"Collection\" CollectionType=\"Temporal\">\n";
        for (const auto &entry : entries)
          list << entry.xdmf;
        list << "    </Grid>\n  </Domain>\n</Xdmf>\n";
      }
    else
      {
        std::vector<std::pair<double, std::string>> files;
        for (const auto &entry : entries)
          files.emplace_back(entry.time, entry.file);
        DataOutBase::write_pvd_record(list, files);
      }
    write_atomically(communicator, folder + "/" + name + (hdf5 ? ".xdmf" : ".pvd"), list.str());
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
    if (!entries.empty())
      write_list(); // without what came after the checkpoint
  }


  template void FieldSeries::write<0>(DataOutInterface<0, 2> &, const ReferenceCell &, const double);
  template void FieldSeries::write<1>(DataOutInterface<1, 2> &, const ReferenceCell &, const double);
  template void FieldSeries::write<2>(DataOutInterface<2, 2> &, const ReferenceCell &, const double);
} // namespace alluvium::output
