#include <alluvium/coupling/grain_bins.h>
#include <alluvium/coupling/grain_images.h>
#include <alluvium/coupling/overlap_map.h>
#include <alluvium/coupling/solid_excess.h>
#include <alluvium/geometry/smooth_disc_overlap.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace alluvium::coupling
{
  using namespace dealii;

  namespace
  {
    /** The whole cell as the piece of a disc with its centre in it, on its edges too; else nothing. */
    geometry::Overlap cell_of_centre(const geometry::Point2 &centre, const geometry::PreparedPolygon &cell)
    {
      for (unsigned int i = 0; i < 4; ++i)
        if (cell.tangent_x[i] * (centre[1] - cell.y[i]) - cell.tangent_y[i] * (centre[0] - cell.x[i]) <
            -1e-12 * std::sqrt(cell.area))
          return {};
      const geometry::Point2 centroid = {{cell.x[0] + cell.centroid_offset[0], cell.y[0] + cell.centroid_offset[1]}};
      return {cell.area, centroid, cell.second_moments, {{centroid[0] - centre[0], centroid[1] - centre[1]}}};
    }
  } // namespace


  struct OverlapMap::PieceStore
  {
    std::vector<unsigned int>           begin;
    std::vector<fluid::PieceShape<dim>> shape;
    std::vector<unsigned int>           grain;
    std::vector<double>                 raw_area;
    std::vector<PieceArm>               arm;

    unsigned int n(const unsigned int cell) const { return begin[cell + 1] - begin[cell]; }
  };


  OverlapMap::OverlapMap(const fluid::FluidSpace<dim> &space)
    : space(&space)
  {}


  void OverlapMap::reinit()
  {
    polygons.clear();
    forget_positions();
    const unsigned int n = space->n_nodes_per_cell();
    for (const auto &cell : space->cells())
      {
        geometry::ConvexPolygon polygon;
        polygon.n = n;
        for (unsigned int v = 0; v < n; ++v)
          // deal.II's lexicographic quadrilateral, counter-clockwise
          polygon.vertex[n == 4 && v >= 2 ? 5 - v : v] = {{cell.vertex[v][0], cell.vertex[v][1]}};
        polygons.emplace_back(polygon);
      }
    grid          = geometry::RectangleGrid(polygons);
    mirrors       = straight_sides(*space);
    other_mirrors = BoundaryMirrors(*space);
    too_uneven    = Utilities::MPI::max(static_cast<unsigned int>(grid.too_uneven()), space->communicator()) > 0;
  }


  std::vector<std::uint8_t> OverlapMap::find_moved(const grains::GrainArrays &grains, const OverlapSettings &settings)
  {
    const std::size_t   n = grains.n();
    std::vector<double> radius(n);
    for (std::size_t g = 0; g < n; ++g)
      radius[g] = settings.filter_radius > 0. ? 2. * settings.filter_radius * grains.radius[g] : grains.fluid_radius[g];

    std::vector<std::uint8_t> moved(n, 1);
    if (position.x.size() == n && cut_with.rule == settings.rule &&
        cut_with.shape_of_discs() == settings.shape_of_discs() && cut_with.keep_arms == settings.keep_arms &&
        position.radius == radius && position.fluid_radius == grains.fluid_radius)
      for (std::size_t g = 0; g < n; ++g)
        moved[g] =
          std::max(std::abs(grains.position[0][g] - position.x[g]), std::abs(grains.position[1][g] - position.y[g])) >
          2. * settings.tolerance * grains.radius[g];
    else
      position = {grains.position[0], grains.position[1], radius, grains.fluid_radius};
    cut_with = settings;
    return moved;
  }


  bool OverlapMap::is_cut_where(const grains::GrainArrays &grains) const
  {
    if (position.x.size() != grains.n())
      return false;
    for (std::size_t g = 0; g < grains.n(); ++g)
      if (std::max(std::abs(grains.position[0][g] - position.x[g]), std::abs(grains.position[1][g] - position.y[g])) >
          2. * cut_with.tolerance * grains.radius[g])
        return false;
    return true;
  }


  bool OverlapMap::cut(const grains::GrainArrays &grains, const OverlapSettings &settings)
  {
    if (grains.n() == 0)
      {
        take_pieces();
        resize_pieces(0);
        pieces.exchange.clear();
        pieces.begin.assign(polygons.size() + 1, 0);
        position = {};
        cut_with = settings;
        return true; // on all ranks, whoever had pieces
      }
    const std::vector<std::uint8_t> moved = find_moved(grains, settings);
    if (std::none_of(moved.begin(), moved.end(), [](auto m) { return m; }))
      return false;

    const double    max_radius = *std::max_element(position.radius.begin(), position.radius.end());
    const bool      all        = std::all_of(moved.begin(), moved.end(), [](auto m) { return m; });
    const auto      box        = space->periodic_box();
    const Positions before     = all ? Positions() : position;
    for (std::size_t g = 0; g < grains.n(); ++g)
      if (moved[g])
        {
          position.x[g] = grains.position[0][g];
          position.y[g] = grains.position[1][g];
        }
    GrainImages then = all ? GrainImages() : GrainImages(before.x, before.y, max_radius, box, mirrors);
    GrainImages now(position.x, position.y, max_radius, box, mirrors);
    other_mirrors.add_images(then, max_radius);
    other_mirrors.add_images(now, max_radius); // the last, for sees()
    if (!grid.empty() && other_mirrors.empty() && settings.rule != OverlapSettings::Rule::centre && !settings.keep_arms)
      cut_on_grid(now, then, moved, settings);
    else
      cut_cells(now, then, moved, settings);
    pieces.exchange.resize(pieces.shape.size());

    std::vector<double> weight(grains.n(), 0.);
    for (std::size_t k = 0; k < raw_area.size(); ++k)
      weight[grain_of_piece[k]] += raw_area[k];
    sum_over_ranks(weight);
    for (std::size_t g = 0; g < grains.n(); ++g)
      {
        if (!(weight[g] > 0.)) // a message for every grain would cost more than cutting it
          throw UserError("Grain " + std::to_string(grains.id[g]) + " at (" + std::to_string(grains.position[0][g]) +
                          ", " + std::to_string(grains.position[1][g]) + ") m has left the fluid's domain.");
        weight[g] = grains::disc_volume(grains.fluid_radius[g]) / weight[g];
      }
    for (std::size_t k = 0; k < raw_area.size(); ++k)
      pieces.shape[k].area = raw_area[k] * weight[grain_of_piece[k]];
    return true;
  }


  void OverlapMap::cut_cells(const GrainImages               &now,
                             const GrainImages               &before,
                             const std::vector<std::uint8_t> &moved,
                             const OverlapSettings           &settings)
  {
    const bool   all        = before.n() == 0;
    const double max_radius = *std::max_element(position.radius.begin(), position.radius.end());
    GrainBins    bins(now.x, now.y, max_radius);
    if (!all)
      {
        const auto mark = [&](const GrainImages &images) {
          for (std::size_t k = 0; k < images.n(); ++k)
            if (moved[images.grain[k]])
              bins.mark(images.x[k], images.y[k]);
        };
        mark(before);
        mark(now);
      }

    const PieceStore old = take_pieces();
    pieces.begin.assign(1, 0);
    pieces.shape.reserve(old.shape.size());
    grain_of_piece.reserve(old.shape.size());
    raw_area.reserve(old.shape.size());
    const auto overlap_of_disc =
      settings.shape_of_discs() == OverlapSettings::Shape::smooth ? geometry::smooth_overlap : geometry::overlap;
    std::vector<unsigned int> candidates;
    for (unsigned int c = 0; c < polygons.size(); ++c)
      {
        const auto                 &polygon = polygons[c];
        const std::array<double, 2> low     = {{polygon.lower[0] - max_radius, polygon.lower[1] - max_radius}},
                                    high    = {{polygon.upper[0] + max_radius, polygon.upper[1] + max_radius}};
        if (all || bins.is_marked(low, high))
          {
            bins.find(low, high, candidates);
            for (const unsigned int k : candidates)
              {
                const unsigned int     g      = now.grain[k];
                const geometry::Point2 centre = {{now.x[k], now.y[k]}};
                geometry::Overlap      o      = settings.rule == OverlapSettings::Rule::centre
                                                  ? cell_of_centre(centre, polygon)
                                                  : overlap_of_disc({centre, position.radius[g]}, polygon);
                if (o.area > 0. && other_mirrors.sees(now, k, o.centroid))
                  {
                    for (unsigned int d = 0; d < dim; ++d)
                      o.arm[d] += now.offset[k][d];
                    add_piece(c, g, o, settings);
                  }
              }
          }
        else
          {
            const std::size_t at = pieces.shape.size();
            resize_pieces(at + old.n(c));
            put_back(old, c, at);
          }
        pieces.begin.push_back(pieces.shape.size());
      }
  }


  void OverlapMap::cut_on_grid(const GrainImages               &now,
                               const GrainImages               &before,
                               const std::vector<std::uint8_t> &moved,
                               const OverlapSettings           &settings)
  {
    // cells that grains left or entered, or moved in; empty: all
    std::vector<std::uint8_t> wanted(before.n() == 0 ? 0 : polygons.size(), 0);
    for (const GrainImages *images : {&before, &now})
      for (std::size_t k = 0; k < images->n() && !wanted.empty(); ++k)
        if (moved[images->grain[k]])
          {
            const double r = position.radius[images->grain[k]], x = images->x[k], y = images->y[k];
            grid.for_each_cell({{x - r, y - r}}, {{x + r, y + r}}, [&](const unsigned int c) { wanted[c] = 1; });
          }

    geometry::GridCutter             cutter(grid, polygons, settings.shape_of_discs());
    std::vector<geometry::GridPiece> found; // in the order of the grains
    std::vector<unsigned int>        grain_found;
    found.reserve(1.1 * pieces.shape.size());
    grain_found.reserve(1.1 * pieces.shape.size());
    for (std::size_t k = 0; k < now.n(); ++k)
      {
        cutter.cut({{{now.x[k], now.y[k]}}, position.radius[now.grain[k]]}, wanted, found);
        grain_found.resize(found.size(), now.grain[k]);
      }

    // in the order of the cells
    const PieceStore old = wanted.empty() ? PieceStore() : take_pieces();
    pieces.begin.assign(polygons.size() + 1, 0);
    for (const auto &piece : found)
      ++pieces.begin[piece.cell + 1];
    for (unsigned int c = 0; c < polygons.size(); ++c)
      pieces.begin[c + 1] += pieces.begin[c] + (wanted.empty() || wanted[c] ? 0 : old.n(c));
    resize_pieces(pieces.begin.back());
    std::vector<unsigned int> next(pieces.begin.begin(), pieces.begin.end() - 1);
    for (std::size_t i = 0; i < found.size(); ++i)
      {
        const auto        &piece = found[i];
        const unsigned int k     = next[piece.cell]++;
        const double       xi = piece.xi, eta = piece.eta;
        const double       product = settings.rule == OverlapSettings::Rule::moments ? piece.product : xi * eta;
        auto              &s       = pieces.shape[k];
        s.phi                      = {{1. - xi - eta + product, xi - product, eta - product, product}};
        grain_of_piece[k]          = grain_found[i];
        raw_area[k]                = piece.area;
      }
    if (!wanted.empty())
      for (unsigned int c = 0; c < polygons.size(); ++c)
        if (!wanted[c])
          put_back(old, c, pieces.begin[c]);
  }


  OverlapMap::PieceStore OverlapMap::take_pieces()
  {
    PieceStore old{std::move(pieces.begin),
                   std::move(pieces.shape),
                   std::move(grain_of_piece),
                   std::move(raw_area),
                   std::move(arm_of_piece)};
    pieces.begin.clear();
    resize_pieces(0);
    return old;
  }


  void OverlapMap::resize_pieces(const std::size_t n)
  {
    pieces.shape.resize(n);
    grain_of_piece.resize(n);
    raw_area.resize(n);
    arm_of_piece.resize(cut_with.keep_arms ? n : 0);
  }


  void OverlapMap::put_back(const PieceStore &old, const unsigned int cell, const std::size_t at)
  {
    const auto copy = [&](const auto &from, auto &to) {
      std::copy(from.begin() + old.begin[cell], from.begin() + old.begin[cell + 1], to.begin() + at);
    };
    copy(old.shape, pieces.shape);
    copy(old.grain, grain_of_piece);
    copy(old.raw_area, raw_area);
    if (cut_with.keep_arms)
      copy(old.arm, arm_of_piece);
  }


  void OverlapMap::add_piece(const unsigned int       cell,
                             const unsigned int       grain,
                             const geometry::Overlap &o,
                             const OverlapSettings   &settings)
  {
    const bool                  moments = settings.rule != OverlapSettings::Rule::centroid;
    const fluid::CellData<dim> &data    = space->cells()[cell];
    fluid::PieceShape<dim>      s{};
    s.area           = o.area;
    const auto &v    = data.vertex;
    const auto  edge = [&](const unsigned int a, const unsigned int b) {
      return std::array<double, 2>{{v[b][0] - v[a][0], v[b][1] - v[a][1]}};
    };
    const std::array<double, 2> x = {{o.centroid[0] - v[0][0], o.centroid[1] - v[0][1]}};
    if (space->n_nodes_per_cell() == 3)
      {
        const auto   e = edge(0, 1), f = edge(0, 2);
        const double det = e[0] * f[1] - e[1] * f[0];
        s.phi[1]         = (x[0] * f[1] - x[1] * f[0]) / det;
        s.phi[2]         = (e[0] * x[1] - e[1] * x[0]) / det;
        s.phi[0]         = 1. - s.phi[1] - s.phi[2];
      }
    else
      {
        // invert x = e xi + f eta + g xi eta; affine cells need one step
        const auto                  e = edge(0, 1), f = edge(0, 2);
        const std::array<double, 2> g  = {{v[3][0] - v[1][0] - f[0], v[3][1] - v[1][1] - f[1]}};
        double                      xi = 0.5, eta = 0.5, det = 0.;
        std::array<double, 2>       a, b; // columns of the Jacobian at (xi, eta)
        for (unsigned int step = 0; step < (data.parallelogram ? 1 : 20); ++step)
          {
            std::array<double, 2> r;
            for (unsigned int d = 0; d < 2; ++d)
              {
                const double bend = data.parallelogram ? 0. : g[d];
                a[d]              = e[d] + bend * eta;
                b[d]              = f[d] + bend * xi;
                r[d]              = x[d] - e[d] * xi - f[d] * eta - bend * xi * eta;
              }
            det               = a[0] * b[1] - a[1] * b[0];
            const double dxi  = (r[0] * b[1] - r[1] * b[0]) / det;
            const double deta = (a[0] * r[1] - a[1] * r[0]) / det;
            xi += dxi;
            eta += deta;
            if (std::abs(dxi) + std::abs(deta) < 1e-14)
              break;
          }
        const double second  = moments ? ((b[1] * o.second_moments[0] - b[0] * o.second_moments[1]) * -a[1] +
                                         (b[1] * o.second_moments[1] - b[0] * o.second_moments[2]) * a[0]) /
                                          (det * det * o.area)
                                       : 0.; // mean of (xi - xi_c)(eta - eta_c)
        const double product = xi * eta + second;
        s.phi                = {{1. - xi - eta + product, xi - product, eta - product, product}};
      }
    pieces.shape.push_back(s);
    grain_of_piece.push_back(grain);
    raw_area.push_back(o.area);
    if (settings.keep_arms)
      arm_of_piece.push_back(
        {o.arm, {{o.second_moments[0] / o.area, o.second_moments[1] / o.area, o.second_moments[2] / o.area}}});
  }


  double OverlapMap::void_fraction(fluid::Vector &eps) const
  {
    const unsigned int n       = space->n_nodes_per_cell();
    const auto        &volumes = space->node_volumes();
    fluid::Vector      solid   = space->make_nodal_field();

    // with ghosts: row indices of the constraints are global, those of the cells local
    std::vector<types::global_dof_index> nodes(n);
    dealii::Vector<double>               local(n);
    const auto                          &partitioner = *solid.get_partitioner();
    for (unsigned int c = 0; c < space->cells().size(); ++c)
      {
        if (pieces.begin[c] == pieces.begin[c + 1])
          continue;
        local = 0.;
        for (unsigned int k = pieces.begin[c]; k < pieces.begin[c + 1]; ++k)
          for (unsigned int v = 0; v < n; ++v)
            local(v) += pieces.shape[k].area * pieces.shape[k].phi[v];
        for (unsigned int v = 0; v < n; ++v)
          nodes[v] = partitioner.local_to_global(space->cells()[c].node[v]);
        space->nodal_constraints().distribute_local_to_global(local, nodes, solid);
      }
    solid.compress(VectorOperation::add);

    const double moved = spread_excess(*space, solid);

    eps.zero_out_ghost_values();
    for (unsigned int i = 0; i < eps.locally_owned_size(); ++i)
      eps.local_element(i) =
        volumes.local_element(i) > 0. ? std::max(0., 1. - solid.local_element(i) / volumes.local_element(i)) : 1.;
    space->interpolate_hanging_nodes(eps);
    return moved;
  }


  void OverlapMap::sum_over_ranks(std::vector<double> &per_grain) const
  {
    const MPI_Comm comm = space->communicator();
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return;
    // reduced on one rank and sent to all: replicated contact solves must start from the same bits
    std::vector<double> sum(per_grain.size());
    MPI_Reduce(per_grain.data(), sum.data(), per_grain.size(), MPI_DOUBLE, MPI_SUM, 0, comm);
    MPI_Bcast(sum.data(), sum.size(), MPI_DOUBLE, 0, comm);
    per_grain.swap(sum);
  }
} // namespace alluvium::coupling
