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
  inline std::vector<NewGrain> make(const std::string &name, const std::string &parameters, const DepositContext &c)
  {
    dealii::ParameterHandler prm;
    auto                     deposit = Registry<Deposit>::entries().at(name).create();
    deposit->add_parameters(prm);
    prm.parse_input_from_string(parameters);
    deposit->parse_parameters();
    return deposit->make(c);
  }

  inline GrainArrays arrays(const std::vector<NewGrain> &new_grains)
  {
    GrainArrays grains;
    grains.resize(new_grains.size());
    for (std::size_t k = 0; k < new_grains.size(); ++k)
      {
        grains.id[k]          = static_cast<GrainId>(k);
        grains.position[0][k] = new_grains[k].x;
        grains.position[1][k] = new_grains[k].y;
        grains.radius[k]      = new_grains[k].radius;
        grains.mass[k]        = new_grains[k].density * M_PI * new_grains[k].radius * new_grains[k].radius;
      }
    return grains;
  }
} // namespace alluvium::deposits::test
