#include <alluvium/observers/observer.h>

#include <nlohmann/json.hpp>

#include <cmath>

namespace alluvium::observers
{
  namespace
  {
    class Head : public Observer
    {
    public:
      bool applies(const Snapshot &s) const override { return s.fluid && std::isfinite(s.fluid->head); }
      void add_columns(const Snapshot &, output::Statistics &statistics) override
      {
        statistics.add_column("differential_head_m");
      }
      void observe(const Snapshot &s) override
      {
        last    = s.fluid->head;
        largest = std::max(largest, last);
      }
      void write(const Snapshot &s, output::Statistics &statistics) override
      {
        statistics.set("differential_head_m", s.fluid->head);
      }
      void conclude(output::Summary &summary) const override
      {
        summary.set("head/final_m", last);
        summary.set("head/largest_m", largest);
      }
      void save(nlohmann::ordered_json &state) const override { state = {largest, last}; }
      void load(const nlohmann::ordered_json &state) override
      {
        largest = state.at(0).get<double>();
        last    = state.at(1).get<double>();
      }

    private:
      double last = 0., largest = 0.;
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(Head,
                             "head",
                             "Differential head: between the bottom and the top of the bed as it was at t = 0, or what "
                             "Head between says.")
} // namespace alluvium::observers
