#include <alluvium/fluid/fluid_checkpoint.h>
#include <alluvium/mesh/p4est_abort.h>
#include <alluvium/utilities/atomic_file.h>
#include <alluvium/utilities/checked_file.h>
#include <alluvium/utilities/first_rank.h>
#include <alluvium/utilities/user_error.h>
#include <alluvium/utilities/working_folder.h>

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/solution_transfer.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    const std::string manifest_name = "fluid.manifest", mesh_name = "fluid_mesh", values_name = "fluid_values";

    /** A checksum of the unrefined mesh, the same on all ranks. */
    template <int dim>
    std::uint32_t checksum_of(const Triangulation<dim> &triangulation)
    {
      ByteWriter writer;
      for (const auto &cell : triangulation.cell_iterators_on_level(0))
        for (const unsigned int v : cell->vertex_indices())
          for (unsigned int d = 0; d < dim; ++d)
            writer.put(cell->vertex(v)[d]);
      return crc32(writer.bytes);
    }

    /** @p triangulation if it is distributed, or nullptr. */
    template <int dim>
    const parallel::distributed::Triangulation<dim> *as_distributed(const Triangulation<dim> &triangulation)
    {
      return dynamic_cast<const parallel::distributed::Triangulation<dim> *>(&triangulation);
    }

    /** The files that p4est and deal.II wrote for the mesh; their number depends on deal.II's version. */
    std::vector<std::filesystem::path> mesh_files(const std::string &folder)
    {
      std::vector<std::filesystem::path> result;
      for (const auto &entry : std::filesystem::directory_iterator(folder))
        if (entry.path().filename().string().compare(0, mesh_name.size(), mesh_name) == 0)
          result.push_back(entry.path());
      std::sort(result.begin(), result.end());
      return result;
    }

    std::string content_of(const std::filesystem::path &path)
    {
      std::ifstream      in(path, std::ios::binary);
      std::ostringstream text;
      text << in.rdbuf();
      return text.str();
    }

    /** What p4est and deal.II write for @p triangulation with @p n_values numbers a cell, and a little more. */
    template <int dim>
    double bytes_of(const Triangulation<dim> &triangulation, const double n_values)
    {
      return 1.1 * (triangulation.n_global_active_cells() * (8. * n_values + 64.) + triangulation.n_cells(0) * 256.) +
             65536.;
    }

    /**
     * Loop over the vertices whose dofs this rank owns: function(vertex index, component, dof). Vertices of a mesh that
     * is the same on all ranks have the same indices everywhere.
     */
    template <int dim, typename Function>
    void for_each_owned_vertex_dof(const DoFHandler<dim> &dofs, const Function &function)
    {
      const IndexSet    &owned = dofs.locally_owned_dofs();
      const unsigned int n     = dofs.get_fe().n_dofs_per_vertex();
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int v : cell->vertex_indices())
            for (unsigned int c = 0; c < n; ++c)
              if (const auto dof = cell->vertex_dof_index(v, c); owned.is_element(dof))
                function(cell->vertex_index(v), c, dof);
    }

    /** All values of @p field by vertex on all ranks. Bits are combined instead of numbers added: exact also for -0 and
     * NaN. */
    template <int dim, typename VectorType>
    std::vector<double> values_by_vertex(const DoFHandler<dim> &dofs, const VectorType &field)
    {
      const unsigned int         n = dofs.get_fe().n_dofs_per_vertex();
      std::vector<std::uint64_t> bits(n * dofs.get_triangulation().n_vertices(), 0);
      for_each_owned_vertex_dof(
        dofs, [&](const unsigned int vertex, const unsigned int c, const types::global_dof_index dof) {
          const double value = field(dof);
          std::memcpy(&bits[n * vertex + c], &value, sizeof(double));
        });
      MPI_Allreduce(MPI_IN_PLACE, bits.data(), bits.size(), MPI_UINT64_T, MPI_BOR, dofs.get_communicator());
      std::vector<double> values(bits.size());
      std::memcpy(values.data(), bits.data(), bits.size() * sizeof(double));
      return values;
    }

    template <int dim, typename VectorType>
    void set_by_vertex(const DoFHandler<dim> &dofs, const std::vector<double> &values, VectorType &field)
    {
      const unsigned int n = dofs.get_fe().n_dofs_per_vertex();
      field.zero_out_ghost_values();
      for_each_owned_vertex_dof(
        dofs, [&](const unsigned int vertex, const unsigned int c, const types::global_dof_index dof) {
          field(dof) = values.at(n * vertex + c);
        });
    }
  } // namespace


  template <int dim>
  FluidCheckpoint<dim>::FluidCheckpoint(const std::string &folder)
    : folder(folder)
  {}


  template <int dim>
  std::string FluidCheckpoint<dim>::file(const std::string &name) const
  {
    return (std::filesystem::path(folder) / name).string();
  }


  template <int dim>
  void FluidCheckpoint<dim>::save(const DoFHandler<dim>                  &system,
                                  const std::vector<const BlockVector *> &block_fields,
                                  const DoFHandler<dim>                  &nodal,
                                  const std::vector<const Vector *>      &nodal_fields) const
  {
    const Triangulation<dim> &triangulation = system.get_triangulation();
    const MPI_Comm            communicator  = triangulation.get_communicator();
    const auto               *distributed   = as_distributed(triangulation);

    // from here until the end there is no valid checkpoint in the folder
    on_first_rank(communicator, [&] {
      check_user(std::filesystem::is_directory(folder), "The folder '" + folder + "' for a checkpoint does not exist.");
      std::filesystem::remove(file(manifest_name));
      std::filesystem::remove(file(values_name));
      for (const auto &path : mesh_files(folder))
        std::filesystem::remove(path);
    });

    const double n_values = block_fields.size() * system.get_fe().n_dofs_per_cell() +
                            nodal_fields.size() * nodal.get_fe().n_dofs_per_cell(); // a cell
    if (distributed)
      {
        parallel::distributed::SolutionTransfer<dim, BlockVector> block_transfer(system);
        parallel::distributed::SolutionTransfer<dim, Vector>      nodal_transfer(nodal);
        for (const BlockVector *field : block_fields)
          field->update_ghost_values();
        for (const Vector *field : nodal_fields)
          field->update_ghost_values();
        if (!block_fields.empty())
          block_transfer.prepare_for_serialization(block_fields);
        if (!nodal_fields.empty())
          nodal_transfer.prepare_for_serialization(nodal_fields);
        check_room(communicator, file(mesh_name), bytes_of(triangulation, n_values));
        // the disk may still fill up between the trial and the write
        const mesh::P4estAbort ends(
          communicator, "cannot write '" + file(mesh_name) + "': there is hardly any room left on the disk.");
        const WorkingFolder here(folder);
        distributed->save(mesh_name);
      }
    else
      {
        ByteWriter writer;
        for (const BlockVector *field : block_fields)
          writer.put(values_by_vertex(system, *field));
        for (const Vector *field : nodal_fields)
          writer.put(values_by_vertex(nodal, *field));
        write_checked_file(communicator, file(values_name), "fluid-values", writer.bytes);
      }

    MPI_Barrier(communicator); // until all ranks have written
    std::string manifest;
    on_first_rank(communicator, [&] {
      std::ostringstream text;
      text << (distributed ? "distributed" : "replicated") << " " << checksum_of(triangulation) << " "
           << block_fields.size() << " " << nodal_fields.size() << "\n";
      // deal.II does not look whether what it wrote is there
      const double n_bytes = 8. * n_values * triangulation.n_global_active_cells();
      for (const auto &path : mesh_files(folder))
        {
          const std::string content = content_of(path);
          const bool        is_data = path.extension() == ".data";
          check_user(!content.empty() && (!is_data || content.size() >= n_bytes),
                     "cannot write '" + path.string() + "': there is hardly any room left on the disk.");
          text << content.size() << " " << crc32(content) << " " << path.filename().string() << "\n";
        }
      manifest = text.str();
    });
    write_checked_file(communicator, file(manifest_name), "fluid", manifest);
  }


  template <int dim>
  void FluidCheckpoint<dim>::load_mesh(Triangulation<dim> &triangulation)
  {
    const MPI_Comm     communicator = triangulation.get_communicator();
    auto              *distributed  = dynamic_cast<parallel::distributed::Triangulation<dim> *>(&triangulation);
    std::istringstream manifest(read_checked_file(communicator, file(manifest_name), "fluid"));
    std::string        kind;
    std::uint32_t      checksum = 0;
    manifest >> kind >> checksum >> n_block_fields >> n_nodal_fields;
    check_user(static_cast<bool>(manifest), "'" + file(manifest_name) + "' is not as this program writes it.");
    check_user(triangulation.n_levels() == 1 && checksum == checksum_of(triangulation) &&
                 kind == (distributed ? "distributed" : "replicated"),
               "The checkpoint in '" + folder +
                 "' was made with another unrefined mesh: section Domain, the mesh file or the coarsest cell size have "
                 "changed.");
    if (!distributed)
      return;

    // p4est aborts on a damaged file, so it must not see one
    on_first_rank(communicator, [&] {
      std::size_t   size;
      std::uint32_t crc;
      std::string   name;
      while (manifest >> size >> crc >> name)
        {
          const std::string path = file(name);
          check_user(std::filesystem::exists(path),
                     "'" + path + "' is missing; the checkpoint cannot be used without it.");
          const std::string content = content_of(path);
          check_user(content.size() == size,
                     "'" + path + "' holds " + std::to_string(content.size()) + " instead of " + std::to_string(size) +
                       " bytes: it is cut off or was altered.");
          check_user(crc32(content) == crc, "'" + path + "' is damaged: its checksum does not match.");
        }
    });
    const mesh::P4estAbort ends(communicator, "'" + file(mesh_name) + "' cannot be read.");
    const WorkingFolder    here(folder);
    distributed->load(mesh_name);
  }


  template <int dim>
  void FluidCheckpoint<dim>::load_fields(const DoFHandler<dim>            &system,
                                         const std::vector<BlockVector *> &block_fields,
                                         const DoFHandler<dim>            &nodal,
                                         const std::vector<Vector *>      &nodal_fields) const
  {
    const Triangulation<dim> &triangulation = system.get_triangulation();
    check_user(block_fields.size() == n_block_fields && nodal_fields.size() == n_nodal_fields,
               "The checkpoint in '" + folder +
                 "' holds other fields than this run needs: was the time scheme changed?");
    if (as_distributed(triangulation))
      {
        parallel::distributed::SolutionTransfer<dim, BlockVector> block_transfer(system);
        parallel::distributed::SolutionTransfer<dim, Vector>      nodal_transfer(nodal);
        std::vector<BlockVector *>                                blocks = block_fields;
        std::vector<Vector *>                                     nodals = nodal_fields;
        for (BlockVector *field : blocks)
          field->zero_out_ghost_values();
        for (Vector *field : nodals)
          field->zero_out_ghost_values();
        if (!blocks.empty())
          block_transfer.deserialize(blocks);
        if (!nodals.empty())
          nodal_transfer.deserialize(nodals);
      }
    else
      {
        const std::string bytes =
          read_checked_file(triangulation.get_communicator(), file(values_name), "fluid-values");
        ByteReader reader(bytes);
        for (BlockVector *field : block_fields)
          set_by_vertex(system, reader.get_vector<double>(), *field);
        for (Vector *field : nodal_fields)
          set_by_vertex(nodal, reader.get_vector<double>(), *field);
      }
    for (BlockVector *field : block_fields)
      field->update_ghost_values();
    for (Vector *field : nodal_fields)
      field->update_ghost_values();
  }


  template class FluidCheckpoint<2>;
} // namespace alluvium::fluid
