#pragma once

// A registered drag law by its name, for grains of 0.22 mm in water.
#include "bed.h"

namespace bed
{
  constexpr double d = 2.2e-4, rho = 1000., eta = 1e-3; // [m], [kg/m^3], [Pa s]

  struct Law
  {
    explicit Law(const std::string &name)
      : law(alluvium::Registry<coupling::DragLaw>::entries().at(name).create())
    {
      law->add_parameters(prm);
    }
    double gamma(const double eps, const double u) const { return law->gamma({eps, u, d, rho, eta}); }

    std::unique_ptr<coupling::DragLaw> law;
    dealii::ParameterHandler           prm;
  };
} // namespace bed
