#include <alluvium/contacts/grain_checkpoint.h>
#include <alluvium/run/checkpoint.h>
#include <alluvium/run/model.h>
#include <alluvium/run/output.h>
#include <alluvium/run/restart_parameters.h>
#include <alluvium/run/restart_walls.h>
#include <alluvium/utilities/checked_file.h>
#include <alluvium/utilities/first_rank.h>
#include <alluvium/utilities/input_files.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/grid/tria.h>

#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>

namespace alluvium::run
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    const std::string history_file = "history", solver_file = "solver";

    /** The walls at t = 0 as the parameters @p of_old of another run in @p domain say. */
    std::vector<grains::WallSegment> walls_of(const std::map<std::string, std::string> &of_old,
                                              const mesh::Domain<Model::dim>           &domain)
    {
      WallSetup        setup;
      ParameterHandler prm;
      setup.add_parameters(prm);
      for (const std::string name : {"Extra walls", "Motion of walls", "Presence of walls"})
        if (const auto value = of_old.find("Grains/" + name); value != of_old.end())
          prm.set(name, value->second);
      return setup.walls(domain);
    }
  } // namespace

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
    on_first_rank(m.communicator, [&] {
      fs::remove_all(folder_new);
      fs::create_directories(folder_new);
    });
    contacts::save_grains(m.communicator, folder_new + "/grains", m.grains, m.contacts.archive());
    ByteWriter history;
    (m.has_fluid ? mesh::Partition::of(*m.triangulation) : mesh::Partition()).save(history);
    history.put(m.touched);
    m.contacts.save(history);
    nlohmann::ordered_json state;
    if (m.has_fluid)
      {
        m.coupling.save(history, m.grains, m.touched, m.time_step, !m.grains_move);
        fluid::FluidCheckpoint<Model::dim>(folder_new)
          .save(m.space.dof_handler(), {&m.solver.solution(), &m.solver.old()}, m.space.nodal_dof_handler(), {});
        ByteWriter mine;
        m.solver.save_history(mine);
        ByteWriter of_all;
        for (const std::string &bytes : Utilities::MPI::gather(m.communicator, mine.bytes))
          of_all.put(bytes);
        write_checked_file(m.communicator, folder_new + "/" + solver_file, solver_file, of_all.bytes);
      }
    write_checked_file(m.communicator, folder_new + "/" + history_file, history_file, history.bytes);
    m.State::save(state);
    state["ranks"] = Utilities::MPI::n_mpi_processes(m.communicator);
    state["datum"] = m.solver.datum();
    for (const auto &[name, value] : m.parameters)
      state["parameters"][name] = value;
    if (m.is_root)
      save_output(state);
    write_checked_file(m.communicator, folder_new + "/state", "state", m.is_root ? state.dump(1) : "");
    on_first_rank(m.communicator, [&] {
      const std::string before = folder + ".before";
      fs::remove_all(before);
      if (fs::exists(folder))
        fs::rename(folder, before);
      fs::rename(folder_new, folder);
      fs::remove_all(before);
    });
  }


  Checkpoint::Checkpoint(MPI_Comm communicator, const std::string &newest)
    : folder(fs::exists(newest) ? newest : newest + ".before")
    , history(history_bytes)
    , fluid(folder)
  {
    check_user(fs::is_directory(folder),
               "Output/Restart: there is no checkpoint in '" + fs::path(newest).parent_path().string() + "'.");
    const std::string text = read_checked_file(communicator, folder + "/state", "state");
    history_bytes          = read_checked_file(communicator, folder + "/" + history_file, history_file);
    read([&] {
      state         = nlohmann::ordered_json::parse(text);
      as_many_ranks = state.at("ranks") == Utilities::MPI::n_mpi_processes(communicator);
    });
  }


  template <typename Action>
  void Checkpoint::read(const Action &action) const
  {
    const auto complain = [&] {
      throw UserError("Output/Restart: the checkpoint in '" + folder +
                      "' is not as this program writes it: was it made by another version?");
    };
    try
      {
        action();
      }
    catch (const UserError &)
      {
        throw;
      }
    catch (const nlohmann::json::exception &)
      {
        complain();
      }
    catch (const std::runtime_error &) // of ByteReader
      {
        complain();
      }
  }


  std::map<std::string, std::string> Checkpoint::parameters() const
  {
    std::map<std::string, std::string> result;
    read([&] { result = state.at("parameters").get<std::map<std::string, std::string>>(); });
    return result;
  }


  std::vector<std::string> Checkpoint::compare_parameters(const Model &m) const
  {
    const std::vector<ParameterChange> changes       = changed_parameters(parameters(), m.parameters);
    bool                               never_refines = false;
    read([&] { never_refines = state.at("never refines"); });
    return accept_changes(changes, never_refines, m.adaptivity.adapts());
  }


  std::string Checkpoint::description(const Model &m) const
  {
    std::ostringstream text;
    text << "Continues from t = " << m.time << " s, step " << m.n_steps << ", of the checkpoint in '" << folder << "'";
    if (!as_many_ranks)
      text << ", which was written on " << state.at("ranks") << " rank(s): round-off will differ";
    text << '.';
    return text.str();
  }


  void Checkpoint::load_grains(Model &m)
  {
    contacts::ContactArchive archive;
    contacts::load_grains(m.communicator, folder + "/grains", m.grains, archive);
    const std::map<std::string, std::string> before  = parameters();
    const std::vector<ParameterChange>       changes = changed_parameters(before, m.parameters);
    if (change_walls(changes))
      {
        double time = 0.;
        if (const auto fixed = before.find("Grains/Fixed"); fixed == before.end() || fixed->second != "true")
          read([&] { time = state.at("time"); });
        fit_to_walls(archive, walls_of(before, m.domain), m.contacts.walls(), time, m.time_step);
        check_room_at_walls(archive, m.contacts.walls(), m.grains, m.domain.periodicity());
      }
    m.contacts.set_archive(archive);
    read([&] {
      m.State::load(state);
      if (m.initial_diameter == 0.)
        m.initial_diameter = grains::mean_diameter(m.grains);
      if (m.clock.dt != m.time_step)
        m.clock = {m.time, m.n_steps, m.time_step};

      cells.load(history);
      if (state.at("ranks") != cells.n_ranks && m.has_fluid)
        throw std::runtime_error("The cells are those of other ranks.");
      m.touched = history.get_vector<std::uint8_t>();
      m.contacts.load(history);
    });
    for (const auto &[path, digest] : m.inputs)
      if (m.is_root && fs::exists(path) && digest_of_file(path) != digest)
        m.warnings.add("Output/Restart: '" + path +
                         "' is not what this run began with; the grains are those of the checkpoint, and what has "
                         "changed in the file is ignored",
                       m.time);
    if (change_contacts(changes))
      m.contacts.forget_search(); // and what rests
  }


  const mesh::Partition *Checkpoint::partition() const
  {
    return as_many_ranks ? &cells : nullptr;
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


  void Checkpoint::load_history(Model &m)
  {
    const std::string bytes = read_checked_file(m.communicator, folder + "/" + solver_file, solver_file);
    read([&] {
      m.coupling.load(history, m.grains);
      if (!as_many_ranks)
        return;
      ByteReader  of_all(bytes);
      std::string mine;
      for (unsigned int rank = 0; rank <= Utilities::MPI::this_mpi_process(m.communicator); ++rank)
        mine = of_all.get_string();
      ByteReader reader(mine);
      m.solver.load_history(reader);
    });
  }


  void Checkpoint::resume(Output &output) const
  {
    read([&] { output.load(state); });
  }
} // namespace alluvium::run
