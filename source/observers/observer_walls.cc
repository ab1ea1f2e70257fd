#include <alluvium/contacts/contact_report.h>
#include <alluvium/grains/wall.h>
#include <alluvium/observers/observer.h>

#include <algorithm>
#include <map>

namespace alluvium::observers
{
  namespace
  {
    /** Walls that move, appear or vanish: where they are, and what grains exert on them. */
    class Walls : public Observer
    {
    public:
      bool applies(const Snapshot &s) const override
      {
        return std::any_of(s.walls.begin(), s.walls.end(), grains::ever_acts);
      }

      void add_columns(const Snapshot &s, output::Statistics &statistics) override
      {
        names.clear();
        for (const auto &wall : s.walls)
          if (grains::ever_acts(wall) && std::find(names.begin(), names.end(), wall.name) == names.end())
            names.push_back(wall.name);
        in_columns = output::names_in_columns(names, " ");
        for (const auto &name : names)
          for (const char *what : {"_x_m", "_y_m", "_force_x_N_per_m", "_force_y_N_per_m", "_is_there"})
            statistics.add_column(column(name, what));
      }

      void write(const Snapshot &s, output::Statistics &statistics) override
      {
        for (const auto &name : names)
          {
            std::array<double, 2> sum = {{0., 0.}}, force = {{0., 0.}};
            double                n       = 0.;
            bool                  present = false;
            for (const auto &wall : s.walls)
              if (wall.name == name)
                {
                  for (unsigned int d = 0; d < 2; ++d)
                    sum[d] += 0.5 * (wall.a[d] + wall.b[d]);
                  n += 1.;
                  present = present || wall.present;
                }
            if (s.contacts != nullptr)
              if (const auto f = s.contacts->wall_force.find(name); f != s.contacts->wall_force.end())
                force = f->second;
            statistics.set(column(name, "_x_m"), sum[0] / n);
            statistics.set(column(name, "_y_m"), sum[1] / n);
            statistics.set(column(name, "_force_x_N_per_m"), force[0]);
            statistics.set(column(name, "_force_y_N_per_m"), force[1]);
            statistics.set(column(name, "_is_there"), present);
          }
      }

    private:
      std::vector<std::string>           names;
      std::map<std::string, std::string> in_columns;

      std::string column(const std::string &name, const std::string &what) const
      {
        return "wall_" + in_columns.at(name) + what;
      }
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(Walls,
                             "walls",
                             "Of walls that move, appear or vanish: the middle, the force of the grains, and whether "
                             "they are there.")
} // namespace alluvium::observers
