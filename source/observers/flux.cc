#include <alluvium/observers/observer.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>

namespace alluvium::observers
{
  namespace
  {
    class Flux : public Observer
    {
    public:
      bool applies(const Snapshot &s) const override { return s.fluid && !open_boundaries(s).empty(); }

      void add_columns(const Snapshot &s, Statistics &statistics) override
      {
        for (const auto &[id, name] : open_boundaries(s))
          statistics.add_column("flux_" + name + "_m2_per_s");
        statistics.add_column("flux_imbalance");
      }

      void write(const Snapshot &s, Statistics &statistics) override
      {
        if (s.step == 0)
          return;
        double sum = 0., size = 0.;
        for (const auto &[id, name] : open_boundaries(s))
          {
            const double flux = s.fluid->solver.flux(id);
            last[name]        = flux;
            sum += flux;
            size = std::max(size, std::abs(flux));
            statistics.set("flux_" + name + "_m2_per_s", flux);
          }
        statistics.set("flux_imbalance", size > 0. ? sum / size : 0.);
      }

      void conclude(Summary &summary) const override
      {
        for (const auto &[name, flux] : last)
          summary.set("flux/" + name + "_m2_per_s", flux);
      }

      void save(nlohmann::ordered_json &state) const override { state = last; }
      void load(const nlohmann::ordered_json &state) override { last = state.get<decltype(last)>(); }

    private:
      static std::map<dealii::types::boundary_id, std::string> open_boundaries(const Snapshot &s)
      {
        using Kind = fluid::BoundaryConditions<2>::Kind;
        std::map<dealii::types::boundary_id, std::string> result;
        for (const auto &[id, condition] : s.fluid->boundary_conditions.all())
          if (condition.kind == Kind::pressure || condition.kind == Kind::velocity)
            result[id] = condition.name;
        return result;
      }

      std::map<std::string, double> last;
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(Flux,
                             "flux",
                             "Flux of the mixture out through every open boundary, and their sum over the largest.")
} // namespace alluvium::observers
