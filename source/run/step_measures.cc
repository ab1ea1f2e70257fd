#include <alluvium/fluid/cell_order.h>
#include <alluvium/run/model.h>
#include <alluvium/run/step_measures.h>

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_accessor.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alluvium::run
{
  using namespace dealii;

  namespace
  {
    struct FluidSums
    {
      double kinetic = 0., solid = 0., velocity_square = 0., courant = 0.;
      double driven = 0.; // power of forces on the fluid [W/m]
      bool   finite = true;
    };

    /** Of this rank's cells. */
    FluidSums sum_fluid(const Model &m)
    {
      FluidSums          sums;
      const auto        &u = m.solver.solution().block(0), &p = m.solver.solution().block(1);
      const auto        &eps   = m.coupling.void_fraction();
      const unsigned int n     = m.space.n_nodes_per_cell();
      const auto        &drive = m.solver.problem().drive;
      double             any   = 0.; // not finite if one of the values is not
      for (const auto &cell : m.space.cells())
        {
          double fastest = 0., kinetic = 0., driven = 0.;
          for (unsigned int v = 0; v < n; ++v)
            {
              const double ux = u.local_element(cell.velocity[v][0]), uy = u.local_element(cell.velocity[v][1]),
                           e = eps.local_element(cell.node[v]), square = ux * ux + uy * uy;
              fastest = std::max(fastest, square);
              kinetic += e * square;
              driven += e * (ux * drive[0] + uy * drive[1]);
              any += 0. * (square + e + p.local_element(cell.pressure[v]));
            }
          sums.kinetic += cell.measure / n * kinetic;
          sums.driven += cell.measure / n * driven;
          sums.velocity_square = std::max(sums.velocity_square, fastest);
          sums.courant         = std::max(sums.courant, fastest / (cell.size * cell.size));
        }
      sums.kinetic *=
        m.solver.discretisation.inertia ? 0.5 * m.solver.properties.density : 0.; // without, there is none
      sums.finite         = any == 0.;
      const auto &volumes = m.space.node_volumes();
      for (unsigned int i = 0; i < eps.locally_owned_size(); ++i)
        sums.solid += volumes.local_element(i) * (1. - eps.local_element(i));
      return sums;
    }

    double grains_kinetic_energy(const grains::GrainArrays &g, double &fastest)
    {
      double energy = 0., square = 0.;
      for (std::size_t i = 0; i < g.n(); ++i)
        {
          const double v2 = g.velocity[0][i] * g.velocity[0][i] + g.velocity[1][i] * g.velocity[1][i];
          square          = std::max(square, v2);
          if (!std::isinf(g.mass[i]))
            energy += 0.5 * (g.mass[i] * v2 + grains::disc_inertia(g.mass[i], g.radius[i]) * g.omega[i] * g.omega[i]);
        }
      fastest = std::sqrt(square);
      return energy;
    }
  } // namespace


  void StepMeter::find_faces(const Model &m)
  {
    faces.clear();
    faces_known                   = true;
    const auto        &periodic   = m.space.periodic_box().length;
    const auto        &conditions = m.boundary_conditions.all();
    const unsigned int n          = m.space.n_nodes_per_cell();
    unsigned int       index      = 0;
    for (const auto &cell : fluid::ordered_cells(m.space.dof_handler()))
      {
        if (!cell->is_locally_owned())
          continue;
        const unsigned int c = index++;
        if (!cell->at_boundary())
          continue;
        for (const unsigned int f : cell->face_indices())
          {
            if (!cell->face(f)->at_boundary())
              continue;
            const auto id = cell->face(f)->boundary_id();
            if (periodic[id / 2 % Model::dim] > 0.)
              continue;
            const Point<Model::dim> a = cell->face(f)->vertex(0), b = cell->face(f)->vertex(1);
            bool                    pressure = false, velocity = false;
            for (const auto &part : m.space.boundary().divide_face(id, a, b))
              {
                const auto &kind     = *conditions.at(part.id).kind;
                const bool  is_given = kind.velocity() == fluid::BoundaryKind<Model::dim>::Velocity::given;
                pressure             = pressure || (kind.lets_fluid_pass() && !is_given);
                velocity             = velocity || is_given;
              }
            if (!pressure && !velocity)
              continue;
            Face face{c, {}, {}, pressure};
            for (unsigned int e = 0; e < 2; ++e)
              for (unsigned int v = 0; v < n; ++v)
                if (cell->face(f)->vertex_index(e) == cell->vertex_index(v))
                  face.node[e] = v;
            face.normal        = {{b[1] - a[1], a[0] - b[0]}};
            const auto outward = cell->face(f)->center() - cell->center();
            if (face.normal[0] * outward[0] + face.normal[1] * outward[1] < 0.)
              face.normal = {{-face.normal[0], -face.normal[1]}};
            faces.push_back(face);
          }
      }
  }


  /**
   * Power of a boundary that moves along itself, such as a lid, at most [W/m]: the speed of the face times the viscous
   * force on the cell, and the force that gave the cell the momentum it gained in the step. Where viscosity reaches
   * less than a cell in a step, the second is much larger.
   */
  double StepMeter::largest_shear_power(const Model &m, const Face &face) const
  {
    const auto &now = m.solver.solution().block(0), &before = m.solver.old().block(0);
    const auto &cell   = m.space.cells()[face.cell];
    double      speeds = 0., gains = 0., of_face = 0.;
    for (unsigned int v = 0; v < m.space.n_nodes_per_cell(); ++v)
      {
        const auto  &dof = cell.velocity[v];
        const double ux = now.local_element(dof[0]), uy = now.local_element(dof[1]);
        speeds = std::max(speeds, std::hypot(ux, uy));
        gains  = std::max(gains, std::hypot(ux - before.local_element(dof[0]), uy - before.local_element(dof[1])));
        if (v == face.node[0] || v == face.node[1])
          of_face = std::max(of_face, std::hypot(ux, uy));
      }
    const double viscous = 2. * m.solver.properties.viscosity * speeds / cell.size,
                 inertia = 0.5 * m.solver.properties.density * cell.size * gains / m.time_step;
    return of_face * (viscous + inertia) * std::hypot(face.normal[0], face.normal[1]);
  }


  /** Power of pressures and inflows on this rank's open boundaries, at most; pressures against the lowest given. */
  double StepMeter::boundary_work(const Model &m) const
  {
    const auto  &u = m.solver.solution().block(0), &p = m.solver.solution().block(1);
    const double rho      = m.solver.properties.density;
    double       range[2] = {std::numeric_limits<double>::lowest(), std::numeric_limits<double>::lowest()};
    const auto   pressure = [&](const Face &face, const unsigned int e) {
      return p.local_element(m.space.cells()[face.cell].pressure[face.node[e]]);
    };
    for (const Face &face : faces)
      if (face.given_pressure)
        for (unsigned int e = 0; e < 2; ++e)
          {
            range[0] = std::max(range[0], pressure(face, e));
            range[1] = std::max(range[1], -pressure(face, e));
          }
    MPI_Allreduce(MPI_IN_PLACE, range, 2, MPI_DOUBLE, MPI_MAX, m.communicator);
    const bool   any_given = range[0] > std::numeric_limits<double>::lowest();
    const double lowest = any_given ? -range[1] : 0., difference = any_given ? range[0] + range[1] : 0.;

    double power = 0.;
    for (const Face &face : faces)
      {
        const auto           &cell = m.space.cells()[face.cell];
        std::array<double, 2> normal_flux, pressures, squares;
        for (unsigned int e = 0; e < 2; ++e)
          {
            const auto  &dof = cell.velocity[face.node[e]];
            const double ux = u.local_element(dof[0]), uy = u.local_element(dof[1]);
            normal_flux[e] = ux * face.normal[0] + uy * face.normal[1];
            squares[e]     = ux * ux + uy * uy;
            pressures[e]   = pressure(face, e) - lowest;
          }
        // Simpson's rule is exact for products of linear functions
        for (unsigned int q = 0; q < 3; ++q)
          {
            const double s = 0.5 * q, weight = q == 1 ? 2. / 3. : 1. / 6.;
            const double flux    = (1. - s) * normal_flux[0] + s * normal_flux[1],
                         square  = (1. - s) * squares[0] + s * squares[1];
            const double dynamic = 0.5 * rho * square;
            power -= weight * flux * ((1. - s) * pressures[0] + s * pressures[1]);
            if (flux < 0.)
              power -= weight * flux * (face.given_pressure ? std::min(dynamic, difference) : dynamic);
          }
        if (!face.given_pressure)
          power += largest_shear_power(m, face);
      }
    // what is given is a flux, also where walls hold the nodes' velocity
    const auto *given = m.solver.problem().given_fluxes;
    for (std::size_t i = 0; given && i < given->size(); ++i)
      {
        const auto &face = m.space.boundary().inflow_faces()[i];
        if (!face.owned)
          continue;
        const double width = face.length() * (face.to - face.from), in = -(*given)[i][0] - (*given)[i][1];
        power += std::max(0., in) * 0.5 * rho * in * in / (width * width);
        for (unsigned int e = 0; e < 2; ++e)
          power +=
            std::abs((*given)[i][e] * (p.local_element(m.space.cells()[face.cell].pressure[face.vertex[e]]) - lowest));
      }
    return power;
  }


  /** Of gravity on what sinks, of walls, and of grains that move as prescribed [J/m]. */
  double StepMeter::work_on_grains(const Model &m) const
  {
    const auto  &g           = m.grains;
    const double rho         = m.has_fluid ? m.solver.properties.density : 0.;
    const auto   periodicity = m.domain.periodicity();
    const auto   excess      = m.has_fluid ? m.solver.unsupported_weight() : Tensor<1, Model::dim>();
    double       work = 0., prescribed = 0.;
    for (std::size_t i = 0; i < g.n(); ++i)
      {
        if (std::isinf(g.mass[i]))
          {
            const double speed = std::hypot(g.velocity[0][i], g.velocity[1][i]);
            prescribed += speed * std::hypot(g.contact_force[0][i], g.contact_force[1][i]);
            if (m.has_fluid && speed > 0. && i < m.coupling.fluid_force().size())
              prescribed += speed * std::hypot(m.coupling.fluid_force()[i][0], m.coupling.fluid_force()[i][1]);
            continue;
          }
        // through a periodic domain a grain may go farther than half of it in a step: how far, its velocity tells
        const double way_x = m.time_step * g.velocity[0][i], way_y = m.time_step * g.velocity[1][i];
        double       dx = g.position[0][i] - x[i] - way_x, dy = g.position[1][i] - y[i] - way_y;
        periodicity.shorten(dx, dy);
        dx += way_x;
        dy += way_y;
        const double volume = grains::disc_volume(g.fluid_radius[i]), reduced = g.mass[i] - rho * volume;
        work += reduced * (m.gravity[0] * dx + m.gravity[1] * dy) + volume * (excess[0] * dx + excess[1] * dy);
      }
    work += m.time_step * prescribed;
    if (m.grains_move)
      work += m.contact_report.wall_work;
    return work;
  }


  void StepMeter::begin(const Model &m)
  {
    StepEnergy now;
    double     fastest = 0.;
    if (m.has_fluid)
      now.kinetic = Utilities::MPI::sum(sum_fluid(m).kinetic, m.communicator);
    now.kinetic += grains_kinetic_energy(m.grains, fastest);
    now.springs = m.grains_move ? m.contacts.spring_energy(m.grains) : 0.;
    remember(m, now);
  }


  void StepMeter::remember(const Model &m, const StepEnergy &now)
  {
    energy = now.kinetic + now.springs;
    x      = m.grains.position[0];
    y      = m.grains.position[1];
  }


  StepMeasures StepMeter::measure(const Model &m)
  {
    StepMeasures result;
    double       fluid_energy = 0.;
    if (m.has_fluid)
      {
        if (!faces_known)
          find_faces(m);
        const FluidSums mine    = sum_fluid(m);
        double          sums[3] = {mine.kinetic, mine.solid, boundary_work(m) + mine.driven};
        double          largest[3]{mine.velocity_square, mine.courant, mine.finite ? 0. : 1.};
        MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_DOUBLE, MPI_SUM, m.communicator);
        MPI_Allreduce(MPI_IN_PLACE, largest, 3, MPI_DOUBLE, MPI_MAX, m.communicator);
        fluid_energy          = sums[0];
        result.finite         = largest[2] == 0.;
        result.fluid_velocity = std::sqrt(largest[0]);
        result.courant        = std::sqrt(largest[1]) * m.time_step;
        result.n_iterations   = m.coupling.report().n_iterations;
        double solid          = 0.;
        for (const double r : m.grains.fluid_radius)
          solid += grains::disc_volume(r);
        result.solid_lost     = solid > 0. ? 1. - sums[1] / solid : 0.;
        result.energy.sources = m.time_step * sums[2];
      }
    result.energy.kinetic = fluid_energy + grains_kinetic_energy(m.grains, result.grain_velocity);
    result.energy.springs = m.grains_move ? m.contact_report.spring_energy : 0.;
    result.energy.change  = result.energy.kinetic + result.energy.springs - energy;
    result.energy.sources += work_on_grains(m);
    result.energy.remainder = result.energy.change - result.energy.sources;
    remember(m, result.energy);
    return result;
  }
} // namespace alluvium::run
