#include <alluvium/observers/observer.h>

#include <nlohmann/json.hpp>

namespace alluvium::observers
{
  namespace
  {
    /** The grains that have left through open sides since t = 0, and the mass and momentum they took along. */
    class Leavers : public Observer
    {
    public:
      bool applies(const Snapshot &s) const override { return !s.leavers.by_side.empty(); }

      void add_columns(const Snapshot &, output::Statistics &statistics) override
      {
        for (const char *name :
             {"grains_left", "mass_left_kg_per_m", "momentum_left_x_N_s_per_m", "momentum_left_y_N_s_per_m"})
          statistics.add_column(name);
      }

      void observe(const Snapshot &s) override { leavers = s.leavers; }

      void write(const Snapshot &, output::Statistics &statistics) override
      {
        const grains::Departure sum = leavers.total();
        statistics.set("grains_left", sum.n);
        statistics.set("mass_left_kg_per_m", sum.mass);
        statistics.set("momentum_left_x_N_s_per_m", sum.momentum[0]);
        statistics.set("momentum_left_y_N_s_per_m", sum.momentum[1]);
      }

      void conclude(output::Summary &summary) const override
      {
        for (const auto &[side, d] : leavers.by_side)
          {
            summary.set("grains that left/" + side + "/number", d.n);
            summary.set("grains that left/" + side + "/mass_kg_per_m", d.mass);
            summary.set("grains that left/" + side + "/momentum_N_s_per_m",
                        std::vector<double>{d.momentum[0], d.momentum[1]});
          }
      }

    private:
      grains::Leavers leavers; // of the latest step
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(Leavers,
                             "leavers",
                             "Number, mass and momentum of the grains that have left through sides open to grains.")
} // namespace alluvium::observers
