#include <alluvium/contacts/contact_force_list.h>
#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/contacts/contact_substep.h>
#include <alluvium/contacts/free_flight.h>
#include <alluvium/contacts/laws/cohesion.h>
#include <alluvium/contacts/laws/contact_law.h>
#include <alluvium/contacts/rest.h>
#include <alluvium/contacts/soft_spheres.h>
#include <alluvium/utilities/plugin.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace alluvium::contacts
{
  namespace
  {
    constexpr const char *default_solver = "accelerated Gauss-Seidel";


    /** Whether every grain hangs together with a wall, or with a grain of infinite mass, by contacts that press. */
    bool all_are_supported(const grains::GrainArrays &grains, const ContactArchive &contacts)
    {
      const std::size_t        n = grains.n(), support = n;
      std::vector<std::size_t> parent(n + 1);
      std::iota(parent.begin(), parent.end(), std::size_t(0));
      const auto root = [&](std::size_t k) {
        while (parent[k] != k)
          k = parent[k] = parent[parent[k]];
        return k;
      };
      const auto number = [&](const grains::GrainId id) -> std::size_t {
        return std::lower_bound(grains.id.begin(), grains.id.end(), id) - grains.id.begin();
      };
      for (const ContactArchive::Entry &e : contacts.entries)
        if (e.rn != 0. || e.bonded)
          parent[root(number(e.a))] = root(e.wall ? support : number(e.b));
      for (std::size_t k = 0; k < n; ++k)
        if (std::isinf(grains.mass[k]))
          parent[root(k)] = root(support);
      for (std::size_t k = 0; k < n; ++k)
        if (root(k) != root(support))
          return false;
      return true;
    }

    void refuse_with_soft_spheres(const bool asks_for_more)
    {
      check_user(!asks_for_more,
                 "Contacts/Contact model: soft spheres know neither rolling friction nor cohesion, and of contact laws "
                 "only Coulomb's.");
    }
  } // namespace


  class ContactStepper::Implementation
  {
  public:
    ContactSettings             settings;
    std::string                 model = "non-smooth";
    SoftSpheres                 soft_spheres;
    PluginChoice<ContactSolver> choice;
    PluginChoice<ContactLaw>    law_choice;
    PluginChoice<Cohesion>      cohesion_choice;
    LocalContactProblem         local;
    Rest                        rest;
    double                      time = 0.; // when the next step starts [s]
    FreeFlight                  flight;
    bool                        are_left_out = false;

    ContactReport advance(grains::GrainArrays      &grains,
                          const grains::GrainLoads &loads,
                          double                    dt,
                          std::array<double, 2>     gravity,
                          double                    tolerance_factor);

    const Cohesion *acting_cohesion() const
    {
      return !cohesion_choice.name().empty() && cohesion_choice.get().acts() ? &cohesion_choice.get() : nullptr;
    }

    const ContactLaw *acting_law() const
    {
      return !law_choice.name().empty() && !law_choice.get().is_constant() ? &law_choice.get() : nullptr;
    }

    /**
     * Whether ranks share the work on @p n grains. Cohesion and soft spheres sum forces pair by pair in the order of
     * all grains, so there every rank does all.
     */
    bool is_partitioned(const std::size_t n) const
    {
      return local.n_ranks() > 1 && model == "non-smooth" && acting_cohesion() == nullptr &&
             n >= settings.least_grains_a_rank * local.n_ranks();
    }

    void forget()
    {
      local.neighbours.forget();
      local.repeat_search({});
      rest.forget();
      flight.forget();
    }

  private:
    mutable std::unique_ptr<ContactSolver> own_solver;

    ContactSubstep substep{settings, local};

    const ContactSolver &solver() const
    {
      if (!choice.name().empty())
        return choice.get();
      if (!own_solver)
        own_solver = Registry<ContactSolver>::entries().at(default_solver).create();
      return *own_solver;
    }
  };


  ContactReport ContactStepper::Implementation::advance(grains::GrainArrays        &grains,
                                                        const grains::GrainLoads   &loads,
                                                        const double                dt,
                                                        const std::array<double, 2> gravity,
                                                        const double                tolerance_factor)
  {
    ContactReport     report;
    const std::size_t n     = grains.n();
    auto             &walls = local.geometry.walls;
    walls.set_time(time);
    if (loads.force[0].size() != n || loads.force[1].size() != n || loads.drag.size() != n)
      throw std::logic_error("ContactStepper::advance: the loads have another size than the grains.");
    Assert(grains.position[1].size() == n && grains.radius.size() == n && grains.mass.size() == n &&
             grains.velocity[0].size() == n && grains.velocity[1].size() == n && grains.omega.size() == n,
           dealii::ExcMessage("Columns of the grains have different lengths."));
    Assert(std::is_sorted(grains.id.begin(), grains.id.end()),
           dealii::ExcMessage("The grains are sorted by their ids."));
    for (const grains::WallSegment &w : walls.segments())
      report.wall_force[w.name] = {{0., 0.}};
    local.all_touched.assign(n, 0);
    if (n == 0 || !(dt > 0.))
      return report;

    ContactMaterials      materials = make_materials(settings, walls.segments());
    const Cohesion *const cohesion  = acting_cohesion();
    materials.law                   = acting_law();
    const ContactScales scales      = make_scales(grains, gravity);
    if (are_left_out)
      {
        if (flight.is_safe(grains, loads, dt, settings.rotation, local.geometry))
          {
            report.n_substeps = count_substeps(grains, loads, dt, settings.max_move * scales.d_min);
            grains.contact_force[0].assign(n, 0.);
            grains.contact_force[1].assign(n, 0.);
            flight.move(grains, loads, dt / report.n_substeps, report.n_substeps, settings.rotation, local.geometry);
            for (std::size_t k = 0; k < n; ++k)
              report.max_velocity =
                std::max(report.max_velocity, std::hypot(grains.velocity[0][k], grains.velocity[1][k]));
            return report;
          }
        are_left_out = false;
        forget(); // where grains were when they were last looked at
      }
    local.repeat_search(grains, loads, is_partitioned(n));
    if (model == "soft-sphere")
      {
        refuse_with_soft_spheres(materials.rolls || materials.law || cohesion);
        return soft_spheres.advance(grains,
                                    loads,
                                    dt,
                                    materials,
                                    settings.rotation,
                                    settings.skin * scales.d_max,
                                    local.geometry,
                                    local.neighbours,
                                    local.all_touched);
      }
    rest.steps       = settings.rest_steps;
    rest.periodicity = local.geometry.periodicity;
    const Rest::Scales rest_scales{dt, scales.g, scales.mean_mass * scales.g, scales.d_min};
    if (walls.act(dt))
      rest.forget();
    else if (rest.holds(grains, loads, rest_scales))
      return rest.stand_still(loads, grains, local.all_touched);

    const unsigned int steps = std::max(count_substeps(grains, loads, dt, settings.max_move * scales.d_min),
                                        walls.count_substeps(dt, scales.d_min));
    // Until the end, contact forces are impulses, summed over the sub-steps.
    grains.contact_force[0].assign(n, 0.);
    grains.contact_force[1].assign(n, 0.);
    local.begin(grains, loads, is_partitioned(n));
    substep.begin({scales, std::move(materials), &solver(), cohesion, dt / steps, tolerance_factor});
    for (unsigned int s = 0; s < steps; ++s)
      substep.advance(report);
    substep.finish(report);
    local.end();

    for (std::size_t k = 0; k < n; ++k)
      {
        grains.contact_force[0][k] /= dt;
        grains.contact_force[1][k] /= dt;
      }
    for (std::size_t k = 0; k < walls.segments().size(); ++k)
      {
        for (unsigned int d = 0; d < 2; ++d)
          report.wall_force[walls.segments()[k].name][d] += substep.wall_impulses()[k][d] / dt;
        report.wall_work += substep.wall_impulses()[k][2];
      }
    rest.watch(grains, loads, rest_scales, local.all_touched, report);
    // grains that touch each other only, in mid-water, are slow, but not at rest
    if (rest.steps > 0 && report.n_quiet >= rest.steps && !all_are_supported(grains, local.archive()))
      {
        rest.forget();
        report.n_quiet = 0;
      }
    return report;
  }


  ContactStepper::ContactStepper()
    : implementation(std::make_unique<Implementation>())
  {}

  ContactStepper::~ContactStepper() = default;

  void ContactStepper::add_parameters(dealii::ParameterHandler &prm)
  {
    implementation->settings.add_parameters(prm);
    prm.add_parameter(
      "Contact model",
      implementation->model,
      "`non-smooth`: impulses that keep grains apart, with any time step; `soft-sphere`: springs between "
      "grains that overlap, with as many sub-steps as their stiffness needs, for comparison.",
      dealii::Patterns::Selection("non-smooth|soft-sphere"));
    implementation->soft_spheres.add_parameters(prm);
    implementation->choice.add_parameters(
      prm, "Contact solver", default_solver, "How the contact problem of a sub-step is solved.");
    implementation->law_choice.add_parameters(
      prm, "Contact law", "Coulomb", "What friction and restitution depend on.");
    implementation->cohesion_choice.add_parameters(
      prm, "Cohesion", "none", "What attracts grains, and grains and walls.");
  }

  void ContactStepper::parse_parameters()
  {
    implementation->choice.parse_parameters();
    implementation->law_choice.parse_parameters();
    implementation->cohesion_choice.parse_parameters();
    if (is_soft())
      refuse_with_soft_spheres(implementation->acting_law() || implementation->acting_cohesion());
  }

  ContactSettings &ContactStepper::settings()
  {
    return implementation->settings;
  }

  bool ContactStepper::is_soft() const
  {
    return implementation->model == "soft-sphere";
  }

  void ContactStepper::set_walls(std::vector<grains::WallSegment> walls)
  {
    const ContactMaterials materials = make_materials(settings(), walls);
    if (is_soft())
      refuse_with_soft_spheres(materials.rolls);
    implementation->local.geometry.walls.set(std::move(walls));
    implementation->forget();
  }

  void ContactStepper::leave_out(const bool while_nothing_meets)
  {
    implementation->are_left_out = while_nothing_meets;
    implementation->flight.forget();
  }

  bool ContactStepper::are_left_out() const
  {
    return implementation->are_left_out;
  }

  bool ContactStepper::may_be_left_out() const
  {
    return implementation->model == "non-smooth" && implementation->acting_cohesion() == nullptr &&
           std::none_of(walls().begin(), walls().end(), grains::ever_acts);
  }

  double ContactStepper::smallest_gap(const grains::GrainArrays &grains, const double largest) const
  {
    return grains.n() == 0 ? largest : FreeFlight::smallest_gap(grains, implementation->local.geometry, largest);
  }

  void ContactStepper::set_time(const double time)
  {
    implementation->time = time;
  }

  const std::vector<grains::WallSegment> &ContactStepper::walls() const
  {
    return implementation->local.geometry.walls.segments();
  }

  void ContactStepper::set_periodicity(const grains::Periodicity &periodicity)
  {
    implementation->local.geometry.periodicity = periodicity;
    implementation->local.neighbours.forget();
  }

  ContactReport ContactStepper::advance(grains::GrainArrays        &grains,
                                        const grains::GrainLoads   &loads,
                                        const double                dt,
                                        const std::array<double, 2> gravity,
                                        const double                tolerance_factor)
  {
    return implementation->advance(grains, loads, dt, gravity, tolerance_factor);
  }

  void ContactStepper::set_communicator(const MPI_Comm communicator)
  {
    implementation->local.set_communicator(communicator);
  }

  std::string ContactStepper::partitioning(const std::size_t n_grains) const
  {
    const unsigned int n_ranks = implementation->local.n_ranks();
    if (n_ranks == 1)
      return "on one rank";
    if (implementation->is_partitioned(n_grains))
      return "shared by " + std::to_string(n_ranks) + " ranks";
    return std::string("not shared, all ") + std::to_string(n_ranks) + " ranks do the same: " +
           (implementation->model != "non-smooth"          ? "soft spheres"
            : implementation->acting_cohesion() != nullptr ? "cohesion"
                                                           : "too few grains a rank (Contacts/Least grains a rank)");
  }

  ContactTraffic ContactStepper::traffic() const
  {
    return implementation->local.traffic();
  }

  const std::vector<std::uint8_t> &ContactStepper::touched() const
  {
    return implementation->local.all_touched;
  }

  std::vector<ContactForce> ContactStepper::forces(const grains::GrainArrays &grains) const
  {
    return list_contact_forces(implementation->local,
                               grains,
                               is_soft() ? &implementation->soft_spheres : nullptr,
                               implementation->acting_cohesion());
  }

  double ContactStepper::spring_energy(const grains::GrainArrays &grains) const
  {
    if (!is_soft())
      return 0.;
    const ContactGeometry &geometry = implementation->local.geometry;
    ContactNeighbours      now; // the pairs in use may be older than the last change
    now.set_archive(implementation->local.archive());
    now.search(grains, geometry, 0.);
    return implementation->soft_spheres.spring_energy(grains, geometry, now.pairs);
  }

  ContactMemory ContactStepper::memory() const
  {
    const bool    has_history = is_soft() || implementation->acting_cohesion() != nullptr;
    ContactMemory result{implementation->local.geometry.walls.positions(), implementation->rest, {}};
    if (has_history)
      result.history = archive();
    return result;
  }

  void ContactStepper::restore(const ContactMemory &memory)
  {
    if (memory.history)
      set_archive(*memory.history);
    implementation->local.geometry.walls.place(memory.wall_positions);
    implementation->rest = memory.rest;
  }

  void ContactStepper::forget_search()
  {
    implementation->forget();
  }

  ContactArchive ContactStepper::archive() const
  {
    ContactArchive result = implementation->local.archive();
    result.wall_positions = implementation->local.geometry.walls.positions();
    return result;
  }

  void ContactStepper::set_archive(ContactArchive archive)
  {
    implementation->local.geometry.walls.place(archive.wall_positions);
    implementation->local.neighbours.set_archive(std::move(archive));
    implementation->local.repeat_search({});
    implementation->rest.forget();
  }

  void ContactStepper::save(ByteWriter &writer) const
  {
    const ContactSearchRecord last = implementation->local.last_search();
    writer.put<std::uint8_t>(last.known);
    for (const auto *values : {&last.x, &last.y, &last.wall_positions})
      writer.put(*values);
    writer.put(last.skin);
    writer.put(last.left);
    implementation->rest.save(writer);
  }

  void ContactStepper::load(ByteReader &reader)
  {
    ContactSearchRecord last;
    last.known = reader.get<std::uint8_t>() != 0;
    for (auto *values : {&last.x, &last.y, &last.wall_positions})
      *values = reader.get_vector<double>();
    last.skin = reader.get<double>();
    last.left = reader.get<double>();
    implementation->local.repeat_search(std::move(last));
    implementation->rest.load(reader);
  }
} // namespace alluvium::contacts
