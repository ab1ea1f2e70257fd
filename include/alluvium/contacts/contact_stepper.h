#pragma once

#include <alluvium/contacts/contact_force.h>
#include <alluvium/contacts/contact_memory.h>
#include <alluvium/contacts/contact_report.h>
#include <alluvium/contacts/laws/contact_settings.h>
#include <alluvium/contacts/ranks/ghost_exchange.h>
#include <alluvium/contacts/search/contact_archive.h>
#include <alluvium/grains/grain_arrays.h>
#include <alluvium/grains/periodicity.h>
#include <alluvium/grains/wall.h>
#include <alluvium/utilities/checked_file.h>

#include <mpi.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace alluvium::contacts
{
  /**
   * Moves the grains through one fluid step by non-smooth contact dynamics. Per sub-step of length h, with G the drag
   * coefficient of the loads,
   *
   *   m_e = m + h G        v_free = (m v + h f) / m_e        v = v_free + P / m_e        x += h v
   *
   * where the contact impulses P obey v_n + gap / h >= 0, Coulomb friction and Newton's restitution at the velocity
   * level. A grain spins with its true inertia m r^2 / 2. A grain of infinite mass keeps its velocity.
   *
   * With `Contact model = soft-sphere`, SoftSpheres does all this instead.
   *
   * Arrays are replicated: the same on all ranks before and after a step. With set_communicator(), ranks share the work
   * (ContactSubdomain); without, or where there is little of it, each does all. The same input gives the same bits
   * either way, on any number of ranks. When the last contact search was decides in which order contacts are solved,
   * which shows within the tolerance.
   */
  class ContactStepper
  {
  public:
    ContactStepper();
    ~ContactStepper();

    /** Declare the parameters of contacts in the current section of @p prm. */
    void add_parameters(dealii::ParameterHandler &prm);

    /** After the file was read; see Plugin. Throws UserError. */
    void parse_parameters();

    ContactSettings &settings();

    /** Whether contacts are springs, not impulses. */
    bool is_soft() const;

    /** Throws UserError for settings that do not fit them, such as a wall's name that is not among them. */
    void                                    set_walls(std::vector<grains::WallSegment> walls);
    const std::vector<grains::WallSegment> &walls() const; // where they are now, if they move

    /** When the next advance() starts [s]: walls may depend on it, nothing else does. */
    void set_time(double time);

    /**
     * Share the work of advance() with the other ranks of @p communicator; advance(), forces(), archive() and
     * set_communicator() are collective then. Every rank must have the same parameters and walls. Soft spheres and
     * cohesion are not shared.
     */
    void set_communicator(MPI_Comm communicator);

    /**
     * Move grains without a contact problem until two of them, or one and a wall, may meet in a step: that step is the
     * first with contacts, and are_left_out() is false from then on. Not for soft spheres, cohesion, or walls that move
     * (may_be_left_out()).
     */
    void leave_out(bool while_nothing_meets);
    bool are_left_out() const;
    bool may_be_left_out() const;

    /** The smallest gap between two grains, or a grain and a wall [m], or @p largest if that is less. */
    double smallest_gap(const grains::GrainArrays &grains, double largest) const;

    /** In words, who works on the contacts of @p n_grains. */
    std::string partitioning(std::size_t n_grains) const;

    /** What this rank has sent so far for the sake of contacts. */
    ContactTraffic traffic() const;

    /** Let the box repeat itself: grains that leave it come in again at the other side, initial positions along. */
    void set_periodicity(const grains::Periodicity &periodicity);

    /**
     * Advance positions, velocities and spins of @p grains by @p dt [s] under @p loads and contacts, and set their mean
     * contact force. @p gravity [m/s^2] only sets scales (it is part of the loads); without it the largest velocity
     * does. Where grains move, the tolerances are @p tolerance_factor times as large: for what will be taken back.
     * Throws a Divergence if a position or a velocity is not finite.
     */
    ContactReport advance(grains::GrainArrays      &grains,
                          const grains::GrainLoads &loads,
                          double                    dt,
                          std::array<double, 2>     gravity,
                          double                    tolerance_factor = 1.);

    /** Whether each grain had a contact impulse in the last advance(); n() entries of 0 or 1. */
    const std::vector<std::uint8_t> &touched() const;

    /**
     * The forces of all contacts in the last sub-step that @p grains took, cohesion included, with directions where the
     * grains are now.
     */
    std::vector<ContactForce> forces(const grains::GrainArrays &grains) const;

    /** What the springs of soft spheres hold now [J/m]; 0 with other contacts. */
    double spring_energy(const grains::GrainArrays &grains) const;

    /**
     * To try a step and take it back: restore() what memory() was before it, and start again from the grains of then.
     * The impulses of the try stay, as a first guess; contacts that have a history (cohesion, soft spheres) forget the
     * try altogether. Collective.
     */
    ContactMemory memory() const;
    void          restore(const ContactMemory &memory);

    /** Search anew in the next step: going on from here then gives the same bits as a restart from the archive. */
    void forget_search();

    ContactArchive archive() const;
    void           set_archive(ContactArchive archive);

    /**
     * What else the next step depends on: the last search and what is known to rest. After set_archive(), which forgets
     * them, a run goes on with the same bits. load() throws std::runtime_error if @p reader ends.
     */
    void save(ByteWriter &writer) const;
    void load(ByteReader &reader);

  private:
    class Implementation;
    std::unique_ptr<Implementation> implementation;
  };
} // namespace alluvium::contacts
