#include <alluvium/fluid/cell_state.h>

namespace alluvium::fluid
{
  template <int dim, int n>
  void CellState<dim, n>::reinit_void_fraction(const unsigned int index)
  {
    cell = &space.cells()[index];
    for (unsigned int v = 0; v < n; ++v)
      eps[v] = problem.void_fraction->local_element(cell->node[v]);
  }


  template <int dim, int n>
  void CellState<dim, n>::reinit(const unsigned int index)
  {
    reinit_void_fraction(index);
    begin           = problem.solid->begin.empty() ? 0 : problem.solid->begin[index];
    end             = problem.solid->begin.empty() ? 0 : problem.solid->begin[index + 1];
    double eps_mean = 0., u_norm = 0.;
    u_mean = {};
    for (unsigned int v = 0; v < n; ++v)
      {
        eps_mean += eps[v] / n;
        for (unsigned int d = 0; d < dim; ++d)
          {
            u_old[v][d] = problem.old->block(0).local_element(cell->velocity[v][d]);
            u_start[v][d] =
              (problem.inertia ? problem.inertia : problem.old)->block(0).local_element(cell->velocity[v][d]);
            u_mean[d] += u_old[v][d] / n;
          }
      }
    for (unsigned int d = 0; d < dim; ++d)
      u_norm += u_mean[d] * u_mean[d];
    u_norm       = problem.discretisation.convection ? std::sqrt(u_norm) : 0.;
    double sigma = 0.;
    for (unsigned int k = begin; k < end; ++k)
      sigma += problem.solid->shape[k].area * problem.solid->exchange[k].gamma;
    sigma /= cell->measure;
    const double rho_eps = problem.fluid.density * eps_mean, h = cell->size;
    const double dt =
      problem.stabilisation_dt > 0. && problem.discretisation.inertia ? problem.stabilisation_dt : problem.inertia_dt();
    const double inertia = 2. * rho_eps / dt, advection = 2. * rho_eps * u_norm / h,
                 diffusion = 12. * eps_mean * problem.stress_viscosity() / (h * h), drag = 2. * sigma;
    const double tau =
      1. / std::sqrt(inertia * inertia + advection * advection + diffusion * diffusion + drag * drag + 1e-300);
    pspg = tau * eps_mean;
    supg = problem.discretisation.convection ? tau * rho_eps : 0.;
  }


  template <int dim, int n>
  LocalVector<dim, n> CellState<dim, n>::values(const BlockVector &x) const
  {
    LocalVector<dim, n> result;
    for (unsigned int v = 0; v < n; ++v)
      {
        for (unsigned int d = 0; d < dim; ++d)
          result[v * (dim + 1) + d] = x.block(0).local_element(cell->velocity[v][d]);
        result[v * (dim + 1) + dim] = x.block(1).local_element(cell->pressure[v]);
      }
    return result;
  }


  template struct CellState<2, 3>;
  template struct CellState<2, 4>;
} // namespace alluvium::fluid
