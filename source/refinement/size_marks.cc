#include <alluvium/refinement/size_marks.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>

namespace alluvium::refinement
{
  using namespace dealii;

  mesh::Box box_around(const fluid::CellData<2> &cell, const unsigned int n_nodes)
  {
    mesh::Box box{{{cell.vertex[0][0], cell.vertex[0][1]}}, {{cell.vertex[0][0], cell.vertex[0][1]}}};
    for (unsigned int v = 1; v < n_nodes; ++v)
      for (unsigned int d = 0; d < 2; ++d)
        {
          box.lower[d] = std::min(box.lower[d], cell.vertex[v][d]);
          box.upper[d] = std::max(box.upper[d], cell.vertex[v][d]);
        }
    return box;
  }


  void SizeMarks::add_parameters(ParameterHandler &prm, const double default_half_width)
  {
    half_width = default_half_width;
    prm.add_parameter("Half width",
                      half_width,
                      "How far around the marked places the cells are as small, in mean grain diameters.",
                      Patterns::Double(0., 1e3));
    prm.add_parameter(
      "Growth", growth, "By how much the size grows per length farther away, [-].", Patterns::Double(0.05));
  }


  void SizeMarks::clear(const RefinementContext &context)
  {
    diameter = context.grain_diameter;
    for (SizeRaster &r : raster)
      r.reinit(context.domain, context.periodic, diameter > 0. ? diameter / 2. : 0.);
  }


  void SizeMarks::add(const mesh::Box &box, const double size)
  {
    stamp(box, size, Purpose::refine);
    stamp(box, RefinementCriterion::hysteresis * size, Purpose::coarsen);
  }


  void SizeMarks::add_if_above(const double value, const double threshold, const mesh::Box &box, const double size)
  {
    if (value > threshold)
      stamp(box, size, Purpose::refine);
    if (value > RefinementCriterion::hysteresis * threshold)
      stamp(box, size, Purpose::coarsen);
  }


  void SizeMarks::stamp(const mesh::Box &box, const double size, const Purpose purpose)
  {
    raster[purpose == Purpose::refine ? 0 : 1].stamp(widened(box, half_width * diameter), size);
  }


  void SizeMarks::finish(const MPI_Comm communicator)
  {
    for (SizeRaster &r : raster)
      r.spread(communicator, growth);
  }
} // namespace alluvium::refinement
