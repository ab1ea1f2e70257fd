// Grains that a deposit makes, for tests of deposits.
#pragma once

#include <alluvium/deposits/deposit.h>
#include <alluvium/grains/grain_arrays.h>
#include <alluvium/utilities/plugin.h>

#include <cmath>
#include <string>
#include <vector>

namespace alluvium::deposits::test
{
  using namespace grains;

  /** What the deposit @p name with @p parameters makes in @p c. */
  inline std::vector<Seed> make(const std::string &name, const std::string &parameters, const DepositContext &c)
  {
    dealii::ParameterHandler prm;
    auto                     deposit = Registry<Deposit>::entries().at(name).create();
    deposit->add_parameters(prm);
    prm.parse_input_from_string(parameters);
    return deposit->make(c);
  }

  inline GrainArrays arrays(const std::vector<Seed> &seeds)
  {
    GrainArrays grains;
    grains.resize(seeds.size());
    for (std::size_t k = 0; k < seeds.size(); ++k)
      {
        grains.id[k]          = static_cast<GrainId>(k);
        grains.position[0][k] = seeds[k].x;
        grains.position[1][k] = seeds[k].y;
        grains.radius[k]      = seeds[k].radius;
        grains.mass[k]        = seeds[k].density * M_PI * seeds[k].radius * seeds[k].radius;
      }
    return grains;
  }
} // namespace alluvium::deposits::test
