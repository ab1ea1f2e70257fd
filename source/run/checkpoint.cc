#include <alluvium/grains/grain_checkpoint.h>
#include <alluvium/run/checkpoint.h>
#include <alluvium/run/model.h>
#include <alluvium/run/output.h>
#include <alluvium/utilities/checked_file.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/grid/tria.h>

#include <filesystem>

namespace alluvium::run
{
  namespace fs = std::filesystem;

  void Checkpoint::write(const std::string &folder, Model &m, const Output &output)
  {
    write(folder, m, [&](nlohmann::ordered_json &state) { output.save(state); });
  }


  void Checkpoint::write(const std::string                                   &folder,
                         Model                                               &m,
                         const std::function<void(nlohmann::ordered_json &)> &save_output)
  {
    const auto timer = m.timers.scope("checkpoints");
    // a new folder takes the place of the old one only when it is complete
    const std::string folder_new = folder + ".new";
    if (m.speaks)
      {
        fs::remove_all(folder_new);
        fs::create_directories(folder_new);
      }
    MPI_Barrier(m.communicator);
    grains::save_grains(m.communicator, folder_new + "/grains", m.grains, m.contacts.archive());
    // the run that goes on and the one that restarts shall both begin with a new contact search ...
    m.contacts.forget_search();
    nlohmann::ordered_json state;
    if (m.has_fluid)
      {
        mesh::FluidCheckpoint<Model::dim>(folder_new)
          .save(m.space.dof_handler(), {&m.solver.solution(), &m.solver.old()}, m.space.nodal_dof_handler(), {});
        // ... with a fresh preconditioner, and with all grains cut anew
        m.solver.linear_solver.clear();
        m.coupling.forget_positions();
      }
    state["time"]   = m.time;
    state["steps"]  = m.n_steps;
    state["datum"]  = m.solver.datum();
    state["counts"] = m.counts;
    if (m.speaks)
      save_output(state);
    write_checked_file(m.communicator, folder_new + "/state", "state", m.speaks ? state.dump(1) : "");
    if (m.speaks)
      {
        const std::string before = folder + ".before";
        fs::remove_all(before);
        if (fs::exists(folder))
          fs::rename(folder, before);
        fs::rename(folder_new, folder);
        fs::remove_all(before);
      }
    MPI_Barrier(m.communicator);
  }


  Checkpoint::Checkpoint(MPI_Comm communicator, const std::string &newest)
    : folder(fs::exists(newest) ? newest : newest + ".before")
    , fluid(folder)
  {
    check_user(fs::is_directory(folder),
               "Output/Restart: there is no checkpoint in '" + fs::path(newest).parent_path().string() + "'.");
    const std::string text = read_checked_file(communicator, folder + "/state", "state");
    read([&] { state = nlohmann::ordered_json::parse(text); });
  }


  template <typename Action>
  void Checkpoint::read(const Action &action) const
  {
    try
      {
        action();
      }
    catch (const nlohmann::json::exception &)
      {
        throw UserError("Output/Restart: '" + folder +
                        "/state' is not as this program writes it: was it made by another version?");
      }
  }


  void Checkpoint::load_grains(Model &m) const
  {
    read([&] {
      m.time    = state.at("time");
      m.n_steps = state.at("steps");
      m.counts  = state.at("counts").get<decltype(m.counts)>();
    });
    grains::ContactArchive archive;
    const std::size_t      n = m.grains.n();
    grains::load_grains(m.communicator, folder + "/grains", m.grains, archive);
    check_user(m.grains.n() == n,
               "Output/Restart: the checkpoint has " + std::to_string(m.grains.n()) + " grains, the scene " +
                 std::to_string(n) + ".");
    m.contacts.set_archive(archive);
    for (std::size_t i = 0; i < n; ++i)
      m.touched[i] = m.grains.fcx[i] != 0. || m.grains.fcy[i] != 0.;
  }


  void Checkpoint::load_mesh(dealii::Triangulation<2, 2> &mesh)
  {
    fluid.load_mesh(mesh);
  }


  void Checkpoint::load_fields(Model &m) const
  {
    read([&] { m.solver.set_datum(state.at("datum")); });
    fluid::BlockVector field = m.space.make_field(), before = field;
    fluid.load_fields(m.space.dof_handler(), {&field, &before}, m.space.nodal_dof_handler(), {});
    m.solver.set_solution(field);
    m.solver.old() = before;
    m.solver.old().update_ghost_values();
  }


  void Checkpoint::resume(Output &output) const
  {
    read([&] { output.load(state); });
  }
} // namespace alluvium::run
