#include <alluvium/observers/fluid_output.h>

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>
#include <deal.II/numerics/data_out.h>

#include <fstream>

namespace alluvium::observers
{
  using namespace dealii;

  void FluidOutput::write(const fluid::FluidSpace<2> &space,
                          const fluid::BlockVector   &solution,
                          const fluid::Vector        &void_fraction,
                          const Tensor<1, 2>         &reference_gradient,
               const double datum,
                          const double                time,
                          const unsigned int          number)
  {
    // the total pressure needs the nodes' places
    fluid::Vector pressure = space.make_nodal_field();
    for (const auto &cell : space.cells())
      for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
        pressure.local_element(cell.node[v]) =
          solution.block(1).local_element(cell.pressure[v]) + reference_gradient * cell.vertex[v] + datum;
    pressure.update_ghost_values();

    DataOut<2> data;
    using Interpretation = DataComponentInterpretation::DataComponentInterpretation;
    data.add_data_vector(space.dof_handler(),
                         solution,
                         {"velocity", "velocity", "reduced_pressure"},
                         {Interpretation::component_is_part_of_vector,
                          Interpretation::component_is_part_of_vector,
                          Interpretation::component_is_scalar});
    data.add_data_vector(space.nodal_dof_handler(), pressure, "pressure");
    data.add_data_vector(space.nodal_dof_handler(), void_fraction, "void_fraction");
    DataOutBase::VtkFlags flags;
    flags.time              = time;
    flags.compression_level = DataOutBase::VtkFlags::best_speed;
    data.set_flags(flags);
    data.build_patches(space.mapping());

    const MPI_Comm    comm = space.communicator();
    const std::string base = "fluid-" + Utilities::int_to_string(number, 5);
    if (hdf5)
      {
        DataOutBase::DataOutFilter filter(DataOutBase::DataOutFilterFlags(true, true));
        data.write_filtered_data(filter);
        data.write_hdf5_parallel(filter, folder + "/" + base + ".h5", comm);
        const XDMFEntry entry = data.create_xdmf_entry(filter, base + ".h5", time, comm);
        if (Utilities::MPI::this_mpi_process(comm) == 0)
          {
            xdmf_entries.push_back(entry.get_xdmf_content(3, ReferenceCells::Quadrilateral));
            files.emplace_back(time, base + ".h5");
            std::ofstream xdmf(folder + "/fluid.xdmf");
            xdmf << "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n    <Grid Name=\"CellTime\" GridType=\"Collection\" "
                    "CollectionType=\"Temporal\">\n";
            for (const auto &text : xdmf_entries)
              xdmf << text;
            xdmf << "    </Grid>\n  </Domain>\n</Xdmf>\n";
          }
        return;
      }
    data.write_vtu_in_parallel(folder + "/" + base + ".vtu", comm);
    files.emplace_back(time, base + ".vtu");
    if (Utilities::MPI::this_mpi_process(comm) == 0)
      {
        std::ofstream pvd(folder + "/fluid.pvd");
        DataOutBase::write_pvd_record(pvd, files);
      }
  }



  void FluidOutput::resume(const std::vector<std::pair<double, std::string>> &written, const double time)
  {
    files.clear();
    for (const auto &file : written)
      if (file.first <= time * (1. + 1e-12))
        files.push_back(file);
  }
} // namespace alluvium::observers
