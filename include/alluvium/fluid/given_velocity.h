#pragma once

#include <alluvium/fluid/fluid_space.h>

namespace alluvium::fluid
{
  /**
   * What given velocities bring at the time of the boundary conditions: the flux through each part of a face,
   * integrated with the formula's jumps found, against the shape functions of the face's two nodes; and the velocities
   * of nodes. These are the formula's where it is resolved, else such that they carry the flux; a superficial velocity
   * is divided by the void fraction.
   */
  template <int dim>
  class GivenVelocity
  {
  public:
    /** Flux out of the domain against the shape function of each end of a face [m^2/s]. */
    using FaceFlux   = std::array<double, 2>;
    using NodeValues = typename BoundaryValues<dim>::GivenVelocities;

    /** Nothing that was found holds any longer: the space has been rebuilt. */
    void clear() { known = false; }

    /**
     * Find the values at the time of @p conditions. @p void_fraction is nodal and ghosted. Throws UserError if a
     * velocity is not finite. Not collective.
     */
    void update(const FluidSpace<dim> &space, const BoundaryConditions<dim> &conditions, const Vector &void_fraction);

    /** In the order of BoundaryValues::inflow_faces(). */
    const std::vector<FaceFlux> &face_fluxes() const { return fluxes; }
    const NodeValues            &node_values() const { return values; }

    /** Flux out of the domain through each boundary with a given velocity [m^2/s]. Collective. */
    std::map<dealii::types::boundary_id, double> boundary_fluxes(const FluidSpace<dim>         &space,
                                                                 const BoundaryConditions<dim> &conditions) const;

  private:
    /** Integrals of the velocity over a part of a face against phi_0^2, phi_0 phi_1 and phi_1^2 [m^2/s]. */
    using Moments = std::array<dealii::Tensor<1, dim>, 3>;

    void integrate(const FluidSpace<dim> &space, const BoundaryConditions<dim> &conditions);

    bool                  known = false;
    double                time  = 0.; // of what is known [s]
    std::vector<Moments>  moments;
    std::vector<FaceFlux> fluxes;
    NodeValues            of_formula, values; // before and after the division by the void fraction
  };
} // namespace alluvium::fluid
