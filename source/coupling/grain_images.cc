#include <alluvium/coupling/grain_images.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace alluvium::coupling
{
  using namespace dealii;

  GrainImages::GrainImages(const std::vector<double>                &grain_x,
                           const std::vector<double>                &grain_y,
                           const double                              reach,
                           const fluid::PeriodicBox<2>              &box,
                           const std::array<std::vector<double>, 2> &mirrors)
    : x(grain_x)
    , y(grain_y)
    , grain(grain_x.size())
    , offset(grain_x.size())
  {
    std::iota(grain.begin(), grain.end(), 0u);
    for (unsigned int d = 0; d < 2; ++d)
      {
        const std::size_t n = x.size(); // images of images in the second direction: the corners
        for (std::size_t k = 0; k < n; ++k)
          {
            const double here = d == 0 ? x[k] : y[k];
            if (box.length[d] > 0.)
              {
                for (const double shift : {-box.length[d], box.length[d]})
                  if (here + shift > box.lower[d] - reach && here + shift < box.lower[d] + box.length[d] + reach)
                    add(k, d, here + shift, 0.);
              }
            else
              for (const double side : mirrors[d])
                if (std::abs(here - side) < reach)
                  add(k, d, 2. * side - here, 2. * (side - here));
          }
      }
  }


  void GrainImages::add(const std::size_t k, const unsigned int d, const double moved, const double off)
  {
    x.push_back(d == 0 ? moved : x[k]);
    y.push_back(d == 1 ? moved : y[k]);
    grain.push_back(grain[k]);
    offset.push_back(offset[k]);
    offset.back()[d] += off;
  }


  void GrainImages::add(const std::size_t k, const std::array<double, 2> &off)
  {
    x.push_back(x[k] + off[0]);
    y.push_back(y[k] + off[1]);
    grain.push_back(grain[k]);
    offset.push_back({{offset[k][0] + off[0], offset[k][1] + off[1]}});
  }


  std::array<std::vector<double>, 2> straight_sides(const fluid::FluidSpace<2> &space)
  {
    constexpr unsigned int                 dim = 2;
    std::array<std::vector<double>, dim>   sides;
    const MPI_Comm                         comm = space.communicator();
    std::array<std::array<double, 2>, dim> limits; // [direction][low, high]
    for (unsigned int d = 0; d < dim; ++d)
      {
        double low = std::numeric_limits<double>::max(), high = -low;
        for (const auto &cell : space.cells())
          for (unsigned int v = 0; v < space.n_nodes_per_cell(); ++v)
            {
              low  = std::min(low, cell.vertex[v][d]);
              high = std::max(high, cell.vertex[v][d]);
            }
        limits[d] = {{Utilities::MPI::min(low, comm), Utilities::MPI::max(high, comm)}};
      }
    // a side of the bounding box is a mirror if the boundary runs along all of it
    std::array<double, 2 * dim> covered{};
    for (const auto &cell : space.triangulation().active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        for (const auto f : cell->face_indices())
          if (cell->at_boundary(f))
            for (unsigned int d = 0; d < dim; ++d)
              for (unsigned int side = 0; side < 2; ++side)
                {
                  const double tolerance = 1e-10 * (limits[d][1] - limits[d][0]);
                  const auto   face      = cell->face(f);
                  if (std::abs(face->vertex(0)[d] - limits[d][side]) < tolerance &&
                      std::abs(face->vertex(1)[d] - limits[d][side]) < tolerance)
                    covered[2 * d + side] += face->measure();
                }
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double length = limits[1 - d][1] - limits[1 - d][0];
        for (unsigned int side = 0; side < 2; ++side)
          if (Utilities::MPI::sum(covered[2 * d + side], comm) > (1. - 1e-10) * length)
            sides[d].push_back(limits[d][side]);
      }
    return sides;
  }
} // namespace alluvium::coupling
