#include <alluvium/run/state.h>

#include <nlohmann/json.hpp>

namespace alluvium::run
{
  void State::save(nlohmann::ordered_json &json) const
  {
    json["time"]          = time;
    json["steps"]         = n_steps;
    json["clock"]         = {clock.since, clock.n_steps, clock.dt};
    json["counts"]        = counts;
    json["inputs"]        = inputs;
    json["coarse size"]   = coarse_size;
    json["never refines"] = never_refines;
    for (const auto &[side, d] : leavers.by_side)
      json["grains that left"][side] = {d.n, d.mass, d.momentum[0], d.momentum[1]};
    json["initial diameter"] = initial_diameter;
    for (const auto &c : initial_bed.columns)
      json["initial bed"].push_back({c.left, c.right, c.bottom, c.top});
  }


  void State::load(const nlohmann::ordered_json &json)
  {
    time             = json.at("time");
    n_steps          = json.at("steps");
    const auto &c    = json.at("clock");
    clock            = {c.at(0).get<double>(), c.at(1).get<unsigned int>(), c.at(2).get<double>()};
    counts           = json.at("counts").get<decltype(counts)>();
    inputs           = json.value("inputs", decltype(inputs)()); // older ones have none
    coarse_size      = json.at("coarse size");
    never_refines    = json.at("never refines");
    initial_diameter = json.value("initial diameter", 0.); // older ones have none
    initial_bed.columns.clear();
    if (json.contains("initial bed"))
      for (const auto &column : json.at("initial bed"))
        initial_bed.columns.push_back({column.at(0).get<double>(),
                                       column.at(1).get<double>(),
                                       column.at(2).get<double>(),
                                       column.at(3).get<double>()});
    leavers.by_side.clear();
    if (json.contains("grains that left"))
      for (const auto &[side, d] : json.at("grains that left").items())
        leavers.by_side[side] = {
          d.at(0).get<unsigned long>(), d.at(1).get<double>(), {{d.at(2).get<double>(), d.at(3).get<double>()}}};
  }
} // namespace alluvium::run
