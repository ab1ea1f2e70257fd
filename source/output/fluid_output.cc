#include <alluvium/output/fluid_output.h>

#include <deal.II/grid/reference_cell.h>
#include <deal.II/numerics/data_out.h>

namespace alluvium::output
{
  using namespace dealii;

  void write_fluid(FieldSeries                &series,
                   const fluid::FluidSpace<2> &space,
                   const fluid::BlockVector   &solution,
                   const fluid::Vector        &void_fraction,
                   const Tensor<1, 2>         &hydrostatic_gradient,
                   const double                datum,
                   const double                time)
  {
    // the total pressure needs the nodes' places
    fluid::Vector pressure = space.make_nodal_field();
    for (const auto &cell : space.cells())
      for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
        pressure.local_element(cell.node[v]) =
          solution.block(1).local_element(cell.pressure[v]) + hydrostatic_gradient * cell.vertex[v] + datum;
    pressure.update_ghost_values();

    DataOut<2> data;
    using Interpretation = DataComponentInterpretation::DataComponentInterpretation;
    data.add_data_vector(space.dof_handler(),
                         solution,
                         {"velocity", "velocity", "reduced_pressure"},
                         {Interpretation::component_is_part_of_vector,
                          Interpretation::component_is_part_of_vector,
                          Interpretation::component_is_scalar});
    data.add_data_vector(space.nodal_dof_handler(), pressure, "pressure");
    data.add_data_vector(space.nodal_dof_handler(), void_fraction, "void_fraction");
    data.build_patches(space.mapping());
    series.write<2>(
      data, space.n_nodes_per_cell() == 3 ? ReferenceCells::Triangle : ReferenceCells::Quadrilateral, time);
  }
} // namespace alluvium::output
