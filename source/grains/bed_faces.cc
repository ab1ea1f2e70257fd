#include <alluvium/grains/bed_faces.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace alluvium::grains
{
  namespace
  {
    /** Distance between the intervals [a, b] and [c, d]. */
    double gap(const double a, const double b, const double c, const double d)
    {
      return std::max({0., c - b, a - d});
    }

    /** Distance of a box to the nearest column's @p face. */
    double distance(const std::vector<BedFaces::Column> &columns,
                    double BedFaces::Column::*const face,
                    const std::array<double, 2>    &lower,
                    const std::array<double, 2>    &upper)
    {
      double square = std::numeric_limits<double>::infinity();
      for (const auto &c : columns)
        {
          const double dx = gap(lower[0], upper[0], c.left, c.right), dy = gap(lower[1], upper[1], c.*face, c.*face);
          square = std::min(square, dx * dx + dy * dy);
        }
      return std::sqrt(square);
    }

    /** The first level at which there is @p area within @p reach before it, going through (level, area) pairs in order;
     * false if there is none. */
    bool level_with(const std::vector<std::pair<double, double>> &levels,
                    const double                                  area,
                    const double                                  reach,
                    double                                       &level)
    {
      double sum   = 0.;
      auto   first = levels.begin();
      for (const auto &[y, a] : levels)
        {
          sum += a;
          for (; first->first < y - reach; ++first)
            sum -= first->second;
          if (sum >= area * (1. - 1e-9)) // equal grains may have just as much
            {
              level = y;
              return true;
            }
        }
      return false;
    }
  } // namespace


  double BedFaces::bottom() const
  {
    double result = std::numeric_limits<double>::max();
    for (const Column &column : columns)
      result = std::min(result, column.bottom);
    return result;
  }


  double BedFaces::mean_height() const
  {
    double sum = 0.;
    for (const Column &column : columns)
      sum += column.top - column.bottom;
    return columns.empty() ? 0. : sum / columns.size();
  }


  double BedFaces::top() const
  {
    double result = std::numeric_limits<double>::lowest();
    for (const Column &column : columns)
      result = std::max(result, column.top);
    return result;
  }


  double BedFaces::distance_to_top(const std::array<double, 2> &lower, const std::array<double, 2> &upper) const
  {
    std::array<double, 2> low = lower, high = upper;
    upright.turn(low, high);
    return distance(columns, &Column::top, low, high);
  }


  double BedFaces::distance_to_bottom(const std::array<double, 2> &lower, const std::array<double, 2> &upper) const
  {
    std::array<double, 2> low = lower, high = upper;
    upright.turn(low, high);
    return distance(columns, &Column::bottom, low, high);
  }


  double mean_diameter(const grains::GrainArrays &grains)
  {
    double sum = 0.;
    for (const double r : grains.radius)
      sum += 2. * r;
    return grains.n() == 0 ? 0. : sum / grains.n();
  }


  grains::GrainArrays turned(const grains::GrainArrays &grains, const geometry::Upright &upright)
  {
    grains::GrainArrays result = grains;
    for (std::size_t i = 0; i < grains.n(); ++i)
      {
        const auto at         = upright.to({{grains.position[0][i], grains.position[1][i]}});
        result.position[0][i] = at[0];
        result.position[1][i] = at[1];
      }
    return result;
  }


  BedFaces find_bed_faces(const grains::GrainArrays &grains,
                          const double               left,
                          const double               right,
                          const geometry::Upright   &upright)
  {
    if (!upright.is_default())
      {
        BedFaces result = find_bed_faces(turned(grains, upright), left, right);
        result.upright  = upright;
        return result;
      }
    BedFaces     result;
    const double d = mean_diameter(grains);
    if (grains.n() == 0 || right <= left)
      return result;

    // A box may be many columns wide and hold few grains: only columns that have some cost anything.
    // Round-off shall not decide on halves.
    const double n_columns = std::max(1., std::round((right - left) / (8. * d) + 1e-9));
    const double width     = (right - left) / n_columns;
    struct Levels
    {
      std::vector<std::pair<double, double>> bottoms, tops;
    };
    std::map<double, Levels> columns; // by number
    for (std::size_t i = 0; i < grains.n(); ++i)
      {
        // one between two columns belongs to both, or round-off would choose
        constexpr double round_off = 1e-9;
        const double     position  = (grains.position[0][i] - left) / width;
        const auto       number_at = [&](const double p) { return std::floor(std::clamp(p, 0., n_columns - 1.)); };
        const double     first = number_at(position - round_off), last = number_at(position + round_off);
        const double     r = grains.radius[i], area = disc_volume(r) / (last - first + 1.);
        for (double c = first; c <= last; ++c)
          {
            columns[c].bottoms.emplace_back(grains.position[1][i] - r, area);
            columns[c].tops.emplace_back(-grains.position[1][i] - r, area); // negative: from the top down
          }
      }
    const double quarter_layer = 0.25 * d * width, reach = 3. * d; // a slope of 60 degrees has it within that
    for (auto &[c, levels] : columns)
      {
        std::sort(levels.bottoms.begin(), levels.bottoms.end());
        std::sort(levels.tops.begin(), levels.tops.end());
        double bottom, top;
        if (level_with(levels.bottoms, quarter_layer, reach, bottom) &&
            level_with(levels.tops, quarter_layer, reach, top))
          result.columns.push_back({left + c * width, left + (c + 1) * width, bottom, std::max(bottom, -top)});
      }
    return result;
  }
} // namespace alluvium::grains
