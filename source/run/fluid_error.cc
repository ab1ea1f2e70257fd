#include <alluvium/run/fluid_error.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace alluvium::run
{
  void FluidError::begin(const fluid::VansSolver<2> &solver, const double dt, const bool is_smooth)
  {
    is_known = is_smooth && dt > 0.;
    if (!is_known)
      return;
    dt_before = dt;
    change    = solver.solution().block(0);
    change.zero_out_ghost_values();
    change -= solver.old().block(0);
  }


  double FluidError::measure(const fluid::VansSolver<2> &solver, const double dt, const double small_speed)
  {
    const fluid::Vector &now = solver.solution().block(0), &before = solver.old().block(0);
    const fluid::Vector &volume = solver.linear_solver.scales.volumes.block(0);
    // u'' dt^2/2 = dt/(dt + dt_before) ((u^n+1 - u^n) - dt/dt_before (u^n - u^n-1))
    const double ratio = is_known ? dt / dt_before : 0., share = is_known ? dt / (dt + dt_before) : 0.;
    double       sums[3] = {0., 0., 0.};
    for (unsigned int i = 0; i < now.locally_owned_size(); ++i)
      {
        const double v = volume.local_element(i), u = now.local_element(i);
        sums[0] += v;
        sums[1] += v * u * u;
        if (is_known)
          {
            const double error = share * (u - before.local_element(i) - ratio * change.local_element(i));
            sums[2] += v * error * error;
          }
      }
    dealii::Utilities::MPI::sum(
      dealii::ArrayView<const double>(sums, 3), now.get_mpi_communicator(), dealii::ArrayView<double>(sums, 3));
    if (!(sums[0] > 0.))
      return 0.;
    speed              = std::sqrt(sums[1] / sums[0]);
    const double error = std::sqrt(sums[2] / sums[0]);
    if (!std::isfinite(speed))
      return speed; // not finite either
    constexpr double slow  = 0.01;
    const double     scale = std::max({speed, slow * largest, small_speed});
    return scale > 0. ? error / scale : 0.;
  }
} // namespace alluvium::run
