// Waves over a sea bed: four plug-ins for Alluvium in one shared library.
//
//   a drag law            "kozeny"       the permeability of Kozeny and Carman, with a constant of one's own
//   a boundary condition  "linear wave"  the pressure on the bed under a wave of small amplitude
//   a kind of these       "Drains"       a floor through which water seeps as its pressure says
//   an observer           "exchange"     what water the wave pumps through the surface of the bed, and what that costs
//
// Each is a class that implements an interface, and a line that registers it. Nothing else knows of them: a scene names
// the library and chooses from it. See README.md.

#include <alluvium/coupling/coupling.h>
#include <alluvium/coupling/drag_law.h>
#include <alluvium/fluid/boundary_plugin.h>
#include <alluvium/fluid/face_state.h>
#include <alluvium/observers/observer.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace
{
  using namespace alluvium;
  using namespace dealii;

  // --- The drag law ---

  // What a grain feels is gamma (u - v) per volume of grain, u and v the velocities of fluid and grain. In a bed that
  // is not accelerated the drag on all grains balances the pressure gradient,
  //
  //   eps grad p = -(1 - eps) gamma u,
  //
  // which is Darcy's law eps u = -(K / eta) grad p with the permeability
  //
  //   K = eps^2 eta / ((1 - eps) gamma).
  //
  // Kozeny and Carman have K = eps^3 d^2 / (C (1 - eps)^2), C about 180 for spheres. Solved for gamma, that is the law.
  class Kozeny : public coupling::DragLaw
  {
  public:
    // The parameter appears in the scene's section "Drag law: kozeny", and in what --print-parameters prints, with this
    // explanation. The pattern says what is allowed: a scene with C = -3 is refused with file and line.
    void add_parameters(ParameterHandler &prm) override
    {
      prm.add_parameter("Constant", constant, "C in K = eps^3 d^2 / (C (1 - eps)^2) [-].", Patterns::Double(1.));
    }

    // Called for every piece of every grain, so no memory is allocated here and nothing is looked up. The law has to be
    // positive for eps = 1, too: a grain alone has some drag. The maximum leaves beds alone and keeps single grains
    // slower than free fall.
    double gamma(const coupling::DragState &s) const override
    {
      const double solid = std::max(1. - s.eps, 0.05);
      return constant * solid * s.viscosity / (s.eps * s.diameter * s.diameter);
    }

    // Where the law rests on data. Outside the program goes on, but says in its report that it extrapolates.
    coupling::DragRange range() const override
    {
      coupling::DragRange range;
      range.eps_min = 0.3;
      range.eps_max = 0.7;
      range.re_max  = 1.; // creeping flow: there is no term of inertia
      return range;
    }

  private:
    double constant = 180.;
  };

  ALLUVIUM_REGISTER_DRAG_LAW(Kozeny, "kozeny", "The permeability of Kozeny and Carman, for creeping flow in beds.")


  // --- The boundary condition ---

  // A wave of amplitude a and length lambda over water of depth h puts the pressure
  //
  //   p(x, t) = rho g a / cosh(k h) cos(k x - omega t),    k = 2 pi / lambda,
  //
  // on the bed (Airy), with the dispersion relation omega^2 = g k tanh(k h). A formula in the scene could say that,
  // too, in a long line with all numbers in it. Here they are parameters, and are checked.
  class LinearWave : public fluid::BoundaryPlugin
  {
  public:
    void add_parameters(ParameterHandler &prm) override
    {
      prm.add_parameter("Wave length", length, "lambda [m].", Patterns::Double(0.));
      prm.add_parameter("Amplitude", amplitude, "a, half the height of the wave [m].", Patterns::Double(0.));
      prm.add_parameter("Depth", depth, "h, of the water over the bed [m].", Patterns::Double(0.));
    }

    // Or velocity: then value() gives its two components.
    Gives gives() const override { return Gives::pressure; }

    // Density and gravity are the scene's: a plug-in that asked for them again would soon have others. A UserError ends
    // the program with one clear message, also under --check, because the scene is built there, too.
    void initialize(const std::map<std::string, double> &constants) override
    {
      const double rho = constants.at("rho"), g = constants.at("g");
      check_user(length > 0. && depth > 0.,
                 "The boundary condition 'linear wave' needs a 'Wave length' and a 'Depth' above 0.");
      check_user(amplitude < 0.1 * depth && amplitude < 0.05 * length,
                 "The boundary condition 'linear wave': 'Amplitude' is " + std::to_string(amplitude) +
                   " m; waves of small amplitude have less than a tenth of 'Depth' and a twentieth of 'Wave length'.");
      k        = 2. * numbers::PI / length;
      omega    = std::sqrt(g * k * std::tanh(k * depth));
      pressure = rho * g * amplitude / std::cosh(k * depth);
    }

    // Any place and any time may be asked for, more than once and in any order: a function, no state.
    double value(const Point<2> &x, const double time, const unsigned int) const override
    {
      return pressure * std::cos(k * x[0] - omega * time);
    }

  private:
    double length = 0., amplitude = 0., depth = 0.; // [m]
    double k = 0., omega = 0., pressure = 0.;       // [1/m], [1/s], [Pa]
  };

  ALLUVIUM_REGISTER_BOUNDARY_CONDITION(LinearWave, "linear wave", "The pressure on the bed under a wave (Airy).")


  // --- The kind of boundary condition ---

  // A wave is a pressure, one of the kinds that the program has. This kind it has not: a floor with pores, through
  // which
  //
  //   eps u.n = conductance (p - outside)
  //
  // passes. A kind says what it holds of velocity and pressure at the nodes (nothing, here), and adds the terms of its
  // faces to the weak form.
  class Drains : public fluid::BoundaryKind<2>
  {
  public:
    Velocity velocity() const override { return Velocity::free; }

    // Two expressions, `name: conductance | outside`. What --check calls it, and whether there is a column of the flux.
    unsigned int n_values() const override { return 2; }
    std::string  in_words() const override { return "drains"; }
    bool         lets_fluid_pass() const override { return true; }

    // The pressure outside fixes the level of the pressure inside: no other boundary has to.
    bool fixes_pressure() const override { return true; }

    // A wrong value is said with its boundary, its place and time.
    bool        allows(const unsigned int c, const double value) const override { return c > 0 || value >= 0.; }
    std::string expected() const override { return "a conductance of at least 0"; }

    // Integrated by parts, the continuity equation has the term integral q eps u.n: conductance p goes into the matrix,
    // conductance times the pressure outside is known. The unknown pressure leaves out the hydrostatic part.
    bool has_terms() const override { return true; }
    void add_terms(const fluid::FaceState<2> &state, fluid::FaceTerms<2> &terms) const override
    {
      constexpr unsigned int p = 2; // the unknowns of a node: two velocities, then the pressure
      for (unsigned int q = 0; q < state.n_q_points(); ++q)
        {
          const auto  &phi         = state.face.phi[q];
          const double conductance = state.face.jxw[q] * state.value(q, 0),
                       outside     = state.value(q, 1) - state.pressure_left_out(q);
          for (unsigned int i = 0; i < state.n_nodes(); ++i)
            {
              terms.known[terms.row(i, p)] += conductance * phi[i] * outside;
              for (unsigned int j = 0; j < state.n_nodes(); ++j)
                terms.matrix[terms.row(i, p)][terms.row(j, p)] += conductance * phi[i] * phi[j];
            }
        }
    }
  };

  ALLUVIUM_REGISTER_BOUNDARY_KIND(Drains,
                                  "Drains",
                                  "Floors with pores, as `name: conductance [m/(Pa s)] | outside [Pa]`.")


  // --- The observer ---

  // Under crests water is pressed into the bed, under troughs it comes out again. All in all nothing passes, so the
  // program's own column of the flux is zero; what one wants is half of what goes either way,
  //
  //   exchange = 1/2 integral |eps u.n| ds,        and the power        -integral p eps u.n ds
  //
  // that drag turns into heat. Both are integrals over the boundary, by deal.II's FEFaceValues.
  class Exchange : public observers::Observer
  {
  public:
    void add_parameters(ParameterHandler &prm) override
    {
      prm.add_parameter("Boundary", name, "Of the bed's surface.");
      prm.add_parameter("Mean from", mean_from, "Time from which means are taken [s].", Patterns::Double(0.));
    }

    // An observer that has nothing to see in a scene (here: in a dry one) is never asked again.
    bool applies(const observers::Snapshot &s) const override
    {
      if (s.fluid != nullptr)
        id_of_boundary(s); // which throws if there is none of this name: at the start, not after an hour
      return s.fluid != nullptr;
    }

    // Names end in the unit, as all columns do.
    void add_columns(const observers::Snapshot &, output::Statistics &statistics) override
    {
      statistics.add_column("exchange_m2_per_s");
      statistics.add_column("wave_power_W_per_m");
    }

    // After every step, on all ranks together: each integrates over the faces that it owns, then they add up.
    void observe(const observers::Snapshot &s) override
    {
      const auto     &space = s.fluid->space;
      const auto     &fe    = space.dof_handler().get_fe();
      const auto      id    = id_of_boundary(s);
      const QGauss<1> quadrature(3);

      // The void fraction is a field of its own, with one value a node, in a second dof handler of the same mesh.
      FEFaceValues<2> flow(space.mapping(), fe, quadrature, update_values | update_normal_vectors | update_JxW_values);
      FEFaceValues<2> nodal(space.mapping(), space.nodal_dof_handler().get_fe(), quadrature, update_values);

      // Velocity components come first, then the pressure. It is the reduced one, p - rho g.x less a constant. That is
      // all the same here: along a level surface without net flux, constants do no work.
      const FEValuesExtractors::Vector velocity(0);
      const FEValuesExtractors::Scalar pressure(2);
      std::vector<Tensor<1, 2>>        u(quadrature.size());
      std::vector<double>              p(quadrature.size()), eps(quadrature.size());

      double both_ways = 0.;
      power            = 0.;
      for (const auto &cell : space.dof_handler().active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int f : cell->face_indices())
            if (cell->face(f)->at_boundary() && cell->face(f)->boundary_id() == id)
              {
                flow.reinit(cell, f);
                nodal.reinit(space.nodal_cell(cell), f);
                flow[velocity].get_function_values(s.fluid->solver.solution(), u);
                flow[pressure].get_function_values(s.fluid->solver.solution(), p);
                nodal.get_function_values(s.fluid->coupling.void_fraction(), eps);
                for (unsigned int q = 0; q < quadrature.size(); ++q)
                  {
                    const double outwards = eps[q] * (u[q] * flow.normal_vector(q)) * flow.JxW(q);
                    both_ways += std::abs(outwards);
                    power -= p[q] * outwards;
                  }
              }
      exchange = 0.5 * Utilities::MPI::sum(both_ways, s.communicator);
      power    = Utilities::MPI::sum(power, s.communicator);

      // Steps may have different lengths, so means are weighted with them.
      if (s.time > mean_from)
        {
          time_of_means += s.dt;
          sum_exchange += exchange * s.dt;
          sum_power += power * s.dt;
        }
    }

    // After observe(), whenever a row of statistics.csv is due. At the start there is no flow yet.
    void write(const observers::Snapshot &s, output::Statistics &statistics) override
    {
      if (s.step == 0)
        return;
      statistics.set("exchange_m2_per_s", exchange);
      statistics.set("wave_power_W_per_m", power);
    }

    // What the user came for, in summary.json.
    void conclude(output::Summary &summary) const override
    {
      if (time_of_means == 0.)
        return;
      summary.set("exchange/mean_m2_per_s", sum_exchange / time_of_means);
      summary.set("exchange/mean_power_W_per_m", sum_power / time_of_means);
    }

    // A run that is interrupted and continued must come to the same means: whatever an observer remembers from step to
    // step goes into the checkpoint.
    void save(nlohmann::ordered_json &state) const override { state = {time_of_means, sum_exchange, sum_power}; }

    void load(const nlohmann::ordered_json &state) override
    {
      time_of_means = state.at(0);
      sum_exchange  = state.at(1);
      sum_power     = state.at(2);
    }

  private:
    types::boundary_id id_of_boundary(const observers::Snapshot &s) const
    {
      for (const auto &[id, condition] : s.fluid->boundary_conditions.all())
        if (condition.name == name)
          return id;
      throw UserError("The observer 'exchange': there is no boundary named '" + name + "'.");
    }

    std::string name      = "top";
    double      mean_from = 0.;                                        // [s]
    double      exchange = 0., power = 0.;                             // of the latest step [m^2/s], [W/m]
    double      time_of_means = 0., sum_exchange = 0., sum_power = 0.; // [s], [m^2], [J/m]
  };

  ALLUVIUM_REGISTER_OBSERVER(Exchange, "exchange", "Water that goes in and out through a boundary, and its power.")
} // namespace
