#include <alluvium/grains/bed_faces.h>
#include <alluvium/grains/bed_packing.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace alluvium::grains
{
  namespace
  {
    /** Grains @p order[begin, end). */
    grains::GrainArrays part(const grains::GrainArrays      &grains,
                             const std::vector<std::size_t> &order,
                             const std::size_t               begin,
                             const std::size_t               end)
    {
      grains::GrainArrays result;
      result.resize(end - begin);
      for (std::size_t k = begin; k < end; ++k)
        {
          const std::size_t i            = order[k];
          result.id[k - begin]           = grains.id[i];
          result.position[0][k - begin]  = grains.position[0][i];
          result.position[1][k - begin]  = grains.position[1][i];
          result.radius[k - begin]       = grains.radius[i];
          result.fluid_radius[k - begin] = grains.fluid_radius[i];
        }
      return result;
    }

    /**
     * How far a face of @p slope lies, in the mean over a column @p width wide, beyond where the rule of a quarter of a
     * layer finds it: that stops in the face's outermost wedge, of packing @p phi [m].
     */
    double beyond(const double slope, const double width, const double d, const double phi)
    {
      const double area = 0.25 * d * width / phi, depth = std::sqrt(2. * slope * area);
      return depth < slope * width ? depth - 0.5 * slope * width - area / width : 0.;
    }
  } // namespace


  BedPacking measure_bed(const grains::GrainArrays &grains,
                         const double               left,
                         const double               right,
                         const geometry::Upright   &upright)
  {
    if (!upright.is_default())
      return measure_bed(turned(grains, upright), left, right);
    BedPacking               result;
    double                   area   = 0.;
    bool                     is_cut = false; // is it other than its faces, from side to side?
    const BedFaces           faces  = find_bed_faces(grains, left, right);
    const double             d      = mean_diameter(grains);
    const auto              &c      = faces.columns;
    std::vector<std::size_t> order(grains.n());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(), [&](const auto i, const auto j) {
      return grains.position[0][i] < grains.position[0][j];
    });
    const auto before = [&](const double x) -> std::size_t {
      return std::lower_bound(
               order.begin(), order.end(), x, [&](const auto i, const double y) { return grains.position[0][i] < y; }) -
             order.begin();
    };
    for (std::size_t k = 0; k < c.size(); ++k)
      {
        const bool first           = k == 0 || c[k - 1].right < c[k].left - 0.5 * d,
                   last            = k + 1 == c.size() || c[k + 1].left > c[k].right + 0.5 * d;
        BedFaces::Column    column = c[k];
        const bool          ends   = column.right > right - 0.5 * d; // with the domain, the grains on its side included
        grains::GrainArrays inside = part(grains, order, before(column.left), ends ? grains.n() : before(column.right));
        if (first || last)
          {
            double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
            for (std::size_t i = 0; i < inside.n(); ++i)
              {
                low  = std::min(low, inside.position[0][i] - inside.radius[i]);
                high = std::max(high, inside.position[0][i] + inside.radius[i]);
              }
            const double from = first && low > column.left + d ? low : column.left,
                         to   = last && high < column.right - d ? high : column.right;
            if (to - from < column.right - column.left)
              {
                // a narrower column loses less of its height to the rule of a quarter of a layer
                const BedFaces narrow = find_bed_faces(inside, from, to);
                if (narrow.empty())
                  continue;
                is_cut = true;
                column = {from, to, narrow.bottom(), narrow.bottom() + narrow.mean_height()};
              }
          }
        // faces that slope, as those of heaps and hoppers
        const auto &low = c[first ? k : k - 1], &high = c[last ? k : k + 1];
        if (const double run = 0.5 * (high.left + high.right - low.left - low.right); run > 0.)
          for (const bool top : {false, true})
            {
              const auto   face  = top ? &BedFaces::Column::top : &BedFaces::Column::bottom;
              const double shift = beyond(std::abs(high.*face - low.*face) / run, column.right - column.left, d, 0.8);
              column.*face += top ? shift : -shift;
              is_cut = is_cut || shift != 0.;
            }
        if (!(column.top > column.bottom))
          continue;
        result.width += column.right - column.left;
        area += (column.right - column.left) * (column.top - column.bottom);
        for (std::size_t i = 0; i < inside.n(); ++i)
          {
            result.solid += disc_volume(inside.radius[i]);
            result.fluid_solid += disc_volume(inside.fluid_radius[i]);
          }
      }
    result.height = result.width > 0. ? area / result.width : 0.;
    if (!is_cut && std::abs(result.width - (right - left)) < 1e-9 * (right - left))
      {
        // with the bits of a sum over all grains in their order
        result = {right - left, faces.mean_height(), 0., 0.};
        for (std::size_t i = 0; i < grains.n(); ++i)
          {
            result.solid += disc_volume(grains.radius[i]);
            result.fluid_solid += disc_volume(grains.fluid_radius[i]);
          }
      }
    return result;
  }
} // namespace alluvium::grains
