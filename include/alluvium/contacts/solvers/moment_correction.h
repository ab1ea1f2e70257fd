#pragma once

#include <alluvium/contacts/solvers/disc_places.h>
#include <alluvium/contacts/solvers/hat_grid.h>

#include <array>
#include <optional>
#include <vector>

namespace alluvium::contacts
{
  /**
   * The smooth part of the velocities that sweeps leave in a bed at rest: an estimate, and a correction.
   *
   * Sweeps balance a disc against its neighbours at once, but a large part of the bed against the rest only after many
   * sweeps. Here impulses change by the factor 1 + a(x), with a bilinear on cells of 20 diameters: of all such changes
   * that which leaves the least kinetic energy (Galerkin). With the hats phi_k, and the impulses f on disc i at x_c,
   *
   *   f_ik = phi_k(x_i) F_i + grad phi_k(x_i) . S_i     F_i = sum f     S_i = sum (x_c - x_i) (x) f
   *   A_kl = sum_i f_ik . M_i^-1 f_il,   g_k = sum_i f_ik . v_i,   A a = -g,   gain = -g . a / 2
   *
   * The gain is the kinetic energy of a smooth error, to which the residual of single contacts is blind. Scaled
   * impulses stay positive and within their cones. Where grains really move, the change would load contacts to hold
   * them up: there the smooth part is not most of the energy, and nothing is changed. Collective; the same bits on any
   * number of ranks.
   */
  class MomentCorrection
  {
  public:
    /** What there is of motion. */
    struct Estimate
    {
      double gain           = 0.; // [J/m]
      double kinetic_energy = 0.; // [J/m]
      double velocity       = 0.; // root mean square of the smooth part [m/s]
    };

    /**
     * Begin a solve of @p problem, whose discs are at @p places, which must live as long as the solve. @p period: of
     * the box [m], 0 where it is not periodic.
     */
    void begin(const ContactProblem &problem, const DiscPlaces &places, const std::array<double, 2> &period);

    /** Of @p problem as it stands after @p sweeps. */
    const Estimate &estimate(const ContactProblem &problem, unsigned int sweeps);

    /**
     * The smooth velocity of @p problem with so much kinetic energy [J/m], or the root mean square of all velocities
     * where that is at most @p limit [m/s] already: it is never smaller, and costs nothing.
     */
    double velocity(const ContactProblem &problem, double kinetic_energy, unsigned int sweeps, double limit);

    /** To be told that this was above the limit: a correction is due at once, and may_look() false for a few sweeps. */
    void disappoint(unsigned int sweeps);
    bool may_look(const unsigned int sweeps) const { return sweeps >= next_look; }

    /** Whether a correction is due after @p sweeps: after 5, 25, 65, 145, ... */
    bool is_due(const unsigned int sweeps) const { return sweeps >= due; }

    /**
     * Correct impulses and velocities after @p sweeps, unless too little of the energy would go. Returns whether it
     * has.
     */
    bool correct(ContactProblem &problem, unsigned int sweeps);

    /** How many there were since begin(). */
    unsigned int n_corrections() const { return n_done; }

  private:
    struct Moments
    {
      std::array<double, 3> force{}, along_x{}, along_y{}; // impulses (x, y, s), and their first moments
    };

    static constexpr unsigned int n_entries = 14; // of a cell: A between its hats, 10, and g, 4
    static constexpr unsigned int never     = -1;

    std::optional<DiscPlaces> places;
    HatGrid                   grid;
    double                    n_all = 0., mass = 0.; // number and mass of the discs on all ranks
    unsigned int              due = never, latest_sweeps = never, next_look = 0, n_done = 0;
    std::vector<Moments>      moments;     // of owned discs
    std::vector<double>       sums;        // cell x entries, then twice the kinetic energy
    std::vector<double>       coefficient; // a
    Estimate                  latest;

    void add_moments(const ContactProblem &problem);
    void assemble(const ContactProblem &problem);
    void solve();
  };

  /** Correct the impulses of @p problem if it has a correction and that is due; whether they have changed. */
  bool correct_if_due(ContactProblem &problem, unsigned int sweeps);
} // namespace alluvium::contacts
