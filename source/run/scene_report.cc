#include <alluvium/coupling/homogeneous_bed.h>
#include <alluvium/grains/packing.h>
#include <alluvium/run/model.h>
#include <alluvium/run/scene_report.h>

#include <deal.II/grid/tria.h>

#include <ostream>
#include <sstream>

namespace alluvium::run
{
  namespace
  {
    /** The grains as they would lie with gravity along -y. */
    grains::GrainArrays upright_grains(const Model &m)
    {
      grains::GrainArrays turned = m.grains;
      for (std::size_t i = 0; i < turned.n(); ++i)
        {
          const auto at = m.upright().to({{m.grains.x[i], m.grains.y[i]}});
          turned.x[i]   = at[0];
          turned.y[i]   = at[1];
        }
      return turned;
    }
  } // namespace


  void report_scene(const Model &m, const std::string &observers, std::ostream &out)
  {
    const auto line = [&](const std::string &what, const std::string &text) {
      out << "  " << what << std::string(what.size() < 12 ? 12 - what.size() : 1, ' ') << text << '\n';
    };
    const auto number = [](const double x) {
      std::ostringstream text;
      text << x;
      return text.str();
    };
    const double d = mesh::mean_diameter(m.grains);
    line("grains",
         std::to_string(m.grains.n()) + " discs, mean diameter " + number(d) + " m, fluid radius " +
           number(m.grains.fluid_radius[0] / m.grains.radius[0]) + " of the contact radius");
    if (!m.initial_bed.empty())
      {
        const double packing = grains::inner_packing_fraction(upright_grains(m));
        line("bed",
             number(m.initial_bed.bottom()) + " m to " + number(m.initial_bed.top()) + " m" +
               (packing > 0. ? ", packing fraction " + number(packing) + " inside" : ""));
      }
    if (m.has_fluid)
      {
        line("fluid",
             "volume-averaged Navier-Stokes, " + std::to_string(m.triangulation->n_global_active_cells()) + " cells, " +
               std::to_string(m.space.n_dofs()) + " unknowns" +
               (m.solver.discretisation.convection ? "" : "; without convection, as asked"));
        const double tau = m.solver.properties.viscosity > 0. ? d * d / m.solver.properties.viscosity : 0.;
        line("coupling",
             std::to_string(m.coupling.report().n_pieces) + " pieces of grains, void fraction " +
               number(m.coupling.report().eps_min) + " to " + number(m.coupling.report().eps_max) + ", rho d^2/eta " +
               number(tau * m.solver.properties.density) + " s");
        const coupling::HomogeneousBed bed{
          m.grains, m.solver.properties, coupling::inner_void_fraction(upright_grains(m))};
        const coupling::DragRange range = m.coupling.drag_law().range();
        line("drag law",
             m.coupling.drag_law_name() + " (void fraction " + number(range.eps_min) + " to " + number(range.eps_max) +
               ", Reynolds number to " + number(range.re_max) + ")" +
               (bed.eps < 1. ? "; homogeneous bed of void fraction " + number(bed.eps) + ": permeability " +
                                 number(bed.permeability(m.coupling.drag_law())) +
                                 " m^2, fluidised at a superficial velocity of " +
                                 number(bed.fluidisation_velocity(m.coupling.drag_law(), m.gravity_size())) + " m/s" +
                                 (range.contains(bed.eps, range.re_min) ? "" : "; it lies outside the law's range")
                             : ""));
      }
    else
      line("fluid", "left out (Fluid/Model = none): no mesh, no matrices");
    line("contacts",
         m.grains_move ? std::to_string(m.contacts.walls().size()) + " walls; " + m.contacts.sharing(m.grains.n())
                       : "left out: all grains are fixed");
    line("observers", observers);
    out << std::flush;
  }
} // namespace alluvium::run
