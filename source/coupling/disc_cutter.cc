#include <alluvium/coupling/disc_cutter.h>
#include <alluvium/coupling/grain_bins.h>
#include <alluvium/coupling/grain_images.h>
#include <alluvium/fluid/piece_shape.h>
#include <alluvium/geometry/smooth_disc_overlap.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

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


  double Discs::largest_radius() const
  {
    return *std::max_element(radius.begin(), radius.end());
  }


  void DiscCutter::reinit()
  {
    polygons.clear();
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
    non_tensor    = Utilities::MPI::max(static_cast<unsigned int>(grid.is_non_tensor()), space->communicator()) > 0;
  }


  void DiscCutter::cut(const Discs                     &now,
                       const Discs                     &before,
                       const std::vector<std::uint8_t> &moved,
                       const OverlapSettings           &settings,
                       PieceList                       &pieces)
  {
    pieces.keeps_arms      = settings.keep_arms;
    const auto   box       = space->periodic_box();
    const double largest   = now.largest_radius();
    const auto   images_of = [&](const Discs &discs) {
      return discs.n() == 0 ? GrainImages() : GrainImages(discs.position[0], discs.position[1], largest, box, mirrors);
    };
    GrainImages then = images_of(before), images = images_of(now);
    other_mirrors.add_images(then, largest);
    other_mirrors.add_images(images, largest); // the last, for sees()
    if (!grid.empty() && other_mirrors.empty() && settings.rule != OverlapSettings::Rule::particle_centre &&
        !settings.keep_arms)
      cut_on_grid(now, images, then, moved, settings, pieces);
    else
      cut_cells(now, images, then, moved, settings, pieces);
    pieces.terms.exchange.resize(pieces.n());
  }


  void DiscCutter::cut_cells(const Discs                     &discs,
                             const GrainImages               &now,
                             const GrainImages               &before,
                             const std::vector<std::uint8_t> &moved,
                             const OverlapSettings           &settings,
                             PieceList                       &pieces) const
  {
    const bool   all        = before.n() == 0;
    const double max_radius = discs.largest_radius();
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

    const PieceList old = pieces.take();
    pieces.terms.begin.assign(1, 0);
    pieces.reserve(old.n());
    const auto overlap_of_disc =
      settings.shape_of_discs() == OverlapSettings::Shape::parabolic ? geometry::smooth_overlap : geometry::overlap;
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
                geometry::Overlap      o      = settings.rule == OverlapSettings::Rule::particle_centre
                                                  ? cell_of_centre(centre, polygon)
                                                  : overlap_of_disc({centre, discs.radius[g]}, polygon);
                if (o.area > 0. && other_mirrors.sees(now, k, o.centroid))
                  {
                    for (unsigned int d = 0; d < dim; ++d)
                      o.arm[d] += now.offset[k][d];
                    add_piece(c, g, o, settings, pieces);
                  }
              }
          }
        else
          {
            const std::size_t at = pieces.n();
            pieces.resize(at + old.n(c));
            pieces.copy(old, c, at);
          }
        pieces.terms.begin.push_back(pieces.n());
      }
  }


  void DiscCutter::cut_on_grid(const Discs                     &discs,
                               const GrainImages               &now,
                               const GrainImages               &before,
                               const std::vector<std::uint8_t> &moved,
                               const OverlapSettings           &settings,
                               PieceList                       &pieces) const
  {
    // cells that grains left or entered, or moved in; empty: all
    std::vector<std::uint8_t> wanted(before.n() == 0 ? 0 : polygons.size(), 0);
    for (const GrainImages *images : {&before, &now})
      for (std::size_t k = 0; k < images->n() && !wanted.empty(); ++k)
        if (moved[images->grain[k]])
          {
            const double r = discs.radius[images->grain[k]], x = images->x[k], y = images->y[k];
            grid.for_each_cell({{x - r, y - r}}, {{x + r, y + r}}, [&](const unsigned int c) { wanted[c] = 1; });
          }

    geometry::GridCutter             cutter(grid, polygons, settings.shape_of_discs());
    std::vector<geometry::GridPiece> found; // in the order of the grains
    std::vector<unsigned int>        grain_found;
    found.reserve(1.1 * pieces.n());
    grain_found.reserve(1.1 * pieces.n());
    for (std::size_t k = 0; k < now.n(); ++k)
      {
        cutter.cut({{{now.x[k], now.y[k]}}, discs.radius[now.grain[k]]}, wanted, found);
        grain_found.resize(found.size(), now.grain[k]);
      }

    // in the order of the cells
    const PieceList old = wanted.empty() ? PieceList() : pieces.take();
    pieces.terms.begin.assign(polygons.size() + 1, 0);
    for (const auto &piece : found)
      ++pieces.terms.begin[piece.cell + 1];
    for (unsigned int c = 0; c < polygons.size(); ++c)
      pieces.terms.begin[c + 1] += pieces.terms.begin[c] + (wanted.empty() || wanted[c] ? 0 : old.n(c));
    pieces.resize(pieces.terms.begin.back());
    std::vector<unsigned int> next(pieces.terms.begin.begin(), pieces.terms.begin.end() - 1);
    for (std::size_t i = 0; i < found.size(); ++i)
      {
        const auto        &piece = found[i];
        const unsigned int k     = next[piece.cell]++;
        const double       xi = piece.xi, eta = piece.eta;
        const double       product = settings.rule == OverlapSettings::Rule::moments ? piece.product : xi * eta;
        auto              &s       = pieces.terms.shape[k];
        s.phi                      = {{1. - xi - eta + product, xi - product, eta - product, product}};
        pieces.grain[k]            = grain_found[i];
        pieces.raw_area[k]         = piece.area;
      }
    if (!wanted.empty())
      for (unsigned int c = 0; c < polygons.size(); ++c)
        if (!wanted[c])
          pieces.copy(old, c, pieces.terms.begin[c]);
  }


  void DiscCutter::add_piece(const unsigned int       cell,
                             const unsigned int       grain,
                             const geometry::Overlap &o,
                             const OverlapSettings   &settings,
                             PieceList               &pieces) const
  {
    const bool only_centroid = settings.rule == OverlapSettings::Rule::centroid;
    pieces.terms.shape.push_back(fluid::piece_shape(space->cells()[cell],
                                                    space->n_nodes_per_cell(),
                                                    o.area,
                                                    o.centroid,
                                                    only_centroid ? std::array<double, 3>{} : o.second_moments));
    pieces.grain.push_back(grain);
    pieces.raw_area.push_back(o.area);
    if (settings.keep_arms)
      pieces.arm.push_back(
        {o.arm, {{o.second_moments[0] / o.area, o.second_moments[1] / o.area, o.second_moments[2] / o.area}}});
  }
} // namespace alluvium::coupling
