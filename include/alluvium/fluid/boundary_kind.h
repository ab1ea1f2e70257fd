#pragma once

#include <alluvium/utilities/plugin.h>

#include <deal.II/base/types.h>

#include <memory>
#include <string>

namespace alluvium::fluid
{
  template <int dim>
  struct BoundaryScene;
  template <int dim>
  class FaceState;
  template <int dim>
  struct FaceTerms;

  /**
   * Interface of kinds of boundary conditions: what the fluid may do at a boundary. A kind is registered under the name
   * of the parameter that lists its boundaries, in the section "Boundary conditions". Without values that is a list of
   * names, with values `name: expression; name: expression`. All boundaries of a kind share one instance. The same on
   * all ranks.
   *
   * What is held at nodes is said by velocity() and gives_pressure(). Where several conditions meet at a node, a given
   * velocity is stronger than u = 0, and this stronger than u.n = 0; but at corners a wall holds its end.
   */
  template <int dim>
  class BoundaryKind : public Plugin
  {
  public:
    /** What is held of the velocity at the boundary's nodes. */
    enum class Velocity
    {
      free,
      no_flow_through, // u.n = 0
      zero,            // u = 0
      given            // u is the value; the continuity equation gets its flux, exact on cells of any size
    };


    /** Declare what the kind has besides its boundaries, in the section "Boundary conditions". */

    virtual Velocity velocity() const = 0;

    /** Is the pressure held at the boundary's nodes? Then the first value is that pressure [Pa]. */
    virtual bool gives_pressure() const { return false; }

    /** How many values a boundary has, as expressions that `|` separates; of a given velocity its components [m/s]. */
    virtual unsigned int n_values() const { return 0; }

    /** May value @p component be @p value, which is finite? If not, expected() is what is said. */
    virtual bool        allows(const unsigned int, const double) const { return true; }
    virtual std::string expected() const { return "a finite number"; }

    /** What --check calls it; the values follow. */
    virtual std::string in_words() const = 0;

    /** May fluid pass? Then there is a column of its flux. */
    virtual bool lets_fluid_pass() const { return gives_pressure() || velocity() == Velocity::given; }

    /** Does it say how high the pressure is? In a box where no boundary does, that is fixed at a node. */
    virtual bool fixes_pressure() const { return gives_pressure(); }

    /** Does add_terms() add any? */
    virtual bool has_terms() const { return false; }

    /**
     * Add terms of the weak form on a face, linearised, in the sense of terms of the left-hand side: with the rows of
     * momentum v.(-traction), with those of continuity q eps u.n where fluid passes that velocity() leaves free. Not
     * collective.
     */
    virtual void add_terms(const FaceState<dim> &, FaceTerms<dim> &) const {}

    /**
     * Look at a boundary when the scene is set up. Throws UserError for what cannot be, and returns what is to be
     * warned of, empty if nothing. Collective.
     */
    virtual std::string check(const BoundaryScene<dim> &) const { return ""; }

    /** Does fluid pass through terms in the continuity equation? */
    bool has_mass_terms() const
    {
      return has_terms() && lets_fluid_pass() && !gives_pressure() && velocity() != Velocity::given;
    }

    std::string parameter; // that lists its boundaries, set by boundary_kind()
  };

  /** A new instance of the kind that is registered as @p parameter; throws UserError if there is none. */
  template <int dim>
  std::shared_ptr<BoundaryKind<dim>> boundary_kind(const std::string &parameter)
  {
    const auto &entries = Registry<BoundaryKind<dim>>::entries();
    const auto  it      = entries.find(parameter);
    check_user(it != entries.end(), "There is no kind of boundary condition named '" + parameter + "'.");
    std::shared_ptr<BoundaryKind<dim>> kind = it->second.create();
    kind->parameter                         = parameter;
    return kind;
  }
} // namespace alluvium::fluid

/** Register a kind of boundary condition: @p name is the parameter that lists its boundaries, @p prose explains it. */
#define ALLUVIUM_REGISTER_BOUNDARY_KIND(Class, name, prose)                                                            \
  ALLUVIUM_REGISTER(::alluvium::fluid::BoundaryKind<2>, Class, name, prose)
